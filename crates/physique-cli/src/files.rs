//! The motion files that arguments name.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use physique::motion::arrays::is_statistics_file;

/// Endings that a search of a folder picks up; a file named outright may have any.
const ENDINGS: [&str; 7] = ["amc", "bvh", "glb", "npy", "npz", "pkl", "pt"];

/// A file and where it lies below the folder or pattern that found it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FoundFile {
    pub(crate) path: PathBuf,
    /// The file's name alone where the file was named outright.
    pub(crate) below: PathBuf,
}

/// Files as given; folders are replaced by the motion files below them, sorted.
pub(crate) fn motion_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let found = find_files(paths, None)?;
    Ok(found.into_iter().map(|file| file.path).collect())
}

/// Files as given; folders are replaced by the motion files below them, patterns such as
/// `data/**/*.bvh` (for shells that do not expand them) by what they match; sorted, and each once.
/// Nothing below the folder `except` is found by a search, nor means and deviations of features,
/// which are counted on standard error.
pub(crate) fn find_files(paths: &[PathBuf], except: Option<&Path>) -> Result<Vec<FoundFile>> {
    let except = except.and_then(|folder| folder.canonicalize().ok());
    let (mut files, mut seen) = (Vec::new(), HashSet::new());
    let mut statistics = Vec::new();
    for path in paths {
        let found = if path.is_dir() {
            let found = search(path, except.as_deref())?;
            let found = without_statistics(found, &mut statistics);
            if found.is_empty() {
                bail!(
                    "{}: no motion files (.{}) in this folder",
                    path.display(),
                    ENDINGS.join(", .")
                );
            }
            found
        } else if path.exists() || !is_pattern(path) {
            vec![path.clone()]
        } else {
            without_statistics(matches(path, except.as_deref())?, &mut statistics)
        };
        let root = root_of(path);
        for path in found {
            let below = path.strip_prefix(&root).unwrap_or(&path).to_owned();
            if seen.insert(path.clone()) {
                files.push(FoundFile { path, below });
            }
        }
    }
    tell_of(&statistics);
    Ok(files)
}

/// Motions apart from the arrays of statistics that lie among them in data sets.
fn without_statistics(files: Vec<PathBuf>, statistics: &mut Vec<PathBuf>) -> Vec<PathBuf> {
    let is_npy = |path: &Path| {
        path.extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("npy"))
    };
    let (passed_over, motions) = files
        .into_iter()
        .partition(|path| is_npy(path) && is_statistics_file(path));
    statistics.extend::<Vec<_>>(passed_over);
    motions
}

fn tell_of(statistics: &[PathBuf]) {
    const SHOWN: usize = 4;
    let shown = statistics
        .iter()
        .take(SHOWN)
        .map(|path| path.display().to_string());
    let shown = shown.collect::<Vec<_>>().join(", ");
    match statistics.len() {
        0 => {}
        1 => eprintln!("passed over: {shown} is the mean or deviation of a data set, no motion"),
        count => {
            let more = if count > SHOWN { ", ..." } else { "" };
            eprintln!(
                "passed over: {count} files are means or deviations of data sets, no motions: \
                 {shown}{more}"
            );
        }
    }
}

/// Whether a path that does not exist is meant as a pattern.
pub(crate) fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(['*', '?', '['])
}

/// The folder that results are laid out from: a folder itself, a pattern's part before the first
/// wildcard, a file's parent.
fn root_of(path: &Path) -> PathBuf {
    if path.is_dir() {
        return path.to_owned();
    }
    if path.exists() || !is_pattern(path) {
        return path.parent().unwrap_or(path).to_owned();
    }
    let parts = path.components();
    parts
        .take_while(|part| !is_pattern(Path::new(part)))
        .collect()
}

/// Files that a pattern matches, sorted.
fn matches(pattern: &Path, except: Option<&Path>) -> Result<Vec<PathBuf>> {
    let text = pattern.to_string_lossy();
    let mut files = Vec::new();
    for entry in glob::glob(&text).with_context(|| format!("the pattern {text}"))? {
        let path = entry?;
        if path.is_file() && !is_below(&path, except) {
            files.push(path);
        }
    }
    if files.is_empty() {
        bail!("{text}: no file matches this pattern");
    }
    Ok(files)
}

/// Motion files below a folder, sorted.
fn search(folder: &Path, except: Option<&Path>) -> Result<Vec<PathBuf>> {
    let mut folders = vec![folder.to_owned()];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        if is_below(&folder, except) {
            continue;
        }
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
    files.sort();
    Ok(files)
}

fn is_below(path: &Path, folder: Option<&Path>) -> bool {
    let (Some(folder), Ok(path)) = (folder, path.canonicalize()) else {
        return false;
    };
    path.starts_with(folder)
}
