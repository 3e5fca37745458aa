//! Writing arrays as `numpy.savez` does: stored without compression.
//!
//! Rotations hardly compress (about a tenth), and stored bytes are the same with every version of
//! every compression library, so that equal motions are equal files.

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::ArrayError;

/// Collects arrays and makes the bytes of an `.npz` of them.
#[derive(Debug)]
pub struct ArchiveWriter {
    zip: ZipWriter<Cursor<Vec<u8>>>,
}

impl Default for ArchiveWriter {
    fn default() -> Self {
        Self::new()
    }
}

impl ArchiveWriter {
    /// An empty archive.
    pub fn new() -> Self {
        Self {
            zip: ZipWriter::new(Cursor::new(Vec::new())),
        }
    }

    /// Adds an array of 64-bit numbers.
    ///
    /// # Errors
    /// [`ArrayError::Write`] when the shape does not hold the values or the name is taken.
    pub fn f64(&mut self, key: &str, shape: &[usize], values: &[f64]) -> Result<(), ArrayError> {
        let data = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        self.add(key, "<f8", shape, values.len(), data)
    }

    /// Adds an array of 32-bit numbers.
    ///
    /// # Errors
    /// As [`ArchiveWriter::f64`].
    pub fn f32(&mut self, key: &str, shape: &[usize], values: &[f32]) -> Result<(), ArrayError> {
        let data = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        self.add(key, "<f4", shape, values.len(), data)
    }

    /// Adds one integer.
    ///
    /// # Errors
    /// As [`ArchiveWriter::f64`].
    pub fn integer(&mut self, key: &str, value: i64) -> Result<(), ArrayError> {
        self.add(key, "<i8", &[], 1, value.to_le_bytes().into())
    }

    /// Adds one text; zeros at its end are lost, as NumPy loses them.
    ///
    /// # Errors
    /// As [`ArchiveWriter::f64`].
    pub fn text(&mut self, key: &str, text: &str) -> Result<(), ArrayError> {
        let mut data: Vec<u8> = text
            .chars()
            .flat_map(|letter| u32::from(letter).to_le_bytes())
            .collect();
        // NumPy's text has at least one character.
        data.resize(data.len().max(4), 0);
        let descr = format!("<U{}", data.len() / 4);
        self.add(key, &descr, &[], 1, data)
    }

    /// The bytes of the archive.
    ///
    /// # Errors
    /// [`ArrayError::Write`] when the archive outgrows the ZIP format.
    pub fn finish(self) -> Result<Vec<u8>, ArrayError> {
        let archive = self.zip.finish().map_err(|error| ArrayError::Write {
            key: "the end of the archive".into(),
            reason: error.to_string(),
        })?;
        Ok(archive.into_inner())
    }

    fn add(
        &mut self,
        key: &str,
        descr: &str,
        shape: &[usize],
        count: usize,
        data: Vec<u8>,
    ) -> Result<(), ArrayError> {
        let refused = |reason: String| ArrayError::Write {
            key: key.into(),
            reason,
        };
        if shape.iter().product::<usize>() != count {
            return Err(refused(format!(
                "shape {shape:?} does not hold {count} values"
            )));
        }
        // A fixed date: equal arrays make equal archives.
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .last_modified_time(DateTime::default())
            .large_file(data.len() as u64 > u64::from(u32::MAX) - 65_536);
        self.zip
            .start_file(format!("{key}.npy"), options)
            .map_err(|error| refused(error.to_string()))?;
        self.zip
            .write_all(&header(descr, shape))
            .and_then(|()| self.zip.write_all(&data))
            .map_err(|error| refused(error.to_string()))
    }
}

/// The bytes of a single `.npy` of 32-bit numbers in C order.
///
/// # Errors
/// [`ArrayError::Write`] when the shape does not hold the values.
pub fn npy_f32(shape: &[usize], values: &[f32]) -> Result<Vec<u8>, ArrayError> {
    if shape.iter().product::<usize>() != values.len() {
        return Err(ArrayError::Write {
            key: "the array".into(),
            reason: format!("shape {shape:?} does not hold {} values", values.len()),
        });
    }
    let mut bytes = header("<f4", shape);
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    Ok(bytes)
}

/// A version 1 header, padded so that the data starts at a multiple of 64 bytes.
fn header(descr: &str, shape: &[usize]) -> Vec<u8> {
    let lengths: String = shape.iter().map(|length| format!("{length},")).collect();
    let mut text =
        format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({lengths}), }}");
    let unpadded = 10 + text.len() + 1;
    text.extend(std::iter::repeat_n(
        ' ',
        unpadded.next_multiple_of(64) - unpadded,
    ));
    text.push('\n');
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    // At most 64 dimensions of 20 digits: far below 65,536.
    header.extend((text.len() as u16).to_le_bytes());
    header.extend(text.bytes());
    header
}
