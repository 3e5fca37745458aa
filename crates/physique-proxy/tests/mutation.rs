//! An in-process mutational fuzzer for proxy files, and truncations. A short run belongs to the
//! tests; a long one:
//! `PHYSIQUE_FUZZ_SECONDS=600 cargo test -p physique-proxy --test mutation no_mutation -- --nocapture`

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says where")]

use std::path::Path;
use std::{fs, panic};

use physique_proxy::files::{Precision, ProxyLimits, proxy_bytes, read_published};

mod hostile;
#[path = "../../../attacks/support/mutation.rs"]
mod mutation;

use hostile::{FILES, Published, sound, use_proxy};
use mutation::fuzz;

const LIMITS: ProxyLimits = ProxyLimits {
    bytes: 1 << 24,
    parameters: 1 << 20,
    spheres: 256,
};

/// Whether the file could be read; `name` says which file of a published folder it stands for.
fn read(folder: &Published, name: &str, bytes: &[u8]) -> bool {
    let stands_for = FILES.into_iter().find(|file| name.ends_with(file));
    let found = folder.read(name, stands_for, bytes, &LIMITS);
    found.inspect(use_proxy).is_ok()
}

/// Hostile files, the published fixture, and what we write of it.
fn corpus(folder: &Published) -> Vec<(String, Vec<u8>)> {
    let attacks = Path::new("../../attacks/proxy");
    let list = fs::read_to_string(attacks.join("expected.tsv")).unwrap();
    let mut files: Vec<(String, Vec<u8>)> = list
        .lines()
        .map(|line| {
            let mut columns = line.split('\t');
            let (file, stands_for) = (columns.next().unwrap(), columns.next().unwrap());
            (
                format!("{file} as {stands_for}"),
                fs::read(attacks.join(file)).unwrap(),
            )
        })
        .collect();
    for file in FILES {
        files.extend((0..4).map(|_| (file.to_owned(), sound(file))));
    }
    let proxy = read_published(&folder.path(""), &LIMITS).unwrap();
    for precision in [Precision::Exact, Precision::Half, Precision::Compact] {
        let bytes = proxy_bytes(&proxy, precision).unwrap();
        files.extend((0..4).map(|_| ("ours.safetensors".to_owned(), bytes.clone())));
    }
    files
}

#[test]
fn no_mutation_panics() {
    let folder = Published::new();
    let words: [&[u8]; 16] = [
        b"\"F32\"",
        b"\"I8\"",
        b"\"shape\":[0,2]",
        b"\"data_offsets\":[0,8]",
        b"\"spheres.net1.0.weight_v\"",
        b"\"spheres.net2.8.bias\"",
        b"\"pairs\"",
        b"physique-proxy 1\\n",
        b"poses: ",
        b"[",
        b"net1.0.weight_v",
        b"'<f8'",
        b"(4294967296, 24)",
        b"\x80\x02",
        b"\0\0\xc0\x7f",
        b"\xff\xff\x7f\x7f",
    ];
    let files = corpus(&folder);
    fuzz("proxies", &files, &words, |name, bytes| {
        read(&folder, name, &bytes)
    });
}

#[test]
fn no_truncation_panics() {
    let folder = Published::new();
    let mut files = corpus(&folder);
    files.dedup();
    for (name, bytes) in files {
        let step = (bytes.len() / 300).max(1);
        for length in (0..bytes.len()).step_by(step) {
            let cut = &bytes[..length];
            let result = panic::catch_unwind(|| read(&folder, &name, cut));
            assert!(result.is_ok(), "{name} cut to {length} bytes panics");
        }
    }
}
