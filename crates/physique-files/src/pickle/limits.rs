//! How much a pickle may ask for.

use super::PickleError;

/// Upper bounds that the reader checks before it takes memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PickleLimits {
    /// Bytes of memory that values may take beside the file itself. Strings and array data stay
    /// in the file's bytes and cost nothing more.
    pub bytes: u64,
    /// Values of any kind.
    pub values: usize,
    /// Values that later ones refer back to.
    pub memo: usize,
    /// Containers that are open at a time.
    pub depth: usize,
}

impl Default for PickleLimits {
    fn default() -> Self {
        Self {
            bytes: 1 << 30,
            values: 1 << 23,
            memo: 1 << 22,
            depth: 1024,
        }
    }
}

/// Memory that is left.
#[derive(Debug)]
pub(super) struct Budget {
    left: u64,
    limit: u64,
}

impl Budget {
    pub(super) const fn new(limit: u64) -> Self {
        Self { left: limit, limit }
    }

    /// Takes `bytes` of what is left; called before the memory itself is taken.
    pub(super) fn charge(&mut self, byte: usize, bytes: usize) -> Result<(), PickleError> {
        let bytes = bytes as u64;
        match self.left.checked_sub(bytes) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(PickleError::Limit {
                byte,
                what: "the memory of its values, in bytes,",
                found: (self.limit - self.left).saturating_add(bytes),
                limit: self.limit,
            }),
        }
    }
}
