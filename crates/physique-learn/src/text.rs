//! Captions as numbers: what networks are told to generate.

use crate::Error;

/// What an encoder makes of a batch of captions: `tokens` vectors of `width` numbers for each.
///
/// An encoder that makes one vector of a whole sentence has one token.
#[derive(Clone, Debug, PartialEq)]
pub struct Embeddings {
    /// Captions.
    pub batch: usize,
    /// Vectors a caption, padding included.
    pub tokens: usize,
    /// Numbers a vector.
    pub width: usize,
    /// `[batch][tokens][width]`.
    pub values: Vec<f32>,
    /// `[batch][tokens]`: true where a vector is padding, which networks must not look at.
    pub padding: Vec<bool>,
}

/// Something that turns captions into numbers, the same ones every time.
pub trait TextEncoder {
    /// Encodes a batch of captions; all get as many tokens as the longest needs.
    ///
    /// # Errors
    /// Depends on the encoder; never on another caption of the batch.
    fn encode(&self, captions: &[&str]) -> Result<Embeddings, Error>;
}
