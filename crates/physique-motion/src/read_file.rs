//! Whole files within a limit, with this crate's errors.

use std::path::Path;

use crate::Error;

/// The bytes of a file, unless there are more than `limit`.
///
/// # Errors
/// [`Error::Io`]; [`Error::Limit`], before anything is read where the system knows the length.
pub(crate) fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>, Error> {
    Ok(physique_files::read_file(path, limit)?)
}
