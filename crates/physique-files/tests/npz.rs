//! NumPy's arrays: what NumPy wrote is read back, and what a stranger wrote cannot hurt.

#![allow(clippy::unwrap_used)]

use std::io::{Cursor, Write};

use physique_files::npz::{Archive, ArchiveWriter, Array, ArrayError, ArrayLimits};
use proptest::prelude::*;
use zip::write::SimpleFileOptions;

const ARRAYS: &[u8] = include_bytes!("fixtures/arrays.npz");

fn open(bytes: &[u8]) -> Archive {
    Archive::open(bytes.to_vec(), ArrayLimits::default()).unwrap()
}

fn npy(header: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend(data);
    bytes
}

fn read(bytes: Vec<u8>) -> Result<Array, ArrayError> {
    Array::from_npy("a", bytes, &ArrayLimits::default())
}

fn zipped(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

#[test]
fn every_numeric_type_and_order_reads_as_numpy_wrote_it() {
    let mut archive = open(ARRAYS);
    let eighths: Vec<f64> = (0..24).map(|n| f64::from(n) / 8.0).collect();
    for key in ["float16", "float32", "float64_big", "float32_fortran"] {
        let array = archive.array(key).unwrap();
        assert_eq!(array.shape(), [2, 3, 4], "{key}");
        assert_eq!(array.to_f64().unwrap(), eighths, "{key}");
        let as_f32: Vec<f64> = array.to_f32().unwrap().into_iter().map(f64::from).collect();
        assert_eq!(as_f32, eighths, "{key}");
        assert!(array.to_i64().is_err(), "{key}");
    }
    for (first, keys) in [
        (-12, ["int8", "int16_big", "int32", "int64_big_fortran"]),
        (0, ["uint8", "uint16", "uint32_big", "uint64"]),
    ] {
        let expected: Vec<i64> = (first..first + 24).collect();
        for key in keys {
            let array = archive.array(key).unwrap();
            assert_eq!(array.to_i64().unwrap(), expected, "{key}");
            let as_f64: Vec<f64> = expected.iter().map(|&n| n as f64).collect();
            assert_eq!(array.to_f64().unwrap(), as_f64, "{key}");
        }
    }
    let boolean = archive.array("boolean").unwrap().to_i64().unwrap();
    assert_eq!(boolean, [1, 0].repeat(12));
    assert_eq!(archive.array("scalar").unwrap().number().unwrap(), 0.1);
    assert_eq!(archive.array("empty").unwrap().shape(), [0, 7]);
    let large = archive.array("uint64_large").unwrap();
    assert_eq!(large.to_f64().unwrap(), [9_223_372_036_854_775_808.0]);
    assert!(large.to_i64().is_err());
}

#[test]
fn texts() {
    let mut archive = open(ARRAYS);
    for (key, expected) in [
        ("text", "Grüße"),
        ("text_big", "Grüße"),
        ("text_empty", ""),
        ("letters", "male"),
    ] {
        assert_eq!(
            archive.array(key).unwrap().text().unwrap(),
            expected,
            "{key}"
        );
    }
    assert!(archive.array("text").unwrap().to_f64().is_err());
    assert!(archive.array("float32").unwrap().text().is_err());
}

#[test]
fn objects_are_refused_by_name_and_their_neighbours_stay_readable() {
    let mut archive = open(ARRAYS);
    let error = archive.array("objects").unwrap_err();
    assert!(matches!(error, ArrayError::ElementType { .. }));
    assert!(error.to_string().contains("`objects`") && error.to_string().contains("`|O`"));
    for key in ["complex", "record"] {
        let error = archive.array(key).unwrap_err();
        assert!(matches!(error, ArrayError::ElementType { .. }), "{error}");
    }
    assert!(archive.array("float32").is_ok());
}

#[test]
fn a_missing_array_is_named_with_those_that_are_there() {
    let error = open(ARRAYS).array("poses").unwrap_err().to_string();
    assert!(
        error.contains("`poses`") && error.contains("`float16`"),
        "{error}"
    );
}

#[test]
fn python_2_headers_and_odd_spacing() {
    let header = "{ 'shape' :( 1L ,2L),\"descr\":'<i2', 'fortran_order':False }\n";
    let array = read(npy(header, &[1, 0, 2, 0])).unwrap();
    assert_eq!(array.shape(), [1, 2]);
    assert_eq!(array.to_i64().unwrap(), [1, 2]);
}

#[test]
fn hostile_headers() {
    let header =
        |shape: &str| format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}}}");
    let huge = usize::MAX;
    for shape in [
        format!("({huge}, 2)"),
        format!("({}, )", huge / 2),
        format!("(0, {huge}, {huge})"),
        "(4294967296, 4294967296, 0)".into(),
    ] {
        let error = read(npy(&header(&shape), &[])).unwrap_err();
        assert!(!error.to_string().is_empty(), "{shape}: {error}");
    }
    for shape in [
        "(-1,)",
        "(1e9,)",
        "(99999999999999999999999,)",
        "1",
        "(1",
        "((((1",
        "(1 2)",
    ] {
        let error = read(npy(&header(shape), &[0; 4])).unwrap_err();
        assert!(
            matches!(error, ArrayError::Header { .. }),
            "{shape}: {error}"
        );
    }
    let many = format!("({})", "1,".repeat(65));
    assert!(matches!(
        read(npy(&header(&many), &[0; 4])),
        Err(ArrayError::Header { .. })
    ));
    for broken in [
        "",
        "{",
        "{}",
        "[]",
        "{'descr': '<f4'}",
        "{'descr': '<f4', 'evil': 1}",
        "{'descr: '<f4'}",
        "{'descr': '<f4', 'fortran_order': None, 'shape': ()}",
    ] {
        let error = read(npy(broken, &[])).unwrap_err();
        assert!(
            matches!(error, ArrayError::Header { .. }),
            "{broken}: {error}"
        );
    }
    // A text of no bytes an element, a thousand million times.
    let nothing = "{'descr': '<U0', 'fortran_order': False, 'shape': (9999999999,)}";
    assert!(matches!(
        read(npy(nothing, &[])),
        Err(ArrayError::Bytes { .. })
    ));
    // Version 2 with a header of 4 GiB.
    let long = b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec();
    assert!(matches!(read(long), Err(ArrayError::Header { .. })));
    let future = b"\x93NUMPY\x09\x00\x10\x00".to_vec();
    assert!(read(future).unwrap_err().to_string().contains("found 9"));
}

