//! Writing rows as they come, then the index.

use std::fs::{self, File};
use std::io::{BufWriter, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use super::head::{Checksum, Head, LENGTH};
use crate::{Error, Index};

/// A data file in the making, beside its place. Dropped unfinished, it leaves nothing.
#[derive(Debug)]
pub(crate) struct Writer {
    path: PathBuf,
    beside: PathBuf,
    file: Option<BufWriter<File>>,
    columns: usize,
    numbers: u64,
    checksum: Checksum,
}

impl Writer {
    pub(crate) fn create(path: &Path, columns: usize) -> Result<Self, Error> {
        let mut beside = path.as_os_str().to_owned();
        beside.push(format!(".{}.partial", std::process::id()));
        let beside = PathBuf::from(beside);
        let file = File::create(&beside).map_err(|problem| Error::io(&beside, problem))?;
        let mut writer = Self {
            path: path.into(),
            beside,
            file: Some(BufWriter::with_capacity(1 << 20, file)),
            columns,
            numbers: 0,
            checksum: Checksum::default(),
        };
        writer.bytes(&[0; LENGTH])?;
        Ok(writer)
    }

    /// Rows written so far.
    pub(crate) fn rows(&self) -> u64 {
        self.numbers / self.columns as u64
    }

    /// Appends whole rows.
    pub(crate) fn append(&mut self, rows: &[f32]) -> Result<(), Error> {
        debug_assert!(rows.len().is_multiple_of(self.columns), "whole rows");
        self.checksum.add_rows(rows);
        self.numbers += rows.len() as u64;
        if cfg!(target_endian = "little") {
            return self.bytes(bytemuck::cast_slice(rows));
        }
        let bytes: Vec<u8> = rows
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        self.bytes(&bytes)
    }

    /// Writes index and head, and puts the file in its place.
    pub(crate) fn finish(mut self, index: &Index) -> Result<(), Error> {
        let text = serde_json::to_vec(index).map_err(|problem| Error::Format {
            path: self.path.clone(),
            place: "index".into(),
            expected: "names and numbers that JSON can hold".into(),
            found: problem.to_string(),
        })?;
        self.bytes(&text)?;
        let head = Head {
            columns: self.columns as u32,
            rows: self.rows(),
            index_bytes: text.len() as u64,
            index_checksum: Checksum::of_bytes(&text).0,
            rows_checksum: self.checksum.0,
        };
        let place = |problem| Error::io(&self.beside, problem);
        if let Some(writer) = self.file.take() {
            let mut file = writer
                .into_inner()
                .map_err(|error| place(error.into_error()))?;
            file.seek(SeekFrom::Start(0)).map_err(place)?;
            file.write_all(&head.to_bytes()).map_err(place)?;
            file.sync_all().map_err(place)?;
        }
        fs::rename(&self.beside, &self.path).map_err(|problem| Error::io(&self.path, problem))
    }

    fn bytes(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let written = self
            .file
            .as_mut()
            .map_or(Ok(()), |file| file.write_all(bytes));
        written.map_err(|problem| Error::io(&self.beside, problem))
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        // After `finish` there is nothing of this name; before it, half a file helps nobody.
        let _ = fs::remove_file(&self.beside);
    }
}
