//! all-MiniLM-L6-v2: one vector a caption.

use std::path::Path;

use crate::bert::{BERT, Bert};
use crate::{Error, TextEmbeddings, TextEncoder, TextLimits};

/// Word pieces of a caption that are read, as the published model's own settings say.
const LONGEST: usize = 256;

/// A sentence encoder: the mean of BERT's states over all tokens, at length 1 (Reimers and Gurevych,
/// 2019).
///
/// "waves with the left hand" and "waves with the right hand" differ by a cosine of 0.02 only: take
/// the mean of the training captions away before a network reads these vectors.
#[derive(Clone, Debug)]
pub struct MiniLm(Bert);

impl MiniLm {
    /// The embedded all-MiniLM-L6-v2, rounded to 8 bits; cost: some 50 ms the first time, and 55 MB.
    /// Keep it and share it.
    ///
    /// # Errors
    /// None that a test has not ruled out; the type is [`Self::read`]'s.
    #[cfg(feature = "embedded")]
    pub fn embedded() -> Result<Self, Error> {
        use crate::tokens::WordPieces;
        use crate::weights::Weights;

        let path = Path::new("embedded all-MiniLM-L6-v2");
        let weights = include_bytes!("../assets/minilm.safetensors");
        let vocabulary = include_bytes!("../assets/vocab.txt");
        let weights = Weights::safetensors(weights, path)?;
        let tokens = WordPieces::from_list(vocabulary, path)?;
        let limits = TextLimits::default();
        let bert = Bert::take(weights, &BERT, 12, tokens, LONGEST, &limits)?;
        Ok(Self(bert))
    }

    /// Reads a folder in the layout of Hugging Face: any BERT that is meant to be averaged.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Missing`]; [`Error::Format`] and [`Error::Data`] for files that do
    /// not hold such a model.
    pub fn read(folder: &Path, limits: &TextLimits) -> Result<Self, Error> {
        let heads = "num_attention_heads";
        Ok(Self(Bert::read(folder, &BERT, heads, LONGEST, limits)?))
    }
}

impl TextEncoder for MiniLm {
    fn name(&self) -> &str {
        "all-MiniLM-L6-v2"
    }

    fn width(&self) -> usize {
        self.0.width()
    }

    fn is_by_token(&self) -> bool {
        false
    }

    fn encode(&self, captions: &[&str]) -> TextEmbeddings {
        let width = self.width();
        let means = self.0.encode(captions, |states| {
            let mut mean = vec![0.0; width];
            for state in states.chunks_exact(width) {
                for (sum, value) in mean.iter_mut().zip(state) {
                    *sum += value;
                }
            }
            // The mean's own length does not matter: it becomes 1.
            let length = mean.iter().map(|x| x * x).sum::<f32>().sqrt().max(1e-12);
            for value in &mut mean {
                *value /= length;
            }
            mean
        });
        TextEmbeddings::padded(&means, width)
    }
}
