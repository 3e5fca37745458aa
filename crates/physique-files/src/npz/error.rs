//! What can go wrong with an array or an archive of arrays.

/// Why an array could not be read or written; `key` names the array.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ArrayError {
    /// The bytes are no ZIP archive, or a broken one.
    #[error("The archive cannot be opened: expected a ZIP file of arrays, found {problem}.")]
    Archive {
        /// What the ZIP reader said.
        problem: zip::result::ZipError,
    },
    /// More entries than [`super::ArrayLimits::entries`].
    #[error("The archive holds {found} entries, above the limit of {limit}.")]
    Entries {
        /// Entries found.
        found: usize,
        /// Entries allowed.
        limit: usize,
    },
    /// More bytes than [`super::ArrayLimits::bytes`] leave.
    #[error("Array `{key}` takes {found} bytes, above the {limit} that the limit leaves.")]
    Bytes {
        /// The array.
        key: String,
        /// Bytes asked for.
        found: u64,
        /// Bytes left.
        limit: u64,
    },
    /// No such array.
    #[error("Expected an array `{key}`, found only {}.", list(.keys))]
    Missing {
        /// The array asked for.
        key: String,
        /// The arrays that are there.
        keys: Vec<String>,
    },
    /// The compressed bytes of an array are broken.
    #[error("Array `{key}` cannot be unpacked: {reason}.")]
    Unpack {
        /// The array.
        key: String,
        /// What the ZIP reader said.
        reason: String,
    },
    /// The header of an array is not what NumPy writes.
    #[error("Array `{key}`, byte {byte} of the header: expected {expected}, found {found}.")]
    Header {
        /// The array.
        key: String,
        /// Position in the header.
        byte: usize,
        /// What the format demands.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// Elements of a type that is no plain number or text.
    #[error(
        "Array `{key}` has elements of type `{found}`, which are not read: {reason}; expected plain numbers or text."
    )]
    ElementType {
        /// The array.
        key: String,
        /// NumPy's type string.
        found: String,
        /// Why this type is refused.
        reason: &'static str,
    },
    /// A shape whose size overflows or has too many dimensions.
    #[error("Array `{key}` has the impossible shape {shape:?}.")]
    Shape {
        /// The array.
        key: String,
        /// The shape that the header states.
        shape: Vec<usize>,
    },
    /// Fewer or more bytes of data than the header promises.
    #[error("Array `{key}` promises {expected} bytes of data, found {found}.")]
    DataLength {
        /// The array.
        key: String,
        /// Bytes that shape and type ask for.
        expected: u64,
        /// Bytes that follow the header.
        found: u64,
    },
    /// The array is readable, but not as what was asked for.
    #[error("Array `{key}`: expected {expected}, found {found}.")]
    Content {
        /// The array.
        key: String,
        /// What was asked for.
        expected: &'static str,
        /// What it holds.
        found: String,
    },
    /// An archive could not be written.
    #[error("Array `{key}` cannot be written: {reason}.")]
    Write {
        /// The array.
        key: String,
        /// What the ZIP writer said.
        reason: String,
    },
}

fn list(keys: &[String]) -> String {
    if keys.is_empty() {
        return "an empty archive".into();
    }
    let shown: Vec<_> = keys.iter().take(20).map(|key| format!("`{key}`")).collect();
    let more = if keys.len() > shown.len() {
        ", ..."
    } else {
        ""
    };
    shown.join(", ") + more
}
