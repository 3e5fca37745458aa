//! What a list leaves out: files, and motions of files that hold several.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

/// Motions of files that are left out, as `results.npy#3`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Excluded(BTreeSet<PathBuf>);

impl Excluded {
    /// The motions in order, for what tells a job from others.
    pub(crate) fn motions(&self) -> impl Iterator<Item = &Path> {
        self.0.iter().map(PathBuf::as_path)
    }

    /// Takes out the motions of a file that are left out; says which of them it does not hold.
    pub(crate) fn leave_out<T>(&self, file: &Path, motions: &mut Vec<(String, T)>) {
        let is_of_file = |path: &&PathBuf| file_of(path).as_deref() == Some(file);
        for path in self.0.iter().filter(is_of_file) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let before = motions.len();
            motions.retain(|(known, _)| *known != name);
            if motions.len() == before {
                eprintln!("--exclude: {} holds no {name}", file.display());
            }
        }
    }
}

/// The files without those that a list names, one a line, and the motions of the others that it
/// names by `FILE#KEY`. Lines that name nothing here are counted on standard error.
pub(crate) fn without(
    files: Vec<PathBuf>,
    list: Option<&Path>,
) -> Result<(Vec<PathBuf>, Excluded)> {
    let Some(list) = list else {
        return Ok((files, Excluded::default()));
    };
    let text = std::fs::read_to_string(list).with_context(|| list.display().to_string())?;
    let here: BTreeSet<&Path> = files.iter().map(PathBuf::as_path).collect();
    let (mut whole, mut motions, mut others) = (BTreeSet::new(), BTreeSet::new(), 0);
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let path = Path::new(line);
        if here.contains(path) {
            whole.insert(path.to_owned());
        } else if file_of(path).is_some_and(|file| here.contains(file.as_path())) {
            motions.insert(path.to_owned());
        } else {
            others += 1;
        }
    }
    if others > 0 {
        eprintln!(
            "--exclude: {others} of the lines of {} name no file of this run",
            list.display()
        );
    }
    let left: Vec<_> = files
        .into_iter()
        .filter(|file| !whole.contains(file))
        .collect();
    if left.is_empty() {
        bail!("{}: no file is left", list.display());
    }
    Ok((left, Excluded(motions)))
}

/// The file of `FILE#KEY`.
fn file_of(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let (file, _) = name.rsplit_once('#')?;
    Some(path.with_file_name(file))
}
