//! One door for every format.

use std::path::Path;

use glam::Vec3;

use crate::{FrameRate, Limits, UpAxis};

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

/// Name of a file without folder and extension.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}
