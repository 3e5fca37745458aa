//! What all encoders can do.

use std::fmt::Debug;
use std::path::Path;

use crate::config::Config;
use crate::weights::OPENAI_FILE;
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
/// (`model.safetensors` or `pytorch_model.bin`) and a vocabulary; the configuration says which one. Or
/// CLIP as OpenAI published it: `ViT-B-32.pt`, or its folder, with `bpe_simple_vocab_16e6.txt.gz` beside
/// it; the program in that file is not run. CLIP reads as much of a caption as it has positions for.
///
/// # Errors
/// [`Error::Format`] for a kind of model that is not known here, and those of the encoders.
pub fn open(path: &Path, limits: &TextLimits) -> Result<Box<dyn TextEncoder>, Error> {
    open_with(path, ClipContext::Whole, limits)
}

/// As [`open`]; CLIP reads as much of a caption as `context` says.
///
/// # Errors
/// As [`open`].
pub fn open_with(
    path: &Path,
    context: ClipContext,
    limits: &TextLimits,
) -> Result<Box<dyn TextEncoder>, Error> {
    if path.is_file() {
        let folder = path.parent().unwrap_or(Path::new("."));
        let clip = Clip::read_files(path, folder, context, limits)?;
        return Ok(Box::new(clip));
    }
    if !path.join("config.json").exists() && path.join(OPENAI_FILE).exists() {
        return Ok(Box::new(Clip::read(path, context, limits)?));
    }
    let config = Config::read(path, limits)?;
    Ok(match config.kind() {
        "bert" => Box::new(MiniLm::read(path, limits)?),
        "distilbert" => Box::new(DistilBert::read(path, limits)?),
        "clip" | "clip_text_model" => Box::new(Clip::read(path, context, limits)?),
        other => {
            return Err(config.wrong(
                "model_type",
                "bert, distilbert, clip or clip_text_model",
                other,
            ));
        }
    })
}
