//! The file: a head of 64 bytes, the rows, and the index as JSON.
//!
//! | bytes | what |
//! |---|---|
//! | 0..8 | `PHYSDATA` |
//! | 8..12 | version, 1 |
//! | 12..16 | numbers in a row |
//! | 16..24 | rows |
//! | 24..32 | bytes of the index |
//! | 32..40 | checksum of the index |
//! | 40..48 | checksum of the rows |
//! | 48..64 | 0 |
//! | 64.. | rows, 32-bit floats |
//! | then | the index, to the end of the file |
//!
//! All numbers are little-endian. Checksums are FNV-1a over 32-bit words for rows and over bytes for
//! the index: they tell accidents, not malice.

mod check;
mod head;
mod read;
mod write;

pub(crate) use read::{Rows, from_bytes, open};
pub(crate) use write::Writer;
