//! Which text encoder the flags ask for.

use std::path::Path;

use anyhow::Result;
use physique_text::{MiniLm, TextEncoder, TextLimits, open};

/// The embedded encoder, one from a folder, or none.
pub(crate) fn named(name: &str) -> Result<Option<Box<dyn TextEncoder>>> {
    Ok(match name {
        "none" => None,
        "minilm" => Some(Box::new(MiniLm::embedded()?)),
        folder => Some(open(Path::new(folder), &TextLimits::default())?),
    })
}
