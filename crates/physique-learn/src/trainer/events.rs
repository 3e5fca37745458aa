//! TensorBoard's event files, written by hand: a few scalars need no protobuf library.
//!
//! A file is a row of records: length (8 bytes), its checksum, the bytes, their checksum; the
//! bytes are an `Event` of TensorFlow's `event.proto`.

use std::fs::{File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use physique_files::FileError;

use crate::Error;

/// Appends events to a file of its own.
#[derive(Debug)]
pub(super) struct EventWriter {
    folder: PathBuf,
    file: Option<(PathBuf, File)>,
}

impl EventWriter {
    /// Nothing is written before [`EventWriter::start`].
    pub(super) fn new(folder: &Path) -> Self {
        Self {
            folder: folder.into(),
            file: None,
        }
    }

    /// Starts a file; TensorBoard drops what older files say of later steps.
    pub(super) fn start(&mut self, step: u64) -> Result<(), Error> {
        let seconds = now();
        let name = format!("events.out.tfevents.{:010}.{step:09}", seconds as u64);
        let path = self.folder.join(name);
        let file = OpenOptions::new().create(true).append(true).open(&path);
        let file = file.map_err(|problem| FileError::Io {
            path: path.clone(),
            problem,
        })?;
        self.file = Some((path, file));
        let mut event = Message::default();
        event.double(1, seconds);
        event.text(3, "brain.Event:2");
        self.write(&event.bytes)?;
        let mut restart = Message::default();
        restart.integer(1, 1); // SessionLog.status = START
        let mut event = Message::default();
        event.double(1, seconds);
        event.integer(2, step + 1);
        event.message(7, &restart);
        self.write(&event.bytes)
    }

    /// Writes numbers of a step.
    pub(super) fn scalars<'a>(
        &mut self,
        step: u64,
        scalars: impl Iterator<Item = (&'a str, f64)>,
    ) -> Result<(), Error> {
        let mut summary = Message::default();
        for (name, value) in scalars {
            let mut scalar = Message::default();
            scalar.text(1, name);
            scalar.float(2, value as f32);
            summary.message(1, &scalar);
        }
        let mut event = Message::default();
        event.double(1, now());
        event.integer(2, step);
        event.message(5, &summary);
        self.write(&event.bytes)
    }

    fn write(&mut self, event: &[u8]) -> Result<(), Error> {
        let Some((path, file)) = &mut self.file else {
            return Ok(());
        };
        let written = file.write_all(&record(event));
        Ok(written.map_err(|problem| FileError::Io {
            path: path.clone(),
            problem,
        })?)
    }
}

fn now() -> f64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0.0, |since| since.as_secs_f64())
}

/// Bytes with their length and both checksums.
fn record(bytes: &[u8]) -> Vec<u8> {
    let length = (bytes.len() as u64).to_le_bytes();
    let mut record = length.to_vec();
    record.extend(masked(&length).to_le_bytes());
    record.extend(bytes);
    record.extend(masked(bytes).to_le_bytes());
    record
}

/// CRC-32C (Castagnoli), turned and shifted as TensorFlow does.
fn masked(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ if crc & 1 == 1 { 0x82F6_3B78 } else { 0 };
        }
    }
    (!crc).rotate_right(15).wrapping_add(0xA282_EAD8)
}

/// A protobuf message.
#[derive(Default)]
struct Message {
    bytes: Vec<u8>,
}

impl Message {
    fn varint(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.bytes.push(value as u8);
    }

    fn integer(&mut self, field: u64, value: u64) {
        self.varint(field << 3);
        self.varint(value);
    }

    fn double(&mut self, field: u64, value: f64) {
        self.varint(field << 3 | 1);
        self.bytes.extend(value.to_le_bytes());
    }

    fn float(&mut self, field: u64, value: f32) {
        self.varint(field << 3 | 5);
        self.bytes.extend(value.to_le_bytes());
    }

    fn text(&mut self, field: u64, value: &str) {
        self.block(field, value.as_bytes());
    }

    fn message(&mut self, field: u64, value: &Self) {
        self.block(field, &value.bytes);
    }

    fn block(&mut self, field: u64, bytes: &[u8]) {
        self.varint(field << 3 | 2);
        self.varint(bytes.len() as u64);
        self.bytes.extend(bytes);
    }
}

#[cfg(test)]
mod tests {
    use super::{Message, record};

    #[test]
    fn records_are_tensorflows() {
        // A version event (wall time 1.0), as TensorFlow's own writer framed it is checked by the
        // checksum of its length 24: crc32c([24, 0, ..]) masked.
        let mut event = Message::default();
        event.double(1, 1.0);
        event.text(3, "brain.Event:2");
        let record = record(&event.bytes);
        assert_eq!(event.bytes.len(), 24);
        assert_eq!(record.len(), 8 + 4 + 24 + 4);
        assert_eq!(&record[8..12], &[0xA3, 0x7F, 0x4B, 0x22]);
    }
}
