//! Opening a file without reading its rows.

use std::fs::File;
use std::path::Path;

use memmap2::Mmap;

use super::check;
use super::head::{Checksum, Head, LENGTH};
use crate::{DataLimits, Error, Index};

/// The rows of a file.
#[derive(Debug)]
pub(crate) struct Rows {
    numbers: Numbers,
    columns: usize,
    checksum: u64,
}

#[derive(Debug)]
enum Numbers {
    /// The file in memory, and how many of its bytes behind the head are rows.
    Mapped(Mmap, usize),
    Owned(Vec<f32>),
}

/// Maps a file and reads its index.
pub(crate) fn open(path: &Path, limits: &DataLimits) -> Result<(Index, Rows), Error> {
    let io = |problem| Error::io(path, problem);
    let file = File::open(path).map_err(io)?;
    // SAFETY: the map is only ever read. Whoever shortens or writes the file while it is open breaks
    // what `Dataset::open` asks for; writers of this crate put new files in the place of old ones and
    // never write into them.
    let map = unsafe { Mmap::map(&file) }.map_err(io)?;
    let (index, head) = parse(&map, path, limits)?;
    let length = row_bytes(&head);
    let numbers = if cfg!(target_endian = "little") {
        Numbers::Mapped(map, length)
    } else {
        Numbers::Owned(copied(&map[LENGTH..LENGTH + length]))
    };
    Ok((index, Rows::new(numbers, &head)))
}

/// Takes the bytes of a file that is in memory already; the rows are copied.
pub(crate) fn from_bytes(
    bytes: &[u8],
    path: &Path,
    limits: &DataLimits,
) -> Result<(Index, Rows), Error> {
    let (index, head) = parse(bytes, path, limits)?;
    let numbers = copied(&bytes[LENGTH..LENGTH + row_bytes(&head)]);
    Ok((index, Rows::new(Numbers::Owned(numbers), &head)))
}

/// The head was held against the length of the file, which is in memory.
fn row_bytes(head: &Head) -> usize {
    head.row_bytes().unwrap_or(0) as usize
}

fn copied(bytes: &[u8]) -> Vec<f32> {
    let numbers = bytes.as_chunks::<4>().0.iter();
    numbers.map(|&bytes| f32::from_le_bytes(bytes)).collect()
}

fn parse(bytes: &[u8], path: &Path, limits: &DataLimits) -> Result<(Index, Head), Error> {
    let head = Head::parse(bytes, path, limits)?;
    let fail = |place: String, expected: &str, found: String| Error::Format {
        path: path.into(),
        place,
        expected: expected.into(),
        found,
    };
    let text = &bytes[LENGTH + row_bytes(&head)..];
    let found = Checksum::of_bytes(text).0;
    if found != head.index_checksum {
        let expected = format!("checksum {:016x}", head.index_checksum);
        return Err(fail("index".into(), &expected, format!("{found:016x}")));
    }
    let index: Index = serde_json::from_slice(text).map_err(|problem| {
        let place = format!("index, column {}", problem.column());
        fail(place, "the index of a data file", problem.to_string())
    })?;
    check::index(&index, head.rows, head.columns)
        .map_err(|(place, expected, found)| fail(place, &expected, found))?;
    Ok((index, head))
}

impl Rows {
    fn new(numbers: Numbers, head: &Head) -> Self {
        Self {
            numbers,
            columns: head.columns as usize,
            checksum: head.rows_checksum,
        }
    }

    /// All numbers.
    pub(crate) fn all(&self) -> &[f32] {
        match &self.numbers {
            // Maps begin at a page, and the head is a multiple of 4 bytes long.
            Numbers::Mapped(map, length) => bytemuck::cast_slice(&map[LENGTH..LENGTH + length]),
            Numbers::Owned(numbers) => numbers,
        }
    }

    /// Some rows, which the caller knows to be there.
    pub(crate) fn range(&self, first: usize, count: usize) -> &[f32] {
        &self.all()[first * self.columns..(first + count) * self.columns]
    }

    /// Whether the rows are what was written: `(expected, found)` where not.
    pub(crate) fn verify(&self) -> Result<(), (u64, u64)> {
        let mut checksum = Checksum::default();
        checksum.add_rows(self.all());
        match checksum.0 == self.checksum {
            true => Ok(()),
            false => Err((self.checksum, checksum.0)),
        }
    }
}
