//! DeepMimic's motion files (`humanoid3d_*.txt`): JSON frames of one fixed humanoid.
//!
//! ```json
//! { "Loop": "wrap", "Frames": [ [duration, root position 3, root rotation 4, ...], ... ] }
//! ```
//!
//! A frame is 44 numbers: its duration in seconds, then for every joint, in the order of
//! [`JOINTS`], a quaternion (w, x, y, z) or, at knees and elbows, an angle in radians about the
//! lateral axis. Metres, Y up, **facing +X with the right side at +Z**; the reader turns that a
//! quarter about Y, so that the clip faces +Z as everything here. Frames of varying duration are
//! resampled at the shortest one, rotations by spherical interpolation. What `Loop` says about
//! repeating the clip is not used.
//!
//! Joint positions are those of the character `humanoid3d`, as `humanoid.urdf` in PyPI
//! `pybullet` 3.2.7 states them at four times their size.
//!
//! Peng et al., DeepMimic, ACM Transactions on Graphics 37(4), 2018.

mod character;
mod frames;

pub use character::JOINTS;

use std::path::Path;

use crate::read_file::read_file;
use crate::{Error, ReadOptions, SkeletonClip};

/// Reads a DeepMimic motion file.
///
/// # Errors
/// [`Error::Io`], and those of [`parse`].
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<SkeletonClip, Error> {
    let path = path.as_ref();
    parse(&read_file(path, options.limits.bytes)?, path, options)
}

/// Reads the text of a DeepMimic motion file; `path` only names it in errors.
///
/// # Errors
/// [`Error::Format`] with line or frame; [`Error::Limit`] for too many frames.
pub fn parse(
    text: &[u8],
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<SkeletonClip, Error> {
    let path = path.as_ref();
    let frames = frames::parse(text, path, options)?;
    character::clip(&frames, path, options)
}
