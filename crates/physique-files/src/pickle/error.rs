//! What can go wrong with a pickle.

/// Why a pickle could not be read; `byte` is a position in the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PickleError {
    /// The file ends in the middle.
    #[error("Pickle, byte {byte}: expected {expected}, found the end of the file.")]
    Truncated {
        /// Where the missing piece starts.
        byte: usize,
        /// The missing piece.
        expected: &'static str,
    },
    /// Something else than a pickle's grammar allows.
    #[error("Pickle, byte {byte}: expected {expected}, found {found}.")]
    Malformed {
        /// Start of the instruction.
        byte: usize,
        /// What the grammar allows.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// A function or class that is not on the list of makers of plain data.
    #[error(
        "Pickle, byte {byte}: it asks Python for `{module}.{name}`, which is not on the list of plain data; it is refused, and nothing was run."
    )]
    Refused {
        /// Start of the instruction.
        byte: usize,
        /// Python's module.
        module: String,
        /// Name in the module.
        name: String,
    },
    /// A known maker of data with arguments that it never has.
    #[error("Pickle, byte {byte}: `{callable}` expects {expected}, found {found}.")]
    Call {
        /// Start of the instruction.
        byte: usize,
        /// The function or class.
        callable: &'static str,
        /// What it takes.
        expected: &'static str,
        /// What the file hands it.
        found: String,
    },
    /// A pickle that asks for more than [`super::PickleLimits`] allow.
    #[error(
        "Pickle, byte {byte}: {what} would grow to {found}, above the limit of {limit}; raise the limit if the file is right."
    )]
    Limit {
        /// Start of the instruction.
        byte: usize,
        /// What is too large.
        what: &'static str,
        /// Asked for.
        found: u64,
        /// Allowed.
        limit: u64,
    },
    /// The pickle is readable, but not as what was asked for.
    #[error("Pickle, {place}: expected {expected}, found {found}.")]
    Content {
        /// The value asked for.
        place: String,
        /// What was asked for.
        expected: &'static str,
        /// What it is.
        found: String,
    },
}
