//! A place in the file, and the operands that stand there.

use super::PickleError;
use super::blob::Blob;

/// Reads operands; every length is checked against what is left of the file.
#[derive(Debug)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    position: usize,
}

impl<'a> Cursor<'a> {
    pub(super) const fn new(bytes: &'a [u8], position: usize) -> Self {
        Self { bytes, position }
    }

    pub(super) const fn position(&self) -> usize {
        self.position
    }

    /// The bytes of a run that this cursor gave.
    pub(super) fn text(&self, blob: Blob) -> &'a [u8] {
        &self.bytes[blob.start..blob.start + blob.length]
    }

    pub(super) fn u8(&mut self, expected: &'static str) -> Result<u8, PickleError> {
        self.array::<1>(expected).map(|[byte]| byte)
    }

    pub(super) fn array<const SIZE: usize>(
        &mut self,
        expected: &'static str,
    ) -> Result<[u8; SIZE], PickleError> {
        let rest = self.bytes.get(self.position..).unwrap_or_default();
        let Some(array) = rest.first_chunk() else {
            return Err(self.truncated(expected));
        };
        self.position += SIZE;
        Ok(*array)
    }

    pub(super) fn take(
        &mut self,
        length: usize,
        expected: &'static str,
    ) -> Result<Blob, PickleError> {
        self.require(length, expected)?;
        let start = self.position;
        self.position += length;
        Ok(Blob { start, length })
    }

    /// Fails unless so many bytes are left.
    pub(super) fn require(&self, length: usize, expected: &'static str) -> Result<(), PickleError> {
        if length > self.bytes.len() - self.position {
            return Err(self.truncated(expected));
        }
        Ok(())
    }

    /// Up to the end of the line, which is passed but not part of it.
    pub(super) fn line(&mut self) -> Result<Blob, PickleError> {
        let start = self.position;
        let rest = &self.bytes[start..];
        let Some(length) = rest.iter().position(|&byte| byte == b'\n') else {
            return Err(self.truncated("the end of a line"));
        };
        self.position += length + 1;
        // Files that went through Windows in text mode.
        let length = length - usize::from(rest[..length].ends_with(b"\r"));
        Ok(Blob { start, length })
    }

    /// A length of four bytes with a sign, as Python 2 wrote them; negative ones are refused.
    pub(super) fn length_i32(&mut self) -> Result<usize, PickleError> {
        let byte = self.position;
        let length = i32::from_le_bytes(self.array("a length")?);
        usize::try_from(length).map_err(|_| PickleError::Malformed {
            byte,
            expected: "a length",
            found: length.to_string(),
        })
    }

    pub(super) fn length_u32(&mut self) -> Result<usize, PickleError> {
        Ok(u32::from_le_bytes(self.array("a length")?) as usize)
    }

    pub(super) fn length_u64(&mut self) -> Result<usize, PickleError> {
        let length = u64::from_le_bytes(self.array("a length")?);
        // A length that does not fit this machine is longer than any file here.
        Ok(usize::try_from(length).unwrap_or(usize::MAX))
    }

    const fn truncated(&self, expected: &'static str) -> PickleError {
        PickleError::Truncated {
            byte: self.position,
            expected,
        }
    }
}
