//! What can go wrong with the files of an encoder.

use std::path::PathBuf;

use physique_files::FileError;

/// Why an encoder could not be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A PyTorch file that is broken, or that holds more than data.
    #[error("{path}: {problem}")]
    Data {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: physique_files::Error,
    },
    /// A file whose content is not what it should be.
    #[error("{path}, {place}: expected {expected}, found {found}.")]
    Format {
        /// The file.
        path: PathBuf,
        /// Tensor, key or line.
        place: String,
        /// What was expected.
        expected: String,
        /// What is there.
        found: String,
    },
    /// A folder that lacks a file.
    #[error("{folder}: expected {expected}, found none of them.")]
    Missing {
        /// The folder.
        folder: PathBuf,
        /// The files that would do.
        expected: &'static str,
    },
    /// An index of no captions.
    #[error("Expected one or more captions to compare with, found none.")]
    NoCaptions,
}
