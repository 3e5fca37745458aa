//! DistilBERT: a vector a token.

use std::path::Path;

use crate::bert::{Bert, DISTIL_BERT};
use crate::{Error, TextEmbeddings, TextEncoder, TextLimits};

/// `distilbert-base-uncased` and its kin (Sanh et al., 2019), as MDM's BERT variant and DiP read it:
/// the last layer's states of all tokens, `[CLS]` and `[SEP]` among them.
#[derive(Clone, Debug)]
pub struct DistilBert(Bert);

impl DistilBert {
    /// Reads a folder in the layout of Hugging Face.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Missing`]; [`Error::Format`] and [`Error::Data`] for files that do
    /// not hold such a model.
    pub fn read(folder: &Path, limits: &TextLimits) -> Result<Self, Error> {
        Ok(Self(Bert::read(
            folder,
            &DISTIL_BERT,
            "n_heads",
            512,
            limits,
        )?))
    }
}

impl TextEncoder for DistilBert {
    fn name(&self) -> &str {
        "DistilBERT"
    }

    fn width(&self) -> usize {
        self.0.width()
    }

    fn is_by_token(&self) -> bool {
        true
    }

    fn encode(&self, captions: &[&str]) -> TextEmbeddings {
        let states = self.0.encode(captions, <[f32]>::to_vec);
        TextEmbeddings::padded(&states, self.width())
    }
}
