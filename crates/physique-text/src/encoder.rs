//! What all encoders can do.

use std::fmt::Debug;
use std::path::Path;

use crate::config::Config;
use crate::{Clip, ClipContext, DistilBert, Error, MiniLm, TextEmbeddings, TextLimits};

/// Turns captions into vectors.
pub trait TextEncoder: Debug + Send + Sync {
    /// What to call it, in cards and reports.
    fn name(&self) -> &str;

    /// Numbers of a vector.
    fn width(&self) -> usize;

    /// Whether every token has a vector of its own; otherwise a caption has one.
    fn is_by_token(&self) -> bool;

    /// The vectors of captions. Any text is welcome: what is too long is cut, what is unknown is
    /// taken apart. Captions are worked on by all threads; the vectors of one do not depend on the
    /// others, to the bit.
    fn encode(&self, captions: &[&str]) -> TextEmbeddings;
}

/// Opens an encoder from a folder in the layout of Hugging Face: `config.json`, weights
/// (`model.safetensors` or `pytorch_model.bin`) and a vocabulary; the configuration says which one.
///
/// # Errors
/// [`Error::Format`] for a kind of model that is not known here, and those of the encoders.
pub fn open(folder: &Path, limits: &TextLimits) -> Result<Box<dyn TextEncoder>, Error> {
    let config = Config::read(folder, limits)?;
    Ok(match config.kind() {
        "bert" => Box::new(MiniLm::read(folder, limits)?),
        "distilbert" => Box::new(DistilBert::read(folder, limits)?),
        "clip" | "clip_text_model" => Box::new(Clip::read(folder, ClipContext::Whole, limits)?),
        other => {
            return Err(config.wrong(
                "model_type",
                "bert, distilbert, clip or clip_text_model",
                other,
            ));
        }
    })
}
