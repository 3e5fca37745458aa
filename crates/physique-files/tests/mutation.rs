//! An in-process mutational fuzzer: broken copies of every fixture and attack.
//!
//! A short run with a fixed seed belongs to the tests. For a long one:
//! `PHYSIQUE_FUZZ_SECONDS=600 cargo test -p physique-files --test mutation -- --nocapture`

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::{fs, panic};

use physique_files::named_arrays;
use physique_files::npz::ArrayLimits;
use physique_files::pickle::{Pickle, PickleLimits};

#[path = "../../../attacks/support/mutation.rs"]
mod mutation;

use mutation::fuzz;

const ARRAYS: ArrayLimits = ArrayLimits {
    bytes: 1 << 24,
    entries: 1024,
    dimensions: 64,
};
const PICKLES: PickleLimits = PickleLimits {
    bytes: 1 << 24,
    values: 1 << 18,
    memo: 1 << 18,
    depth: 256,
};

/// Opcodes that are worth more than chance.
const OPCODES: &[u8] =
    b"().0123FGIJKLMNPQRSTUVXBC]}abcdeghijlopqrstu\x80\x81\x82\x85\x86\x87\x88\x89\x8a\x8b\x8c\x8d\x8e\x8f\x90\x91\x92\x93\x94\x95\x96\x97\x98";

fn corpus() -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for folder in [
        "tests/fixtures",
        "../../attacks",
        "../physique-body/tests/fixtures",
    ] {
        for entry in fs::read_dir(Path::new(folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.display().to_string();
            if [".pkl", ".npz", ".npy", ".pt"]
                .iter()
                .any(|end| name.ends_with(end))
            {
                files.push((name, fs::read(path).unwrap()));
            }
        }
    }
    files.sort();
    files
}

fn read(bytes: Vec<u8>) -> bool {
    let by_content = named_arrays(bytes.clone(), &ARRAYS, &PICKLES).is_ok();
    // As a pickle even when it no longer looks like one.
    by_content | Pickle::read(bytes, &PICKLES).is_ok()
}

#[test]
fn no_mutation_panics() {
    let files = corpus();
    assert!(files.len() > 80);
    let words: Vec<&[u8]> = OPCODES.chunks(1).collect();
    fuzz("pickles, NumPy, PyTorch", &files, &words, |_, bytes| {
        read(bytes)
    });
}

#[test]
fn no_truncation_panics() {
    for (name, bytes) in corpus() {
        let step = (bytes.len() / 400).max(1);
        for length in (0..bytes.len()).step_by(step) {
            let result = panic::catch_unwind(|| read(bytes[..length].to_vec()));
            assert!(result.is_ok(), "{name} cut to {length} bytes panics");
        }
    }
}
