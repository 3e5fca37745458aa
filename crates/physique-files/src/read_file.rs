//! Whole files within a limit.

use std::{fs::File, io::Read as _, path::Path};

use crate::FileError;

/// The bytes of a file, unless there are more than `limit`.
///
/// # Errors
/// [`FileError::Io`]; [`FileError::TooLarge`], before anything is read where the system knows the length.
pub fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let io = |problem| FileError::Io {
        path: path.into(),
        problem,
    };
    let file = File::open(path).map_err(io)?;
    let mut found = file.metadata().map_err(io)?.len();
    let mut bytes = Vec::new();
    if found <= limit {
        // A pipe has no length beforehand, so the limit holds while reading, too.
        let mut reader = file.take(limit.saturating_add(1));
        reader.read_to_end(&mut bytes).map_err(io)?;
        found = bytes.len() as u64;
    }
    if found > limit {
        return Err(FileError::TooLarge {
            path: path.into(),
            found,
            limit,
        });
    }
    Ok(bytes)
}