#[test]
fn more_or_less_data_than_promised() {
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2,)}";
    assert!(read(npy(header, &[0; 8])).is_ok());
    for length in [0, 7, 9] {
        let error = read(npy(header, &vec![0; length])).unwrap_err();
        assert!(
            matches!(error, ArrayError::DataLength { expected: 8, .. }),
            "{error}"
        );
    }
}

#[test]
fn a_zip_bomb_stops_at_the_limit() {
    let header = "{'descr': '|u1', 'fortran_order': False, 'shape': (50000000,)}";
    let bomb = zipped(&[("a.npy", &npy(header, &vec![0; 50_000_000]))]);
    assert!(bomb.len() < 100_000);
    let limits = ArrayLimits {
        bytes: 1_000_000,
        ..ArrayLimits::default()
    };
    let error = Archive::open(bomb.clone(), limits)
        .unwrap()
        .array("a")
        .unwrap_err();
    assert!(
        matches!(
            error,
            ArrayError::Bytes {
                limit: 1_000_000,
                ..
            }
        ),
        "{error}"
    );

    // The same with a directory that lies about the size.
    let mut liar = bomb;
    let directory = liar
        .windows(4)
        .rposition(|bytes| bytes == b"PK\x01\x02")
        .unwrap();
    liar[directory + 24..directory + 28].copy_from_slice(&1000_u32.to_le_bytes());
    if let Ok(mut archive) = Archive::open(liar, limits) {
        let error = archive.array("a").unwrap_err();
        assert!(
            matches!(
                error,
                ArrayError::Bytes { .. }
                    | ArrayError::Unpack { .. }
                    | ArrayError::DataLength { .. }
            ),
            "{error}"
        );
    }
}

