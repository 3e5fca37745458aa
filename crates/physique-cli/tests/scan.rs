//! `physique scan` as a user meets it.

#![allow(clippy::unwrap_used)]

use std::fs;

use glam::Vec3;
use physique::motion::bvh::{BvhWriteOptions, write_clip};
use physique::motion::{Motion, SkeletonClip};
use serde_json::Value;

mod schema;
mod support;
use support::{at, body, fails, motion, succeeds, write_bvh};

/// A good walk, one that floats, a stub, a dance with a fault of the recording, and no motion.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["walk", "dance"] {
        write_bvh(&folder.path().join(format!("clips/{name}.bvh")), name);
    }
    let walk = motion("walk");
    let write = |name: &str, frames: usize, lift: f32| {
        let roots = walk.root_translation()[..frames]
            .iter()
            .map(|root| *root + Vec3::Y * lift);
        let rotations = walk.rotations()[..frames * 22].to_vec();
        let changed = Motion::new(walk.frame_rate(), None, roots.collect(), rotations).unwrap();
        let clip = SkeletonClip::from_motion(&changed, &(&body()).into()).unwrap();
        let path = folder.path().join(format!("clips/{name}.bvh"));
        write_clip(path, &clip, &BvhWriteOptions::default()).unwrap();
    };
    write("stub", 5, 0.0);
    let whole = fs::read_to_string(folder.path().join("clips/walk.bvh")).unwrap();
    let (head, frames) = whole.split_once("Frame Time").unwrap();
    let number = frames.split_whitespace().nth(3).unwrap();
    let poisoned = frames.replacen(number, "nan", 1);
    let path = folder.path().join("clips/nan.bvh");
    fs::write(path, format!("{head}Frame Time{poisoned}")).unwrap();
    fs::write(folder.path().join("clips/text.bvh"), "no motion").unwrap();
    folder
}

#[test]
fn bad_clips_are_listed_with_reasons_and_filtered() {
    let folder = folder();
    let clips = at(&folder, "clips");
    let [bad, good] = [at(&folder, "bad.txt"), at(&folder, "good.txt")];
    let text = succeeds(&["scan", &clips, "-o", &bad, "--good", &good]);
    assert!(text.contains("jump: At 1.75 s"), "{text}");
    assert!(text.contains("too-short: The clip lasts 0.1"), "{text}");
    assert!(text.contains("4 of 5 clips are bad"), "{text}");
    let names = |list: &str| {
        let text = fs::read_to_string(list).unwrap();
        let names = text
            .lines()
            .map(|line| line.rsplit('/').next().unwrap().to_owned());
        names.collect::<Vec<_>>()
    };
    assert_eq!(
        names(&bad),
        ["dance.bvh", "nan.bvh", "stub.bvh", "text.bvh"]
    );
    assert_eq!(names(&good), ["walk.bvh"]);
    fails(3, &["scan", "--strict", &clips]);
    succeeds(&["scan", "--strict", &at(&folder, "clips/walk.bvh")]);
}

#[test]
fn json_follows_its_schema_and_csv_has_a_line_a_defect() {
    let folder = folder();
    let clips = at(&folder, "clips");
    let schema: Value = serde_json::from_str(&succeeds(&["scan", "--schema"])).unwrap();
    let report: Value = serde_json::from_str(&succeeds(&["scan", "--json", &clips])).unwrap();
    assert_eq!(schema::problems(&schema, &report), Vec::<String>::new());
    let clips_found = report["clips"].as_array().unwrap();
    let defects: usize = clips_found
        .iter()
        .map(|clip| clip["defects"].as_array().unwrap().len())
        .sum();
    let csv = succeeds(&["scan", "--csv", &clips]);
    assert_eq!(csv.lines().count(), 1 + defects, "{csv}");
}

#[test]
fn thresholds_and_kinds_are_the_users() {
    let folder = folder();
    let dance = at(&folder, "clips/dance.bvh");
    let bad = |arguments: &[&str]| {
        let text = succeeds(&[&["scan", &dance], arguments].concat());
        !text.contains("are good")
    };
    assert!(bad(&[]));
    assert!(!bad(&["--without", "jump"]));
    assert!(!bad(&["--jump-cm", "100", "--jump-degrees", "180"]));
    assert!(bad(&[
        "--only",
        "self-intersection",
        "--self-intersection",
        "1"
    ]));
    assert!(bad(&["--only", "too-short", "--least-seconds", "60"]));
    assert!(bad(&[
        "--only",
        "frame-rate",
        "--frame-rates",
        "100",
        "120"
    ]));
}

#[test]
fn parts_of_a_scan_add_up() {
    let folder = folder();
    let clips = at(&folder, "clips");
    let list = |arguments: &[&str]| {
        let output = at(&folder, "list.txt");
        succeeds(
            &[
                &[
                    "scan",
                    "--without",
                    "self-intersection",
                    &clips,
                    "-o",
                    &output,
                ],
                arguments,
            ]
            .concat(),
        );
        let text = fs::read_to_string(&output).unwrap();
        text.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let whole = list(&[]);
    let mut parts = [list(&["--shard", "1/2"]), list(&["--shard", "2/2"])].concat();
    parts.sort();
    assert_eq!(parts, whole);
}
