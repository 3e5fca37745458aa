//! Encoded captions: what networks are told to generate.

mod centre;
mod known;
mod prompts;

use physique_text::TextEmbeddings;

pub use centre::CaptionCentre;
pub use known::{KnownCaptions, NearestCaption};
pub use prompts::PromptEncoder;

/// What a [`TextEncoder`](physique_text::TextEncoder) made of a batch of captions, or numbers in
/// their place: `tokens` vectors of `width` numbers for each.
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

impl From<&TextEmbeddings> for Embeddings {
    fn from(embeddings: &TextEmbeddings) -> Self {
        Self {
            batch: embeddings.captions(),
            tokens: embeddings.tokens(),
            width: embeddings.width(),
            values: embeddings.values().to_vec(),
            padding: embeddings.mask().iter().map(|within| !within).collect(),
        }
    }
}
