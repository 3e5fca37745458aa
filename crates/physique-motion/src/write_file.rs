//! Files that are either written whole or left as they were, with this crate's errors.

use std::path::Path;

use crate::Error;

/// Writes `bytes` beside `path`, then renames: nobody sees half a file.
///
/// # Errors
/// [`Error::Io`] with the path that failed.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    Ok(physique_files::write_file(path, bytes)?)
}
