//! What an encoder gives.

/// Vectors of several captions.
#[derive(Clone, Debug, PartialEq)]
pub struct TextEmbeddings {
    captions: usize,
    tokens: usize,
    width: usize,
    values: Vec<f32>,
    mask: Vec<bool>,
}

impl TextEmbeddings {
    /// Pads the vectors of each caption with zeros to those of the longest. Each item holds whole
    /// vectors of `width` numbers, one a token.
    pub(crate) fn padded(captions: &[Vec<f32>], width: usize) -> Self {
        let length = |caption: &Vec<f32>| caption.len() / width.max(1);
        let tokens = captions.iter().map(length).max().unwrap_or(0);
        let mut values = Vec::with_capacity(captions.len() * tokens * width);
        let mut mask = Vec::with_capacity(captions.len() * tokens);
        for (number, caption) in captions.iter().enumerate() {
            values.extend_from_slice(caption);
            values.resize((number + 1) * tokens * width, 0.0);
            mask.extend((0..tokens).map(|token| token < length(caption)));
        }
        Self {
            captions: captions.len(),
            tokens,
            width,
            values,
            mask,
        }
    }

    /// Number of captions.
    pub const fn captions(&self) -> usize {
        self.captions
    }

    /// Vectors of each caption, padding included; 1 for encoders of whole captions.
    pub const fn tokens(&self) -> usize {
        self.tokens
    }

    /// Numbers of a vector.
    pub const fn width(&self) -> usize {
        self.width
    }

    /// `[captions][tokens][width]`; padding is 0.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// `[captions][tokens]`: whether a vector is not padding.
    pub fn mask(&self) -> &[bool] {
        &self.mask
    }

    /// `[tokens][width]` of each caption in turn, padding included.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, f32> {
        self.values.chunks_exact((self.tokens * self.width).max(1))
    }
}
