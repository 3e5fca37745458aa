//! Runs of bytes: most lie in the file, decoded ones beside it.

/// A run of bytes in [`Bytes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Blob {
    pub(super) start: usize,
    pub(super) length: usize,
}

/// The bytes of the file, followed by those that had to be decoded, as one address space.
#[derive(Debug)]
pub(super) struct Bytes {
    file: Vec<u8>,
    decoded: Vec<u8>,
}

impl Bytes {
    pub(super) const fn new(file: Vec<u8>) -> Self {
        Self {
            file,
            decoded: Vec::new(),
        }
    }

    pub(super) fn into_file(self) -> Vec<u8> {
        self.file
    }

    pub(super) fn file(&self) -> &[u8] {
        &self.file
    }

    /// The bytes of a run; every [`Blob`] is made by this type or checked against the file.
    pub(super) fn get(&self, blob: Blob) -> &[u8] {
        let (source, start) = match blob.start.checked_sub(self.file.len()) {
            // An empty run may stand at the end of the file.
            Some(start) if blob.length > 0 => (&self.decoded, start),
            _ => (&self.file, blob.start),
        };
        source
            .get(start..)
            .and_then(|rest| rest.get(..blob.length))
            .unwrap_or_default()
    }

    /// Keeps decoded bytes; the caller has charged them.
    pub(super) fn keep(&mut self, decoded: &[u8]) -> Blob {
        let start = self.file.len() + self.decoded.len();
        self.decoded.extend_from_slice(decoded);
        Blob {
            start,
            length: decoded.len(),
        }
    }
}
