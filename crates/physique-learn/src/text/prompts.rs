//! Captions as a network was trained to read them.

use physique_text::TextEncoder;

use super::{CaptionCentre, Embeddings};
use crate::Error;

/// An encoder, and what is done to its vectors before a network reads them.
#[derive(Debug)]
pub struct PromptEncoder {
    encoder: Box<dyn TextEncoder>,
    centre: Option<CaptionCentre>,
}

impl PromptEncoder {
    /// An encoder as it is, or with its vectors centred.
    ///
    /// # Errors
    /// [`Error::Input`] when the centre is of vectors of another width.
    pub fn new(
        encoder: Box<dyn TextEncoder>,
        centre: Option<CaptionCentre>,
    ) -> Result<Self, Error> {
        if let Some(found) = centre.as_ref().map(|centre| centre.mean().len())
            && found != encoder.width()
        {
            let expected = format!("{}, as {} gives", encoder.width(), encoder.name());
            return Err(Error::input(
                "Width of the centre of captions",
                expected,
                found,
            ));
        }
        Ok(Self { encoder, centre })
    }

    /// The encoder.
    pub fn encoder(&self) -> &dyn TextEncoder {
        self.encoder.as_ref()
    }

    /// What is taken from its vectors.
    pub const fn centre(&self) -> Option<&CaptionCentre> {
        self.centre.as_ref()
    }

    /// Vectors of captions, as networks read them.
    ///
    /// # Errors
    /// None but for an encoder that changed its width.
    pub fn encode(&self, captions: &[&str]) -> Result<Embeddings, Error> {
        let mut embeddings = Embeddings::from(&self.encoder.encode(captions));
        if let Some(centre) = &self.centre {
            centre.apply(&mut embeddings)?;
        }
        Ok(embeddings)
    }
}
