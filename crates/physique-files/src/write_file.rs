//! Files that are either written whole or left as they were.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::FileError;

/// Writes `bytes` beside `path`, then renames: nobody sees half a file.
///
/// # Errors
/// [`FileError::Io`] with the path that failed.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let io = |problem| FileError::Io {
        path: path.into(),
        problem,
    };
    let mut beside = path.as_os_str().to_owned();
    beside.push(format!(".{}.partial", std::process::id()));
    let beside = PathBuf::from(beside);
    let written = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, path));
    written.map_err(|source| {
        // The first error is the one to tell; what is left of the file may not even exist.
        let _ = fs::remove_file(&beside);
        io(source)
    })
}
