//! One door for every format.

use std::path::Path;

use glam::Vec3;

use crate::npz::{Archive, ArrayLimits};
use crate::{Error, FrameRate, Limits, UpAxis};

/// What a reader needs to know that a file may not say.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadOptions {
    /// How much a file may ask for.
    pub limits: Limits,
    /// Frame rate of files that do not state theirs; others keep their own.
    pub frame_rate: Option<FrameRate>,
    /// Rest pelvis of the body that an AMASS file was recorded for, see [`crate::amass`].
    pub rest_pelvis: Option<Vec3>,
    /// Which axis points up in AMASS files; Z by their own definition, but some programs write Y.
    pub amass_up: UpAxis,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            limits: Limits::default(),
            frame_rate: None,
            rest_pelvis: None,
            amass_up: UpAxis::Z,
        }
    }
}

/// Opens the bytes of an archive within the limits; `path` names it in errors.
pub(crate) fn open_archive(
    bytes: Vec<u8>,
    path: &Path,
    options: &ReadOptions,
) -> Result<Archive, Error> {
    let limits = ArrayLimits {
        bytes: options.limits.bytes,
        ..ArrayLimits::default()
    };
    Archive::open(bytes, limits).map_err(|source| Error::Array {
        path: path.into(),
        source,
    })
}

/// Name of a file without folder and extension.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}
