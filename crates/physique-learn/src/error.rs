//! What can go wrong with networks, their files, and training them.

use std::fmt;
use std::path::PathBuf;

/// Why a network, a checkpoint or a run does not work.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] physique_files::FileError),
    /// Features that are none.
    #[error(transparent)]
    Motion(Box<physique_motion::Error>),
    /// The self-intersection loss could not be computed.
    #[error(transparent)]
    Proxy(Box<physique_proxy::Error>),
    /// A text encoder or its captions that cannot be used.
    #[error(transparent)]
    Text(Box<physique_text::Error>),
    /// A data file that cannot be used.
    #[error(transparent)]
    Data(Box<physique_data::Error>),
    /// A motion that cannot be scored.
    #[error(transparent)]
    Score(Box<physique::Error>),
    /// A file that is broken, or that holds more than data.
    #[error("{file}: {problem}")]
    Content {
        /// The file.
        file: PathBuf,
        /// What is wrong with it.
        problem: Box<physique_files::Error>,
    },
    /// A checkpoint that is not what its format demands.
    #[error("Checkpoint {file}, {place}: expected {expected}, found {found}.")]
    Checkpoint {
        /// The file.
        file: PathBuf,
        /// Where in the file.
        place: String,
        /// What the format demands.
        expected: String,
        /// What the file holds.
        found: String,
    },
    /// Word vectors that cannot be used.
    #[error("Word vectors {file}: expected {expected}, found {found}.")]
    Words {
        /// The file.
        file: PathBuf,
        /// What was expected.
        expected: String,
        /// What the file holds.
        found: String,
    },
    /// Parameters of another network.
    #[error(
        "Parameters of {source_name}: expected exactly those of {network}; missing: {missing}; not known: {surplus}."
    )]
    Parameters {
        /// Where the parameters are from.
        source_name: String,
        /// The network that they are for.
        network: &'static str,
        /// Names that the network has and the source lacks.
        missing: Names,
        /// Names that the source has and the network lacks.
        surplus: Names,
    },
    /// A parameter of another size.
    #[error("Parameters of {source_name}, `{name}`: expected shape {expected:?}, found {found:?}.")]
    ParameterShape {
        /// Where the parameters are from.
        source_name: String,
        /// The parameter.
        name: String,
        /// Shape in the network.
        expected: Vec<usize>,
        /// Shape in the source.
        found: Vec<usize>,
    },
    /// A setting that cannot be.
    #[error("Setting {what}: expected {expected}, found {found}.")]
    Setting {
        /// Which setting.
        what: &'static str,
        /// What is possible.
        expected: String,
        /// What was asked for.
        found: String,
    },
    /// Training that has left the range of numbers.
    #[error(
        "Training, step {step}: the {what} is {found}; the newest checkpoint is of before that. A lower learning rate or clipping of the gradient may help."
    )]
    NotFinite {
        /// The step, counted from 1.
        step: u64,
        /// What is no number.
        what: String,
        /// What it is.
        found: f64,
    },
    /// A device that this program or this machine does not have.
    #[error("Device {device}: {problem}.")]
    NoDevice {
        /// The device that was asked for.
        device: String,
        /// Why there is none.
        problem: String,
    },
    /// The device failed.
    #[error("The device could not return its numbers: {problem}.")]
    Device {
        /// What it said.
        problem: String,
    },
    /// Inputs that do not fit a network or each other.
    #[error("{what}: expected {expected}, found {found}.")]
    Input {
        /// Which input.
        what: &'static str,
        /// What fits.
        expected: String,
        /// What was given.
        found: String,
    },
}

impl From<physique_motion::Error> for Error {
    fn from(error: physique_motion::Error) -> Self {
        Self::Motion(Box::new(error))
    }
}

impl From<physique_data::Error> for Error {
    fn from(error: physique_data::Error) -> Self {
        Self::Data(Box::new(error))
    }
}

impl From<physique_text::Error> for Error {
    fn from(error: physique_text::Error) -> Self {
        Self::Text(Box::new(error))
    }
}

impl From<physique::Error> for Error {
    fn from(error: physique::Error) -> Self {
        Self::Score(Box::new(error))
    }
}

impl From<physique_proxy::Error> for Error {
    fn from(error: physique_proxy::Error) -> Self {
        Self::Proxy(Box::new(error))
    }
}

impl Error {
    pub(crate) fn setting(
        what: &'static str,
        expected: impl Into<String>,
        found: impl fmt::Display,
    ) -> Self {
        Self::Setting {
            what,
            expected: expected.into(),
            found: found.to_string(),
        }
    }

    pub(crate) fn input(
        what: &'static str,
        expected: impl Into<String>,
        found: impl fmt::Display,
    ) -> Self {
        Self::Input {
            what,
            expected: expected.into(),
            found: found.to_string(),
        }
    }
}

/// Names in a message: the first eight, and how many more.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names(pub Vec<String>);

impl fmt::Display for Names {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 8;
        if self.0.is_empty() {
            return formatter.write_str("none");
        }
        for (index, name) in self.0.iter().take(SHOWN).enumerate() {
            let comma = if index == 0 { "" } else { ", " };
            write!(formatter, "{comma}`{}`", name.escape_debug())?;
        }
        match self.0.len().saturating_sub(SHOWN) {
            0 => Ok(()),
            more => write!(formatter, " and {more} more"),
        }
    }
}
