//! What a network sees at once.

/// Normalised features of several windows, padded with zeros behind each.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// `[windows][frames][columns]`.
    pub values: Vec<f32>,
    /// Rows of each window that are not padding.
    pub lengths: Vec<usize>,
    /// Rows of each window, padding included.
    pub frames: usize,
    /// Features in a row.
    pub columns: usize,
}

impl Batch {
    /// `[windows][frames]`: whether a row is not padding.
    pub fn mask(&self) -> Vec<bool> {
        let rows = self.lengths.iter();
        rows.flat_map(|&length| (0..self.frames).map(move |row| row < length))
            .collect()
    }
}
