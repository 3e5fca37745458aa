//! What can go wrong with recipes and data files.

use std::path::PathBuf;

use physique_files::FileError;

/// Why a data set could not be built or used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The operating system refused.
    #[error("{path}: {problem}")]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        problem: std::io::Error,
    },
    /// A file could not be read or written whole.
    #[error(transparent)]
    File(#[from] FileError),
    /// A recipe that is no recipe.
    #[error("{recipe}: {problem}")]
    Recipe {
        /// The recipe's file or name.
        recipe: String,
        /// Place, expectation and finding.
        problem: String,
    },
    /// A folder that does not hold what the recipe says.
    #[error("{folder}: expected {expected}, found {found}.")]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What the recipe says.
        expected: String,
        /// What is there.
        found: String,
    },
    /// A table, list or text file of a data set that cannot be understood.
    #[error("{path}, {place}: expected {expected}, found {found}.")]
    Table {
        /// The file.
        path: PathBuf,
        /// Line or column.
        place: String,
        /// What was expected.
        expected: &'static str,
        /// What is there.
        found: String,
    },
    /// A data file that is broken, or none.
    #[error("{path}, {place}: expected {expected}, found {found}.")]
    Format {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        place: String,
        /// What the format demands.
        expected: String,
        /// What the file holds.
        found: String,
    },
    /// A file that asks for more than [`crate::DataLimits`] allow.
    #[error(
        "{path}: {what} is {found}, above the limit of {limit}; raise the limit if the file is right."
    )]
    Limit {
        /// The file.
        path: PathBuf,
        /// What is too large.
        what: &'static str,
        /// Asked for.
        found: u64,
        /// Allowed.
        limit: u64,
    },
    /// A window that its clip does not have.
    #[error(
        "Clip {clip} of {clips} has {frames} rows of features; a window from {start} of length {length} is not in it."
    )]
    Window {
        /// Clip asked for.
        clip: usize,
        /// Clips of the data set.
        clips: usize,
        /// Rows of the clip; 0 where there is no such clip.
        frames: usize,
        /// First row asked for.
        start: usize,
        /// Rows asked for.
        length: usize,
    },
    /// A favoured value that cannot be.
    #[error(
        "A plan favours {value:?} by a factor of {factor}: expected a factor above 0 and one of the values that \
         training clips have ({known})."
    )]
    Favoured {
        /// Value of the label that draws are balanced by.
        value: String,
        /// How many times as often.
        factor: f64,
        /// Values that training clips have.
        known: String,
    },
    /// Nothing to draw from.
    #[error(
        "No clip of the {split} split is {frames} rows long: there is nothing to draw windows from."
    )]
    NothingToDraw {
        /// Which split.
        split: &'static str,
        /// Shortest window.
        frames: usize,
    },
    /// No clip was left to write.
    #[error("None of {found} motions can be learnt from; the first was left out because: {first}")]
    NothingLeft {
        /// Motions looked at.
        found: usize,
        /// Why the first one was left out.
        first: String,
    },
    /// Data files that do not go together.
    #[error("Joining data files, {what}: expected {expected}, found {found}.")]
    Join {
        /// What differs.
        what: &'static str,
        /// What the first file has.
        expected: String,
        /// What another one has.
        found: String,
    },
    /// Features that cannot be taken, stored or restored.
    #[error(transparent)]
    Motion(Box<physique::motion::Error>),
    /// A file of motions that cannot be brought to the body.
    #[error(transparent)]
    Physique(Box<physique::Error>),
}

impl From<physique::motion::Error> for Error {
    fn from(error: physique::motion::Error) -> Self {
        Self::Motion(Box::new(error))
    }
}

impl From<physique::Error> for Error {
    fn from(error: physique::Error) -> Self {
        Self::Physique(Box::new(error))
    }
}

impl Error {
    pub(crate) fn io(path: impl Into<PathBuf>, problem: std::io::Error) -> Self {
        Self::Io {
            path: path.into(),
            problem,
        }
    }
}
