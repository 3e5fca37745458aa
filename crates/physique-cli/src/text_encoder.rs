//! Which text encoder the flags ask for.

use std::path::Path;

use anyhow::{Result, bail};
use physique_text::{ClipContext, MiniLm, TextEncoder, TextLimits, open_with};

/// What networks of `physique train` call the embedded encoder.
const EMBEDDED: &str = "all-MiniLM-L6-v2";

/// The embedded encoder, one from a folder or a file, or none. CLIP reads as much of a caption as MDM
/// does.
pub(crate) fn named(name: &str) -> Result<Option<Box<dyn TextEncoder>>> {
    Ok(match name {
        "none" => None,
        "minilm" => Some(Box::new(MiniLm::embedded()?)),
        path => {
            let limits = TextLimits::default();
            Some(open_with(Path::new(path), ClipContext::Mdm, &limits)?)
        }
    })
}

/// The encoder that a network was trained with: one of those that flags name, or the embedded one.
pub(crate) fn wanted(name: &str, flags: &[String]) -> Result<Option<Box<dyn TextEncoder>>> {
    if name.is_empty() {
        return Ok(None);
    }
    let mut others = Vec::new();
    for flag in flags {
        match named(flag)? {
            Some(encoder) if encoder.name() == name => return Ok(Some(encoder)),
            Some(encoder) => others.push(encoder.name().to_owned()),
            None => {}
        }
    }
    if name == EMBEDDED {
        return named("minilm");
    }
    let found = match others.as_slice() {
        [] => String::new(),
        others => format!(", found {}", others.join(" and ")),
    };
    bail!("was trained with the text encoder {name}; say where it lies: --text FOLDER|FILE{found}")
}
