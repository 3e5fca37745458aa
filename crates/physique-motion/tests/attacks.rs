//! Hostile motion files: what each must come to, in little memory and time.
//!
//! `PHYSIQUE_WRITE_SAFETY=1 cargo test -p physique-motion --test attacks` writes the table in
//! `docs/safety.md`.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use physique_motion::mapping::{BodyRest, MappingOptions, map_to_body};
use physique_motion::{Error, Limits, ReadOptions, SourceMotion, parse_motions};

#[path = "../../../attacks/support/memory.rs"]
mod memory;
mod support;
#[path = "../../../attacks/support/table.rs"]
mod table;

use table::Row;

const ATTACKS: &str = "../../attacks/motion";
const LIMIT: u64 = 32 << 20;
/// Beside the file itself.
const LARGEST_PEAK: usize = LIMIT as usize;
const LONGEST: Duration = Duration::from_secs(10);

/// What a file tries, and what must happen: a word of its error, or nothing where it is harmless.
struct Attack {
    file: String,
    bytes: Vec<u8>,
    tries: String,
    word: String,
}

/// The files of the folder, as its list says: name, what it tries, a word of the error.
fn small() -> Vec<Attack> {
    let list = fs::read_to_string(Path::new(ATTACKS).join("expected.tsv")).unwrap();
    let attacks = list.lines().map(|line| {
        let [file, tries, word] = line.split('\t').collect::<Vec<_>>()[..] else {
            panic!("three columns, not {line}");
        };
        Attack {
            file: file.into(),
            bytes: fs::read(Path::new(ATTACKS).join(file)).unwrap(),
            tries: tries.into(),
            word: word.into(),
        }
    });
    attacks.collect()
}

/// What needs more than a small file: made here.
fn large() -> Vec<Attack> {
    let bvh = |text: String| format!("HIERARCHY\nROOT a\n{{\n{text}").into_bytes();
    let gltf = |fields: String| format!("{{\"asset\":{{}},{fields}}}").into_bytes();
    let frames = |text: String| format!("{{\"Frames\":{text}").into_bytes();
    let row = format!(
        "CHANNELS 1 Xposition\n}}\nMOTION\nFrames: 1\nFrame Time: 1\n{}",
        "0 ".repeat(4_000_000)
    );
    let base64 = "A".repeat(20 << 20);
    let buffer = format!("\"buffers\":[{{\"byteLength\":1,\"uri\":\"data:;base64,{base64}\"}}]");
    [
        (
            "deep.bvh",
            "100,000 joints in each other",
            bvh("JOINT b\n{\n".repeat(100_000)),
            "depth",
        ),
        (
            "name.bvh",
            "a name of 8 MB",
            bvh(format!("JOINT {}", "b".repeat(8 << 20))),
            "expected {",
        ),
        (
            "braces.bvh",
            "1,000,000 closing braces",
            bvh("}".repeat(1_000_000)),
            "found \"}\"",
        ),
        (
            "row.bvh",
            "a frame of 4,000,000 numbers",
            bvh(row),
            "1 numbers",
        ),
        (
            "nodes.gltf",
            "3,000,000 nodes of three bytes each",
            gltf(format!("\"nodes\":[{}{{}}]", "{},".repeat(3_000_000))),
            "memory of the document",
        ),
        (
            "lists.gltf",
            "100,000 lists in each other",
            gltf(format!("\"extras\":{}", "[".repeat(100_000))),
            "glTF document",
        ),
        (
            "base64.gltf",
            "20 MB of base64 that nothing asks for",
            gltf(buffer),
            "one animation",
        ),
        (
            "frames.json",
            "200,000 frames of two numbers",
            frames(format!("[{}[]]}}", "[1,2],".repeat(200_000))),
            "44 numbers",
        ),
        (
            "brackets.json",
            "4,000,000 opening brackets",
            frames("[".repeat(4_000_000)),
            "number of frames",
        ),
        (
            "no_skeleton.amc",
            "3,000,000 empty frames, and no skeleton",
            format!(":DEGREES\n{}", "1\n".repeat(3_000_000)).into_bytes(),
            "its skeleton",
        ),
    ]
    .map(|(file, tries, bytes, word)| Attack {
        file: format!("{file} (made by the test)"),
        bytes,
        tries: tries.into(),
        word: word.into(),
    })
    .into()
}

/// As a program would: read, pose, bring to the body. Motions read.
fn read(name: &str, bytes: Vec<u8>, body: &BodyRest) -> Result<usize, Error> {
    let options = ReadOptions {
        limits: Limits {
            bytes: LIMIT,
            ..Limits::default()
        },
        ..ReadOptions::default()
    };
    let motions = parse_motions(bytes, Path::new(ATTACKS).join(name), &options)?;
    for motion in &motions {
        if let SourceMotion::Skeleton(clip) = &motion.motion {
            for frame in (0..clip.frame_count()).take(10) {
                let pose = clip.pose(frame);
                assert!(
                    pose.positions.iter().all(|place| place.is_finite()),
                    "{name}"
                );
            }
            let _ = map_to_body(clip, body, &MappingOptions::default());
        }
    }
    Ok(motions.len())
}

#[test]
fn every_attack_comes_to_nothing() {
    let attacks = small();
    let listed: BTreeSet<&str> = attacks.iter().map(|attack| &*attack.file).collect();
    let there: Vec<String> = fs::read_dir(ATTACKS)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let unlisted = there.iter().filter(|name| !listed.contains(&***name));
    // Skeletons come with their motions.
    let unlisted: Vec<&String> = unlisted
        .filter(|name| !name.ends_with(".asf") && !name.ends_with(".tsv"))
        .collect();
    assert!(unlisted.is_empty(), "not in expected.tsv: {unlisted:?}");

    let body = support::figure();
    let mut rows = Vec::new();
    let mut wrong = Vec::new();
    for attack in attacks.into_iter().chain(large()) {
        let Attack {
            file,
            bytes,
            tries,
            word,
        } = attack;
        let length = bytes.len();
        let (before, start) = (memory::start(), Instant::now());
        let found = read(&file, bytes, &body);
        let (peak, time) = (memory::peak() - before, start.elapsed());
        let happened = match &found {
            Ok(motions) => format!("harmless: {motions} motions"),
            // Neither this machine's folders nor the system's words.
            Err(error) => {
                let text = error.to_string().replace(&format!("{ATTACKS}/"), "");
                text.chars().take(150).collect()
            }
        };
        let as_expected = match &found {
            Ok(_) => word.is_empty(),
            Err(error) => !word.is_empty() && error.to_string().contains(&word),
        };
        if !as_expected || peak > LARGEST_PEAK || time > LONGEST {
            wrong.push(format!(
                "{file}: expected `{word}`, found {happened}; {peak} bytes, {time:?}"
            ));
        }
        rows.push(Row {
            file,
            bytes: length,
            tried: tries,
            happened,
            peak,
            time,
        });
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    table::write_or_compare("attacks on motions", &rows);
}
