//! From a `.glb` or `.gltf` to the motions of its figure.

mod accessor;
mod bind;
mod buffers;
mod clip;
mod clock;
mod container;
mod document;
mod figure;
mod rest;
mod track;
mod tree;

use std::collections::HashSet;
use std::path::Path;

use crate::read::Part;
use crate::read_file::read_file;
use crate::{Error, ReadOptions, SkeletonClip, SourceMotion};

use accessor::Accessors;
use buffers::Buffers;
use container::Container;
use document::Document;
use figure::Figures;

/// Reads all animations of a file, each with its name.
///
/// # Errors
/// [`Error::Io`], also for a buffer's file; [`Error::Limit`]; [`Error::Format`] with the
/// animation, the accessor or the node, for the first animation that is broken.
pub fn read(
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<Vec<(String, SkeletonClip)>, Error> {
    let path = path.as_ref();
    parse(&read_file(path, options.limits.bytes)?, path, options)
}

/// Reads the bytes of a file; `path` names it in errors, and files with buffers are looked for
/// beside it.
///
/// # Errors
/// As [`read`].
pub fn parse(
    bytes: &[u8],
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<Vec<(String, SkeletonClip)>, Error> {
    let animations = animations(bytes, path.as_ref(), options)?;
    animations
        .into_iter()
        .map(|(name, clip)| Ok((name, clip?)))
        .collect()
}

/// As [`parse`], for the one door of all formats.
pub(crate) fn parts(bytes: &[u8], path: &Path, options: &ReadOptions) -> Result<Vec<Part>, Error> {
    let animations = animations(bytes, path, options)?;
    let only = animations.len() == 1;
    let parts = animations.into_iter().map(|(name, clip)| Part {
        key: if only { String::new() } else { name },
        text: None,
        format: "glTF",
        motion: clip.map(SourceMotion::Skeleton),
    });
    Ok(parts.collect())
}

type NamedResults = Vec<(String, Result<SkeletonClip, Error>)>;

/// Every animation by its name; one that is broken does not keep the others from being read.
fn animations(bytes: &[u8], path: &Path, options: &ReadOptions) -> Result<NamedResults, Error> {
    let context = Context { path, options };
    let container = Container::open(bytes, &context)?;
    let document = Document::parse(container.json, &context)?;
    if document.animations.is_empty() {
        return Err(context.format("the file", "at least one animation", "none"));
    }
    let mut reader = clip::Reader {
        context: &context,
        figures: Figures::new(&document, &context)?,
        accessors: Accessors::new(&document, Buffers::new(&document, container.binary)),
        budget: clip::Budget::new(options.limits.bytes),
    };
    let mut taken = HashSet::new();
    let mut named = Vec::new();
    for (index, animation) in document.animations.iter().enumerate() {
        let mut name = match animation.name.as_deref() {
            None | Some("") => index.to_string(),
            Some(name) => name.to_owned(),
        };
        // The same name twice would hide one of them.
        if !taken.insert(name.clone()) {
            name = format!("{name}.{index}");
        }
        let place = format!("animation \"{}\"", name.escape_debug());
        match reader.clip(animation, &place) {
            // Nothing after it would fit.
            Err(limit @ Error::Limit { .. }) => return Err(limit),
            clip => named.push((name, clip)),
        }
    }
    Ok(named)
}

/// What every part of the reader needs: the file's name for errors, and the options.
#[derive(Clone, Copy)]
struct Context<'a> {
    path: &'a Path,
    options: &'a ReadOptions,
}

impl Context<'_> {
    fn format(
        &self,
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Error {
        Error::Format {
            path: self.path.into(),
            place: place.into(),
            expected: expected.into(),
            found: found.into(),
        }
    }

    fn check(&self, what: &'static str, found: u64, limit: u64) -> Result<(), Error> {
        crate::limits::check(self.path, what, found, limit)
    }
}
