//! Features and positions as single `.npy` arrays, the files of HumanML3D, KIT-ML and their kin.

use std::path::Path;

use glam::Vec3;

use super::{JointPositions, MotionFeatures};
use crate::{
    Error, ReadOptions, arrays,
    npz::{Array, ArrayError, ArrayLimits, npy_f32},
    read::file_name,
    read_file::read_file,
    write_file::write_file,
};

/// What a `.npy` of a feature data set holds.
#[derive(Clone, Debug, PartialEq)]
pub enum JointFile {
    /// `[frames][263]` or `[frames][251]`, HumanML3D's `new_joint_vecs`.
    Features(MotionFeatures),
    /// `[frames][22][3]` or `[frames][21][3]`, HumanML3D's `new_joints`.
    Positions(JointPositions),
}

impl JointFile {
    /// The positions, recovered from the features where those were in the file.
    ///
    /// # Errors
    /// As [`super::recover_from_positions`].
    pub fn into_positions(self) -> Result<JointPositions, Error> {
        match self {
            Self::Features(features) => super::recover_from_positions(&features),
            Self::Positions(positions) => Ok(positions),
        }
    }
}

/// Reads a `.npy` file; see [`parse`].
///
/// # Errors
/// [`Error::Io`], and those of [`parse`].
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<JointFile, Error> {
    let path = path.as_ref();
    parse(read_file(path, options.limits.bytes)?, path, options)
}

/// Reads the bytes of a `.npy`; its shape says what it holds. `path` only names it in errors.
///
/// The file does not say its frame rate: it is `options.frame_rate`, or else the data set's.
/// Features that are normalised need `options.statistics`.
///
/// # Errors
/// [`Error::Array`] for anything but an array of numbers; [`Error::Format`] for another shape and,
/// with frame and place, for numbers that are not finite; [`Error::Limit`] for too many frames.
pub fn parse(
    bytes: Vec<u8>,
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<JointFile, Error> {
    let path = path.as_ref();
    let limits = ArrayLimits {
        bytes: options.limits.bytes,
        ..ArrayLimits::default()
    };
    let array = Array::from_npy(&file_name(path), bytes, &limits);
    let array = array.map_err(|problem| Error::Array {
        path: path.into(),
        problem,
    })?;
    arrays::joint_file(&array, path, options)
}

/// Writes features as `[frames][columns]` of 32 bits, beside the file first, then renamed.
///
/// # Errors
/// [`Error::Io`].
pub fn write_features(path: impl AsRef<Path>, features: &MotionFeatures) -> Result<(), Error> {
    let shape = [features.frame_count(), features.skeleton().feature_count()];
    write(path.as_ref(), npy_f32(&shape, features.values()))
}

/// Writes positions as `[frames][joints][3]` of 32 bits, beside the file first, then renamed.
///
/// # Errors
/// [`Error::Io`].
pub fn write_positions(path: impl AsRef<Path>, motion: &JointPositions) -> Result<(), Error> {
    let shape = [motion.frame_count(), motion.skeleton().joint_count(), 3];
    let values: Vec<f32> = motion.positions().iter().flat_map(Vec3::to_array).collect();
    write(path.as_ref(), npy_f32(&shape, &values))
}

fn write(path: &Path, bytes: Result<Vec<u8>, ArrayError>) -> Result<(), Error> {
    let bytes = bytes.map_err(|problem| Error::Array {
        path: path.into(),
        problem,
    })?;
    write_file(path, &bytes)
}
