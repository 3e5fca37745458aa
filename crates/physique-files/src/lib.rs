//! The room for reading data from strangers.
//!
//! Researchers share bodies and motions as NumPy arrays, Python pickles and PyTorch files. Python
//! itself *executes* the last two. This crate reads all of them as plain data:
//!
//! * [`npz`]: `.npy` arrays and `.npz` archives, in and out;
//! * [`pickle`]: every pickle protocol (0 to 5, from Python 2 and 3), with NumPy arrays, SciPy
//!   sparse matrices, chumpy and joblib arrays turned into values;
//! * [`torch`]: `.pt` files, as ZIP archive and in the form before PyTorch 1.6;
//! * [`Data`]: the values of a `.npy`, `.npz`, `.pkl` or `.pt` as one tree, whatever it is, and
//!   [`named_arrays`]: its arrays by name;
//! * [`unpacked`]: gzip and zlib streams, within a limit;
//! * [`read_file`] and [`write_file`]: whole files within a limit, and written whole or not at all.
//!
//! No file can run code, crash the process or take more memory than its limit: sizes are checked
//! before memory is taken for them, nothing recurses, and a pickle's globals are refused by module
//! and name unless they are on a short list of makers of data.
//!
//! This crate knows nothing of bodies or motions.

mod compressed;
pub mod data;
mod error;
pub mod named;
pub mod npz;
pub mod pickle;
mod read_file;
pub mod torch;
mod write_file;

pub use compressed::unpacked;
pub use data::Data;
pub use error::{Error, FileError};
pub use named::named_arrays;
pub use read_file::read_file;
pub use write_file::write_file;
