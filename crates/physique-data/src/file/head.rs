//! The first 64 bytes.

use std::path::Path;

use crate::{DataLimits, Error};

pub(super) const LENGTH: usize = 64;
const MAGIC: &[u8; 8] = b"PHYSDATA";
const VERSION: u32 = 1;

/// What the head says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Head {
    pub(super) columns: u32,
    pub(super) rows: u64,
    pub(super) index_bytes: u64,
    pub(super) index_checksum: u64,
    pub(super) rows_checksum: u64,
}

impl Head {
    pub(super) fn to_bytes(self) -> [u8; LENGTH] {
        let mut bytes = [0; LENGTH];
        bytes[..8].copy_from_slice(MAGIC);
        bytes[8..12].copy_from_slice(&VERSION.to_le_bytes());
        bytes[12..16].copy_from_slice(&self.columns.to_le_bytes());
        let numbers = [
            self.rows,
            self.index_bytes,
            self.index_checksum,
            self.rows_checksum,
        ];
        for (place, number) in bytes[16..48].chunks_exact_mut(8).zip(numbers) {
            place.copy_from_slice(&number.to_le_bytes());
        }
        bytes
    }

    /// Reads the head and holds it against the length of the file, before anything is taken from it.
    pub(super) fn parse(bytes: &[u8], path: &Path, limits: &DataLimits) -> Result<Self, Error> {
        let fail = |place: &str, expected: String, found: String| Error::Format {
            path: path.into(),
            place: place.into(),
            expected,
            found,
        };
        let Some(head) = bytes.first_chunk::<LENGTH>() else {
            let found = format!("{} bytes", bytes.len());
            return Err(fail("head", format!("{LENGTH} bytes"), found));
        };
        if !head.starts_with(MAGIC) {
            let found = format!("\"{}\"", head[..8].escape_ascii());
            return Err(fail("byte 0", "a data file, \"PHYSDATA\"".into(), found));
        }
        let word =
            |at: usize| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
        let long = |at: usize| u64::from(word(at)) | u64::from(word(at + 4)) << 32;
        if word(8) != VERSION {
            let found = word(8).to_string();
            return Err(fail("byte 8", format!("version {VERSION}"), found));
        }
        if head[48..].iter().any(|&byte| byte != 0) {
            let found = format!("\"{}\"", head[48..].escape_ascii());
            return Err(fail("byte 48", "16 zeros".into(), found));
        }
        let head = Self {
            columns: word(12),
            rows: long(16),
            index_bytes: long(24),
            index_checksum: long(32),
            rows_checksum: long(40),
        };
        if head.index_bytes > limits.index_bytes {
            return Err(Error::Limit {
                path: path.into(),
                what: "the size of the index in bytes",
                found: head.index_bytes,
                limit: limits.index_bytes,
            });
        }
        let length = head.length();
        if length != Some(bytes.len() as u64) {
            let expected = length.map_or_else(
                || "a length that a file can have".to_owned(),
                |length| format!("{length} bytes"),
            );
            let found = format!("{} bytes", bytes.len());
            return Err(fail("length of the file", expected, found));
        }
        Ok(head)
    }

    /// Bytes of all rows.
    pub(super) fn row_bytes(&self) -> Option<u64> {
        self.rows
            .checked_mul(u64::from(self.columns))?
            .checked_mul(4)
    }

    /// Bytes of the whole file.
    fn length(&self) -> Option<u64> {
        self.row_bytes()?
            .checked_add(LENGTH as u64)?
            .checked_add(self.index_bytes)
    }
}

/// FNV-1a.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Checksum(pub(super) u64);

impl Default for Checksum {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Checksum {
    pub(super) fn add_rows(&mut self, rows: &[f32]) {
        for number in rows {
            self.add(number.to_bits());
        }
    }

    pub(super) fn of_bytes(bytes: &[u8]) -> Self {
        let mut checksum = Self::default();
        for &byte in bytes {
            checksum.add(u32::from(byte));
        }
        checksum
    }

    fn add(&mut self, word: u32) {
        self.0 = (self.0 ^ u64::from(word)).wrapping_mul(0x0000_0100_0000_01b3);
    }
}
