//! How much a file may ask for before a reader refuses it.

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
