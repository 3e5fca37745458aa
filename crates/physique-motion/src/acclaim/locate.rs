//! Where the skeleton of a motion lies.

use std::fs;
use std::path::{Path, PathBuf};

use crate::{Error, ReadOptions};

/// The `.asf` that belongs to an `.amc`: [`ReadOptions::skeleton`] if given; else, in the motion's
/// folder, the file of the same name, or of the name cut at one of its underscores (`02.asf` for
/// `02_01.amc`), or the only one there is. Letter case of the ending does not matter.
///
/// # Errors
/// [`Error::Format`] when there is none, or several and none of that name.
pub fn find_skeleton(motion: &Path, options: &ReadOptions) -> Result<PathBuf, Error> {
    if let Some(given) = &options.skeleton {
        return Ok(given.clone());
    }
    let folder = match motion.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut there: Vec<PathBuf> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| {
            path.extension()
                .is_some_and(|end| end.eq_ignore_ascii_case("asf"))
        })
        .collect();
    there.sort();

    let stem = motion.file_stem().unwrap_or_default().to_string_lossy();
    let cuts = stem.match_indices('_').map(|(cut, _)| &stem[..cut]);
    // The longest name first.
    for name in std::iter::once(stem.as_ref()).chain(cuts.rev()) {
        let is_it = |path: &&PathBuf| path.file_stem().is_some_and(|stem| stem == name);
        if let Some(found) = there.iter().find(is_it) {
            return Ok(found.clone());
        }
    }
    match there.as_slice() {
        [only] => Ok(only.clone()),
        others => Err(Error::Format {
            path: motion.into(),
            place: "its skeleton".into(),
            expected: format!("{stem}.asf beside it, or a skeleton given as an option"),
            found: match others.len() {
                0 => "no .asf file in its folder".into(),
                count => format!("{count} .asf files of other names"),
            },
        }),
    }
}
