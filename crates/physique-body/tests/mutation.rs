//! An in-process mutational fuzzer for body files. A short run belongs to the tests; a long one:
//! `PHYSIQUE_FUZZ_SECONDS=600 cargo test -p physique-body --test mutation -- --nocapture`

#![allow(clippy::unwrap_used)]

use std::sync::Arc;
use std::{fs, panic};

use physique_body::{Body, BodyOptions, parse_body};

#[path = "../../../attacks/support/mutation.rs"]
mod mutation;

use mutation::fuzz;

fn corpus() -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir("tests/fixtures").unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let bodies = paths.filter(|path| {
        let end = path.extension().unwrap_or_default();
        end == "npz" || end == "pkl"
    });
    let mut files: Vec<(String, Vec<u8>)> = bodies
        .map(|path| (path.display().to_string(), fs::read(path).unwrap()))
        .collect();
    files.sort();
    files
}

/// Whatever is read can be shaped and posed.
fn read(name: &str, bytes: Vec<u8>) -> bool {
    let options = BodyOptions {
        bytes: 1 << 24,
        ..BodyOptions::default()
    };
    let Ok(model) = parse_body(name, bytes, &options) else {
        return false;
    };
    if let Ok(body) = Body::new(Arc::new(model), &[1.0, -1.0]) {
        let _ = body.posed().vertices().len();
    }
    true
}

#[test]
fn no_mutation_panics() {
    let words: [&[u8]; 12] = [
        b"v_template",
        b"J_regressor",
        b"kintree_table",
        b"weights",
        b"posedirs",
        b"shapedirs",
        b"'<f8'",
        b"'<i8'",
        b"(4294967296, 3)",
        b"True",
        b"\x80\x02",
        b"\0\0\xc0\x7f",
    ];
    fuzz("bodies", &corpus(), &words, read);
}

#[test]
fn no_truncation_panics() {
    for (name, bytes) in corpus() {
        let step = (bytes.len() / 300).max(1);
        for length in (0..bytes.len()).step_by(step) {
            let result = panic::catch_unwind(|| read(&name, bytes[..length].to_vec()));
            assert!(result.is_ok(), "{name} cut to {length} bytes panics");
        }
    }
}
