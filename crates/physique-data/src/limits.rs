//! How much a data file may ask for before it is refused.

/// Upper bounds, checked **before** memory is taken.
///
/// The rows of a file are mapped, not read, and need no bound. The defaults let HumanML3D pass ten
/// times over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DataLimits {
    /// Bytes of the index: names, labels and captions.
    pub index_bytes: u64,
    /// Captions that the templates of a recipe make for one clip.
    pub captions_a_clip: usize,
    /// Bytes of a recipe, a table, a list of names or a text file.
    pub text_bytes: u64,
}

impl Default for DataLimits {
    fn default() -> Self {
        Self {
            index_bytes: 1 << 29,
            captions_a_clip: 10_000,
            text_bytes: 1 << 26,
        }
    }
}
