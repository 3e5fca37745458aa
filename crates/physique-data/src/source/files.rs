//! What lies below a folder.

use std::fs;
use std::path::Path;

use crate::Error;

/// Endings of files that may hold motions; others are only found by patterns that name them.
const MOTION_ENDINGS: [&str; 8] = ["amc", "bvh", "glb", "gltf", "npy", "npz", "pkl", "pt"];

/// Names of all files below a folder, sorted, with `/` between names. Links are not followed.
pub(super) fn below(folder: &Path) -> Result<Vec<String>, Error> {
    let mut names = Vec::new();
    let mut folders = vec![(folder.to_owned(), String::new())];
    while let Some((folder, prefix)) = folders.pop() {
        let io = |problem| Error::io(&folder, problem);
        for entry in fs::read_dir(&folder).map_err(io)? {
            let entry = entry.map_err(io)?;
            let kind = entry.file_type().map_err(io)?;
            // A name that is no text cannot stand in a recipe.
            let Some(name) = entry
                .file_name()
                .to_str()
                .map(|name| format!("{prefix}{name}"))
            else {
                continue;
            };
            if kind.is_dir() {
                folders.push((entry.path(), format!("{name}/")));
            } else if kind.is_file() {
                names.push(name);
            }
        }
    }
    names.sort_unstable();
    Ok(names)
}

/// Whether a file's name says that it may hold a motion.
pub(super) fn may_hold_motion(name: &str) -> bool {
    let ending = Path::new(name)
        .extension()
        .and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| {
        MOTION_ENDINGS
            .iter()
            .any(|known| ending.eq_ignore_ascii_case(known))
    })
}

/// A name without its ending.
pub(super) fn without_ending(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((stem, ending)) if !ending.contains('/') => stem,
        _ => name,
    }
}
