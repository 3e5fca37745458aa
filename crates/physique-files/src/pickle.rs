//! Python pickles, read as data and never executed.
//!
//! A pickle is a program for a small stack machine, and Python runs whatever functions it names.
//! [`Pickle::read`] runs the same instructions on values of its own. Of functions and classes it
//! knows only a short list that make plain data, and what they make is written here, in Rust:
//!
//! | named in the file | becomes |
//! |---|---|
//! | NumPy's `_reconstruct`, `_frombuffer`, `scalar`, `ndarray`, `dtype` | an array |
//! | joblib's `NumpyArrayWrapper` with the bytes behind it | an array |
//! | `collections.OrderedDict`, `defaultdict`, `set`, `frozenset`, `bytes`, `bytearray`, `_codecs.encode` | itself |
//! | chumpy's `Ch` and `Select`, SciPy's `csc_matrix` and `csr_matrix` | an object: class and attributes |
//! | PyTorch's `_rebuild_tensor_v2`, `_rebuild_parameter` and storages | a tensor, see [`crate::torch`] |
//!
//! Every other name is [`PickleError::Refused`] with its module; there is no fallback.
//!
//! Values live in one table and refer to each other by number, as they do in Python: shared parts
//! are stored once, lists may contain themselves, and neither reading nor dropping recurses. All
//! memory is charged against [`PickleLimits`] before it is taken. Text, bytes and the data of
//! arrays stay in the file's bytes. Cost: linear in the size of the file.

mod array;
mod blob;
mod cursor;
mod document;
mod error;
mod escapes;
mod fill;
mod global;
mod instruction;
mod limits;
mod machine;
mod make;
mod node;
mod stack;
mod step;
mod value;

pub use document::Pickle;
pub use error::PickleError;
pub use limits::PickleLimits;
pub use node::{Storage, StorageElement};
pub use value::{Items, Object, Tensor, Value, View};
