//! A ZIP archive of arrays.

use std::io::{Cursor, Read};

use zip::ZipArchive;

use super::{Array, ArrayError, ArrayLimits, objects_from_npy};
use crate::pickle::{Pickle, PickleLimits};

/// An opened `.npz`: its list of arrays, read one by one when asked for.
#[derive(Debug)]
pub struct Archive {
    zip: ZipArchive<Cursor<Vec<u8>>>,
    keys: Vec<String>,
    limits: ArrayLimits,
    /// Bytes that may still be unpacked.
    remaining: u64,
}

impl Archive {
    /// Opens the bytes of an `.npz` and lists its arrays; nothing is unpacked yet.
    ///
    /// # Errors
    /// [`ArrayError::Archive`] for anything but a ZIP file, [`ArrayError::Entries`] for too many.
    pub fn open(bytes: Vec<u8>, limits: ArrayLimits) -> Result<Self, ArrayError> {
        let zip = ZipArchive::new(Cursor::new(bytes))
            .map_err(|problem| ArrayError::Archive { problem })?;
        if zip.len() > limits.entries {
            return Err(ArrayError::Entries {
                found: zip.len(),
                limit: limits.entries,
            });
        }
        let keys = zip
            .file_names_raw()
            .filter_map(|name| str::from_utf8(name).ok()?.strip_suffix(".npy"))
            .map(str::to_owned)
            .collect();
        Ok(Self {
            zip,
            keys,
            limits,
            remaining: limits.bytes,
        })
    }

    /// Whether bytes start as a ZIP file does.
    pub fn looks_like(bytes: &[u8]) -> bool {
        bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06")
    }

    /// Names of the arrays, in the order of the archive.
    pub fn keys(&self) -> &[String] {
        &self.keys
    }

    /// Whether there is an array of this name.
    pub fn contains(&self, key: &str) -> bool {
        self.keys.iter().any(|known| known == key)
    }

    /// Unpacks and checks one array.
    ///
    /// # Errors
    /// [`ArrayError::Missing`], [`ArrayError::Bytes`] when it unpacks to more than the limit
    /// leaves, [`ArrayError::Unpack`] for broken compression, and all of [`Array::from_npy`].
    pub fn array(&mut self, key: &str) -> Result<Array, ArrayError> {
        let bytes = self.npy(key)?;
        Array::from_npy(key, bytes, &self.limits)
    }

    /// Unpacks an array of Python objects and reads its pickle as data; an array of plain
    /// elements is [`crate::Error::Array`].
    ///
    /// # Errors
    /// As [`Archive::array`] and [`crate::pickle::Pickle::read`].
    pub fn objects(&mut self, key: &str, limits: &PickleLimits) -> Result<Pickle, crate::Error> {
        let bytes = self.npy(key)?;
        objects_from_npy(key, bytes, limits)
    }

    /// Names of all entries, arrays or not, in the order of the archive.
    pub fn entries(&self) -> impl Iterator<Item = &str> {
        self.zip
            .file_names_raw()
            .filter_map(|name| str::from_utf8(name).ok())
    }

    /// Unpacks one entry, array or not.
    ///
    /// # Errors
    /// [`ArrayError::Missing`], [`ArrayError::Bytes`] and [`ArrayError::Unpack`].
    pub fn entry(&mut self, name: &str) -> Result<Vec<u8>, ArrayError> {
        match self.zip.index_for_name(name) {
            Some(index) => self.unpack(index, name),
            None => Err(ArrayError::Missing {
                key: name.into(),
                keys: self.entries().map(str::to_owned).collect(),
            }),
        }
    }

    /// Gives the bytes of the archive back.
    pub fn into_bytes(self) -> Vec<u8> {
        self.zip.into_inner().into_inner()
    }

    fn npy(&mut self, key: &str) -> Result<Vec<u8>, ArrayError> {
        match self.zip.index_for_name(&format!("{key}.npy")) {
            Some(index) => self.unpack(index, key),
            None => Err(ArrayError::Missing {
                key: key.into(),
                keys: self.keys.clone(),
            }),
        }
    }

    fn unpack(&mut self, index: usize, key: &str) -> Result<Vec<u8>, ArrayError> {
        let unpack = |reason: String| ArrayError::Unpack {
            key: key.into(),
            reason,
        };
        let entry = self
            .zip
            .by_index(index)
            .map_err(|error| unpack(error.to_string()))?;
        let (declared, limit) = (entry.size(), self.remaining);
        let too_large = |found| ArrayError::Bytes {
            key: key.into(),
            found,
            limit,
        };
        if declared > limit {
            return Err(too_large(declared));
        }
        // The declared size may lie: grow with what really comes, and stop behind the limit.
        let mut bytes = Vec::with_capacity(declared.min(1 << 20) as usize);
        entry
            .take(limit.saturating_add(1))
            .read_to_end(&mut bytes)
            .map_err(|error| unpack(error.to_string()))?;
        if bytes.len() as u64 > limit {
            return Err(too_large(bytes.len() as u64));
        }
        self.remaining -= bytes.len() as u64;
        Ok(bytes)
    }
}
