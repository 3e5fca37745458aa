//! Motions in NumPy arrays, Python pickles and PyTorch files: one array, or a dictionary of them.
//!
//! What a file holds is told by the shapes of its arrays and the keys of its dictionaries.
//!
//! | file | content |
//! |---|---|
//! | `[frames][263]`, `[frames][251]` | features of HumanML3D and KIT-ML, see [`crate::features`] |
//! | `[frames][22][3]`, `[frames][21][3]` | joint positions of HumanML3D and KIT-ML; of 24, 52 or 55 joints, SMPL's, the first 22 |
//! | either with motions first, or motions first and frames last | many of them |
//! | `[frames]` and 322, 272, 201 or 135 | rotations of Motion-X, MotionStreamer, HY-Motion and their kin |
//! | `motion` with `lengths` or `text` | MDM's `results.npy` |
//! | `thetas` and `root_translation` | MDM's `smpl_params.npy` |
//! | SMPL's parameters under the keys of GVHMR, WHAM, AIST++, EDGE, TRAM, Kimodo or SMPL-X | one person |
//! | frames with `tid` and `smpl` | tracks of PHALP and 4D-Humans, one motion a track |
//! | dictionaries or lists of these, or of arrays | several people |
//! | `poses`, or `root_orient` and `pose_body` | [`crate::amass`] |
//! | `physique_motion` | [`crate::native`] |

mod dictionary;
mod joints;
mod mdm;
mod parameters;
mod phalp;
mod points;
mod rows;
mod statistics;

use std::path::Path;

use physique_files::pickle::PickleLimits;
use physique_files::{Data, Error as DataError};

use crate::features::JointFile;
use crate::npz::{Array, ArrayLimits};
use crate::read::{Part, open_archive};
use crate::{Error, ReadOptions, SourceMotion, amass, native};

pub use statistics::is_statistics_file;

/// What the readers of this module share: the file's name for errors, and the options.
#[derive(Clone, Copy)]
struct Context<'a> {
    path: &'a Path,
    options: &'a ReadOptions,
}

impl Context<'_> {
    fn format(&self, place: impl Into<String>, expected: &str, found: impl Into<String>) -> Error {
        Error::Format {
            path: self.path.into(),
            place: place.into(),
            expected: expected.into(),
            found: found.into(),
        }
    }

    fn unknown(&self, looks_like: String) -> Error {
        Error::UnknownFormat {
            path: self.path.into(),
            looks_like,
        }
    }

    fn inside(&self, place: impl Into<String>, problem: Error) -> Error {
        Error::Inside {
            path: self.path.into(),
            place: place.into(),
            problem: Box::new(problem),
        }
    }

    fn check_frames(&self, frames: usize) -> Result<(), Error> {
        self.options.limits.check_frames(self.path, frames)
    }
}

/// Motions of an `.npz`.
pub(crate) fn from_npz(
    bytes: Vec<u8>,
    path: &Path,
    options: &ReadOptions,
) -> Result<Vec<Part>, Error> {
    let mut archive = open_archive(bytes, path, options)?;
    // These are read array by array; all others as one tree.
    if archive.contains(native::MARK) {
        let recording = native::from_archive(&mut archive, path, options)?;
        let motion = SourceMotion::Body(recording);
        return Ok(vec![Part::only("Physique motion", motion)]);
    }
    let has_rate = archive.contains("mocap_framerate") || archive.contains("mocap_frame_rate");
    if archive.contains("pose_body") || (archive.contains("poses") && has_rate) {
        let recording = amass::from_archive(&mut archive, path, options)?;
        return Ok(vec![Part::only("AMASS", SourceMotion::Body(recording))]);
    }
    from_bytes(archive.into_bytes(), path, options)
}

/// Motions of a `.npy`, an `.npz` of a dictionary, a pickle or a PyTorch file.
pub(crate) fn from_bytes(
    bytes: Vec<u8>,
    path: &Path,
    options: &ReadOptions,
) -> Result<Vec<Part>, Error> {
    let context = Context { path, options };
    let arrays = ArrayLimits {
        bytes: options.limits.bytes,
        ..ArrayLimits::default()
    };
    let pickles = PickleLimits {
        bytes: options.limits.bytes,
        ..PickleLimits::default()
    };
    let data = Data::read(bytes, &arrays, &pickles).map_err(|error| match error {
        DataError::Array(problem) => Error::Array {
            path: path.into(),
            problem,
        },
        problem => Error::Data {
            path: path.into(),
            problem,
        },
    })?;
    match &data {
        Data::Array(array) => one_array(&context, array),
        Data::Dict(_) | Data::List(_) => dictionary::read(&context, &data),
        other => Err(context.unknown(other.kind())),
    }
}

/// The only motion of an array of features or positions, for [`crate::features::parse`].
pub(crate) fn joint_file(
    array: &Array,
    path: &Path,
    options: &ReadOptions,
) -> Result<JointFile, Error> {
    joints::only(&Context { path, options }, array)
}

/// Motions of an array without a dictionary around it.
fn one_array(context: &Context<'_>, array: &Array) -> Result<Vec<Part>, Error> {
    if let Some(looks_like) = statistics::describe(array, context.path) {
        return Err(context.unknown(looks_like));
    }
    if rows::holds(array) {
        rows::read(context, array)
    } else {
        joints::read(context, array)
    }
}
