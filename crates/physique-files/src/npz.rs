//! NumPy's `.npz` archives and `.npy` arrays, read as data and never executed.
//!
//! An `.npz` is a ZIP archive of `.npy` files; a `.npy` is a short header, written as a Python
//! dictionary, and the plain bytes of one array. This module knows nothing of motions.
//!
//! Its reader is our own, because files come from strangers: every size is checked against
//! [`ArrayLimits`] **before** memory is taken for it, products of shapes cannot overflow, inflating
//! stops at the declared size, and arrays of Python objects, which NumPy would unpickle and so
//! execute, are refused by name while their neighbours stay readable; [`objects_from_npy`] and
//! [`Archive::objects`] read them as data where they are wanted.
//!
//! Format: <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>.

mod archive;
mod array;
mod element;
mod error;
mod header;
mod writer;

pub use archive::Archive;
pub use array::Array;
pub use element::{ByteOrder, Element};
pub use error::ArrayError;
pub use writer::{ArchiveWriter, npy_f32};

use crate::pickle::{Pickle, PickleLimits};

/// Reads the bytes of a `.npy` file that holds Python objects, as data; `key` names it in errors.
/// The root of the pickle is the array of objects.
///
/// # Errors
/// [`ArrayError::Header`] or [`ArrayError::ElementType`] where it is no such file, and as
/// [`Pickle::read`].
pub fn objects_from_npy(
    key: &str,
    bytes: Vec<u8>,
    limits: &PickleLimits,
) -> Result<Pickle, crate::Error> {
    let start = header::Header::objects_start(key, &bytes)?;
    Ok(Pickle::read_at(bytes, start, limits)?)
}

/// Upper bounds that the reader checks before it allocates or inflates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArrayLimits {
    /// Bytes that one archive may unpack to, over all arrays that are read from it.
    pub bytes: u64,
    /// Arrays in an archive.
    pub entries: usize,
    /// Dimensions of an array; NumPy allows 64.
    pub dimensions: usize,
}

impl Default for ArrayLimits {
    fn default() -> Self {
        Self {
            bytes: 1 << 30,
            entries: 1024,
            dimensions: 64,
        }
    }
}
