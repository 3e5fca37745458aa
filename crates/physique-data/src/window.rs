//! Which rows of which clip.

/// Some rows of features of a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Window {
    /// Clip of the [`crate::Index`].
    pub clip: usize,
    /// First row, from the clip's own first.
    pub start: usize,
    /// Rows.
    pub frames: usize,
}
