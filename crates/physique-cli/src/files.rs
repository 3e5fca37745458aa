//! The motion files that arguments name.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

/// Endings that a search of a folder picks up; a file named outright may have any.
const ENDINGS: [&str; 3] = ["bvh", "npy", "npz"];

/// Files as given; folders are replaced by the motion files below them, sorted.
pub(crate) fn motion_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() {
            let before = files.len();
            search(path, &mut files)?;
            if files.len() == before {
                bail!(
                    "{}: no motion files (.{}) in this folder",
                    path.display(),
                    ENDINGS.join(", .")
                );
            }
        } else {
            files.push(path.clone());
        }
    }
    Ok(files)
}

fn search(folder: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    let mut folders = vec![folder.to_owned()];
    let before = files.len();
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).with_context(|| folder.display().to_string())?;
        for entry in entries {
            let entry = entry.with_context(|| folder.display().to_string())?;
            // Links are not followed, so that a loop of them cannot hold us.
            let kind = entry.file_type()?;
            let path = entry.path();
            let ending = path.extension().and_then(|ending| ending.to_str());
            if kind.is_dir() {
                folders.push(path);
            } else if ending
                .is_some_and(|e| ENDINGS.iter().any(|known| known.eq_ignore_ascii_case(e)))
            {
                files.push(path);
            }
        }
    }
    files[before..].sort();
    Ok(())
}
