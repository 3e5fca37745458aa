//! What can go wrong with a file.

use std::path::PathBuf;

use crate::npz::ArrayError;
use crate::pickle::PickleError;

/// Why the bytes of a file could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The operating system refused.
    #[error("{path}: {problem}")]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said. Part of the message, so not told again as its source.
        problem: std::io::Error,
    },
    /// A file that is larger than the limit.
    #[error(
        "{path}: the size in bytes is {found}, above the limit of {limit}; raise the limit if the file is right."
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Bytes of the file, or of what was read of it.
        found: u64,
        /// Bytes allowed.
        limit: u64,
    },
}

/// Why the content of a file could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The bytes of the file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A NumPy array or archive that is broken.
    #[error(transparent)]
    Array(#[from] ArrayError),
    /// A pickle that is broken, or that holds more than data.
    #[error(transparent)]
    Pickle(#[from] PickleError),
    /// A PyTorch file that is broken.
    #[error("PyTorch file, {place}: expected {expected}, found {found}.")]
    Torch {
        /// Where in the file.
        place: String,
        /// What the format demands.
        expected: &'static str,
        /// What the file holds.
        found: String,
    },
    /// A compressed file that is broken, or that holds more than the limit.
    #[error("The file is compressed by {method}: expected {expected}, found {found}.")]
    Compressed {
        /// gzip or zlib.
        method: &'static str,
        /// What was expected.
        expected: String,
        /// What the stream holds.
        found: String,
    },
    /// The arrays of a file are more than the limit.
    #[error("The arrays of the file: {what} is above the limit of {limit}.")]
    NamedArrays {
        /// What is too large.
        what: &'static str,
        /// Allowed.
        limit: u64,
    },
    /// A file of no known format.
    #[error("Expected a .npy, .npz, .pkl or .pt file, found bytes that start with {start}.")]
    UnknownFormat {
        /// The first bytes, escaped.
        start: String,
    },
}
