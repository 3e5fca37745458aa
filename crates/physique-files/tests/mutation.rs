//! An in-process mutational fuzzer: broken copies of every fixture and attack.
//!
//! A short run with a fixed seed belongs to the tests. For a long one:
//! `PHYSIQUE_FUZZ_SECONDS=600 cargo test -p physique-files --test mutation -- --nocapture`

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::time::{Duration, Instant};
use std::{env, fs, panic};

use physique_files::named_arrays;
use physique_files::npz::ArrayLimits;
use physique_files::pickle::{Pickle, PickleLimits};

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

/// SplitMix64 (Steele, Lea and Flood, 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut value = self.0;
        value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        value ^ (value >> 31)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }
}

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

fn mutate(random: &mut Random, bytes: &mut Vec<u8>, other: &[u8]) {
    for _ in 0..=random.below(6) {
        if bytes.is_empty() {
            return;
        }
        // Mostly where the structure is, not within numbers.
        let reach = if random.below(2) == 0 {
            bytes.len().min(400)
        } else {
            bytes.len()
        };
        let at = random.below(reach);
        match random.below(8) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = OPCODES[random.below(OPCODES.len())],
            2 => bytes.insert(at, OPCODES[random.below(OPCODES.len())]),
            3 => {
                let end = (at + 1 + random.below(16)).min(bytes.len());
                bytes.drain(at..end);
            }
            4 => {
                let value = [0, 1, 0x7f, 0x80, 0xff][random.below(5)];
                let end = (at + 1 + random.below(8)).min(bytes.len());
                bytes[at..end].fill(value);
            }
            5 => {
                let end = (at + 1 + random.below(64)).min(bytes.len());
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, copy);
            }
            6 if !other.is_empty() => {
                let from = random.below(other.len());
                let end = (from + 1 + random.below(64)).min(other.len());
                bytes.splice(at..at, other[from..end].iter().copied());
            }
            _ => bytes.truncate(at),
        }
    }
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
    let seconds = env::var("PHYSIQUE_FUZZ_SECONDS")
        .ok()
        .and_then(|text| text.parse().ok());
    let seed = env::var("PHYSIQUE_FUZZ_SEED")
        .ok()
        .and_then(|text| text.parse().ok());
    let mut random = Random(seed.unwrap_or(1));
    let start = Instant::now();
    let (mut runs, mut readable, mut slowest) = (0_u64, 0_u64, Duration::ZERO);
    loop {
        let done = match seconds {
            Some(seconds) => start.elapsed() >= Duration::from_secs(seconds),
            None => runs >= 4_000,
        };
        if done {
            break;
        }
        let before = random.0;
        let (name, bytes) = &files[random.below(files.len())];
        let (_, other) = &files[random.below(files.len())];
        let mut bytes = bytes.clone();
        mutate(&mut random, &mut bytes, other);
        let begun = Instant::now();
        let outcome = panic::catch_unwind(|| read(bytes));
        slowest = slowest.max(begun.elapsed());
        match outcome {
            Ok(read) => readable += u64::from(read),
            Err(_) => panic!("a mutation of {name} panics: PHYSIQUE_FUZZ_SEED={before}"),
        }
        runs += 1;
    }
    println!("{runs} files, {readable} of them readable, the slowest took {slowest:.1?}");
    assert!(
        readable > 0 && readable < runs,
        "mutations neither all break nor all miss"
    );
    assert!(slowest < Duration::from_secs(20), "{slowest:?}");
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
