//! How much a file may ask for before a reader refuses it.

use std::path::Path;

use glam::Quat;

use crate::Error;

/// Upper bounds that every reader checks **before** it allocates.
///
/// The defaults let every published motion through and keep a reader below about 2 GiB. Raise
/// them for longer recordings; nothing else depends on them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of a file, and of anything unpacked from it.
    pub bytes: u64,
    /// Frames of a motion.
    pub frames: usize,
    /// Joints of a skeleton.
    pub joints: usize,
    /// Nesting of a hierarchy.
    pub depth: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            bytes: 1 << 30,
            frames: 1 << 21,
            joints: 1024,
            depth: 128,
        }
    }
}

impl Limits {
    /// Refuses a motion of too many frames.
    pub(crate) fn check_frames(&self, path: &Path, frames: usize) -> Result<(), Error> {
        check(
            path,
            "the number of frames",
            frames as u64,
            self.frames as u64,
        )
    }

    /// Refuses a clip whose rotations alone take more memory than the limit.
    pub(crate) fn check_rotations(
        &self,
        path: &Path,
        frames: usize,
        joints: usize,
    ) -> Result<(), Error> {
        let found = (frames as u64)
            .saturating_mul(joints as u64)
            .saturating_mul(size_of::<Quat>() as u64);
        let what = "the size of frames x joints rotations in bytes";
        check(path, what, found, self.bytes)
    }
}

/// Refuses what is `found` above its limit.
pub(crate) fn check(path: &Path, what: &'static str, found: u64, limit: u64) -> Result<(), Error> {
    if found <= limit {
        return Ok(());
    }
    let path = path.into();
    Err(Error::Limit {
        path,
        what,
        found,
        limit,
    })
}
