//! A pickle that has been read.

use super::blob::{Blob, Bytes};
use super::machine::{Finished, Machine};
use super::node::{Id, Node, Storage};
use super::value::Value;
use super::{PickleError, PickleLimits};

/// A pickle as data: a table of values and the bytes that they refer to.
#[derive(Debug)]
pub struct Pickle {
    pub(super) bytes: Bytes,
    pub(super) nodes: Vec<Node>,
    root: Id,
    end: usize,
}

impl Pickle {
    /// Reads the pickle at the start of `bytes`.
    ///
    /// # Errors
    /// [`PickleError::Refused`] for anything but plain data, [`PickleError::Limit`], and
    /// [`PickleError::Truncated`], [`PickleError::Malformed`] or [`PickleError::Call`] for files
    /// that are broken.
    pub fn read(bytes: Vec<u8>, limits: &PickleLimits) -> Result<Self, PickleError> {
        Self::read_at(bytes, 0, limits)
    }

    /// Reads the pickle that starts at `start`; what lies before it is skipped.
    ///
    /// # Errors
    /// As [`Pickle::read`].
    pub fn read_at(
        bytes: Vec<u8>,
        start: usize,
        limits: &PickleLimits,
    ) -> Result<Self, PickleError> {
        let end = bytes.len();
        let machine = Machine::new(Bytes::new(bytes), Vec::new(), *limits);
        machine.run(start.min(end), end).map(Self::from)
    }

    /// Reads a pickle of protocol 5 whose large buffers were written elsewhere, in the order in
    /// which Python's `buffer_callback` got them.
    ///
    /// # Errors
    /// As [`Pickle::read`]; [`PickleError::Malformed`] when it asks for more buffers.
    pub fn read_with_buffers(
        mut bytes: Vec<u8>,
        buffers: &[&[u8]],
        limits: &PickleLimits,
    ) -> Result<Self, PickleError> {
        let end = bytes.len();
        let runs = buffers.iter().map(|buffer| {
            let start = bytes.len();
            bytes.extend_from_slice(buffer);
            Blob {
                start,
                length: buffer.len(),
            }
        });
        let runs = runs.collect();
        let machine = Machine::new(Bytes::new(bytes), runs, *limits);
        machine.run(0, end).map(Self::from)
    }

    /// The pickled value.
    pub const fn root(&self) -> Value<'_> {
        Value::new(self, self.root)
    }

    /// Position of the first byte behind the pickle.
    pub const fn end(&self) -> usize {
        self.end
    }

    /// All storages that tensors of the pickle refer to.
    pub fn storages(&self) -> impl Iterator<Item = &Storage> {
        self.nodes.iter().filter_map(|node| match node {
            Node::Storage(storage) => Some(&**storage),
            _ => None,
        })
    }

    /// Gives the bytes back, to read what follows.
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes.into_file()
    }

    /// Whether bytes start as a pickle does. Protocol 0 has no mark: its first instruction and
    /// a full stop at the end must do.
    pub fn looks_like(bytes: &[u8]) -> bool {
        matches!(
            bytes,
            [0x80, 0..=5, ..] | [b'(' | b'c' | b']' | b'}' | b')', .., b'.']
        )
    }
}

impl From<Finished> for Pickle {
    fn from(finished: Finished) -> Self {
        Self {
            bytes: finished.bytes,
            nodes: finished.nodes,
            root: finished.root,
            end: finished.end,
        }
    }
}
