//! Files that are broken by accident or on purpose are refused; none crashes the reader.

#![allow(clippy::unwrap_used)]

mod support;

#[path = "../../../attacks/support/mutation.rs"]
mod mutation;

use std::fs;
use std::sync::OnceLock;

use mutation::fuzz;
use physique_data::{DataLimits, Dataset, Error};
use support::{RECIPE, built, folder};

/// A small data file.
fn seed() -> &'static [u8] {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    BYTES.get_or_init(|| {
        let folder = folder();
        let recipe = RECIPE.replace("mirror = true", "mirror = false");
        let (_, output) = built(&recipe, folder.path());
        fs::read(output).unwrap()
    })
}

fn open(bytes: &[u8]) -> Result<Dataset, Error> {
    Dataset::from_bytes(bytes, "test.pmd", &DataLimits::default())
}

fn problem(bytes: &[u8]) -> String {
    open(bytes).map_or_else(|problem| problem.to_string(), |_| "accepted".into())
}

/// The file with another index, and with the head that belongs to it.
fn with_index(change: impl Fn(&str) -> String) -> Vec<u8> {
    let bytes = seed();
    let length = u64::from_le_bytes(bytes[24..32].try_into().unwrap()) as usize;
    let (rows, index) = bytes.split_at(bytes.len() - length);
    let text = std::str::from_utf8(index).unwrap();
    let changed = change(text);
    assert_ne!(changed, text, "the change changes nothing");
    let mut bytes = rows.to_vec();
    bytes.extend(changed.bytes());
    mended(bytes, changed.len())
}

/// The length and checksum of the index made right, so that what lies behind them is reached.
fn mended(mut bytes: Vec<u8>, index: usize) -> Vec<u8> {
    let checksum = bytes[bytes.len() - index..]
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |sum, &byte| {
            (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
    bytes[24..32].copy_from_slice(&(index as u64).to_le_bytes());
    bytes[32..40].copy_from_slice(&checksum.to_le_bytes());
    bytes
}

#[test]
fn every_truncation_is_refused() {
    let bytes = seed();
    open(bytes).unwrap();
    for length in (0..bytes.len()).step_by(101).chain(0..200) {
        assert!(open(&bytes[..length]).is_err(), "{length} bytes");
    }
    let mut longer = bytes.to_vec();
    longer.push(b' ');
    assert!(problem(&longer).contains("length of the file"));
}

#[test]
fn heads_that_lie_are_told() {
    let changed = |at: usize, with: &[u8]| {
        let mut bytes = seed().to_vec();
        bytes[at..at + with.len()].copy_from_slice(with);
        problem(&bytes)
    };
    assert!(changed(0, b"PHYSDATE").contains("byte 0: expected a data file"));
    assert!(changed(8, &2_u32.to_le_bytes()).contains("expected version 1, found 2"));
    assert!(changed(12, &0_u32.to_le_bytes()).contains("length of the file"));
    assert!(changed(16, &u64::MAX.to_le_bytes()).contains("a length that a file can have"));
    assert!(changed(24, &(1_u64 << 40).to_le_bytes()).contains("above the limit"));
    assert!(changed(24, &0_u64.to_le_bytes()).contains("length of the file"));
    assert!(changed(32, &[0; 8]).contains("index: expected checksum"));
    assert!(changed(50, b"x").contains("16 zeros"));
}

#[test]
fn indices_that_lie_are_told() {
    let told = |from: &str, to: &str| problem(&with_index(|text| text.replacen(from, to, 1)));
    for (from, to, expected) in [
        ("\"name\"", "\"nam\"", "unknown field `nam`"),
        (
            "\"storage\":\"positions\"",
            "\"storage\":\"features\"",
            "head: expected 263 numbers",
        ),
        (
            "\"first_row\":0",
            "\"first_row\":1",
            "recording 0: expected rows from 0 on",
        ),
        (
            "\"recording\":0",
            "\"recording\":99",
            "clip 0: expected rows within the 0",
        ),
        (
            "\"recording\":1",
            "\"recording\":0",
            "clip 1: expected rows within the 52 of recording 0",
        ),
        (
            "\"start\":0",
            "\"start\":18446744073709551615",
            "clip 0: expected rows within",
        ),
        (
            "\"frame_rate\":20.0",
            "\"frame_rate\":0.0",
            "frame_rate: expected a number above 0",
        ),
        (
            "\"shortest_window\":20",
            "\"shortest_window\":0",
            "windows: expected 1 <= shortest",
        ),
        (
            "\"training\":[0",
            "\"training\":[999",
            "caption set 0: expected captions below",
        ),
        ("\"weights\":[", "\"weights\":[1.0,", "weights above 0"),
        (
            "\"deviation\":[",
            "\"deviation\":[0.0,",
            "statistics: expected mean and deviation",
        ),
    ] {
        let found = told(from, to);
        assert!(found.contains(expected), "{from} to {to}: {found}");
    }
}

#[test]
fn rows_that_were_damaged_are_found() {
    let mut bytes = seed().to_vec();
    bytes[100] ^= 1;
    let dataset = open(&bytes).unwrap();
    let problem = dataset.verify().unwrap_err().to_string();
    assert!(problem.contains("rows: expected checksum"), "{problem}");

    // NaN does not reach a network.
    let mut bytes = seed().to_vec();
    bytes[64..68].copy_from_slice(&f32::NAN.to_le_bytes());
    let dataset = open(&bytes).unwrap();
    let window = dataset.whole(0).unwrap();
    assert!(matches!(dataset.features(window), Err(Error::Motion(_))));
}

#[test]
fn fuzz_data_files() {
    let index = u64::from_le_bytes(seed()[24..32].try_into().unwrap()) as usize;
    let start = seed().len() - index;
    // Mostly the index, behind a right checksum; the head and rows by themselves now and then.
    let seeds = vec![
        ("index".to_owned(), seed()[start..].to_vec()),
        ("file".to_owned(), seed().to_vec()),
    ];
    let words: [&[u8]; 6] = [
        b"0",
        b"18446744073709551615",
        b"-1",
        b"[]",
        b"null",
        b"1e999",
    ];
    fuzz("data files", &seeds, &words, |name, bytes| {
        let whole = if name == "file" {
            bytes
        } else {
            let mut whole = seed()[..start].to_vec();
            whole.extend(&bytes);
            mended(whole, bytes.len())
        };
        let Ok(dataset) = open(&whole) else {
            return false;
        };
        for clip in 0..dataset.index().clips.len().min(4) {
            let _ = dataset.features(dataset.whole(clip).unwrap());
        }
        true
    });
}