#[test]
fn the_limit_holds_over_all_arrays_together() {
    let header = "{'descr': '|u1', 'fortran_order': False, 'shape': (600,)}";
    let one = npy(header, &[0; 600]);
    let limits = ArrayLimits {
        bytes: 1000,
        ..ArrayLimits::default()
    };
    let mut archive = Archive::open(zipped(&[("a.npy", &one), ("b.npy", &one)]), limits).unwrap();
    assert!(archive.array("a").is_ok());
    assert!(matches!(archive.array("b"), Err(ArrayError::Bytes { .. })));
}

#[test]
fn too_many_entries() {
    let names: Vec<String> = (0..20).map(|index| format!("{index}.npy")).collect();
    let entries: Vec<(&str, &[u8])> = names
        .iter()
        .map(|name| (name.as_str(), [].as_slice()))
        .collect();
    let limits = ArrayLimits {
        entries: 19,
        ..ArrayLimits::default()
    };
    let error = Archive::open(zipped(&entries), limits).unwrap_err();
    assert!(matches!(
        error,
        ArrayError::Entries {
            found: 20,
            limit: 19
        }
    ));
}

#[test]
fn every_truncation_is_an_error_and_never_a_panic() {
    for length in (0..ARRAYS.len()).step_by(3) {
        if let Ok(mut archive) = Archive::open(ARRAYS[..length].to_vec(), ArrayLimits::default()) {
            for key in archive.keys().to_vec() {
                assert!(archive.array(&key).is_err(), "cut at {length}, {key}");
            }
        }
    }
}

proptest! {
    #[test]
    fn flipped_bytes_never_panic(position in 0..ARRAYS.len(), byte: u8) {
        let mut bytes = ARRAYS.to_vec();
        bytes[position] = byte;
        if let Ok(mut archive) = Archive::open(bytes, ArrayLimits::default()) {
            for key in archive.keys().to_vec() {
                if let Ok(array) = archive.array(&key) {
                    let _ = (array.to_f64(), array.to_f32(), array.to_i64(), array.text());
                }
            }
        }
    }

    #[test]
    fn any_header_is_read_or_refused(text in "[{}()\\[\\]',:<>a-z0-9 ]{0,80}") {
        let _ = read(npy(&text, &[0; 8]));
    }

    #[test]
    fn what_is_written_is_read(values in prop::collection::vec(any::<f64>(), 0..50), text in "[^\0]{0,20}") {
        let mut writer = ArchiveWriter::new();
        writer.f64("a", &[values.len(), 1], &values).unwrap();
        writer.text("b", &text).unwrap();
        let mut archive = open(&writer.finish().unwrap());
        let read = archive.array("a").unwrap();
        prop_assert_eq!(read.shape(), &[values.len(), 1]);
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&read.to_f64().unwrap()), bits(&values));
        prop_assert_eq!(archive.array("b").unwrap().text().unwrap(), text);
    }
}

#[test]
fn equal_arrays_make_equal_archives_and_wrong_shapes_are_refused() {
    let write = || {
        let mut writer = ArchiveWriter::new();
        writer.f32("a", &[1, 2], &[1.0, 2.0]).unwrap();
        writer.integer("version", 1).unwrap();
        writer.finish().unwrap()
    };
    assert_eq!(write(), write());
    let error = ArchiveWriter::new()
        .f32("a", &[3], &[1.0, 2.0])
        .unwrap_err();
    assert!(matches!(error, ArrayError::Write { .. }));
}
