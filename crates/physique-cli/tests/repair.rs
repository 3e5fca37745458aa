//! `physique repair` as a user meets it.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use glam::{Quat, Vec3};
use physique::body::Joint;
use physique::motion::{FrameRate, Motion, Recording, native};
use serde_json::Value;

mod support;
use support::{at, body, fails, succeeds, text, write_bvh};

/// A second of standing at this height above the ground, the left elbow bent so far.
fn write_standing(path: &Path, above: f32, elbow: f32) {
    let body = body();
    let lowest = body.rest_vertices().iter().map(|v| v.y);
    let lowest = lowest.fold(f32::MAX, f32::min);
    let mut pose = [Quat::IDENTITY; Joint::COUNT];
    pose[Joint::LeftShoulder.index()] = Quat::from_rotation_z(-1.1);
    pose[Joint::RightShoulder.index()] = Quat::from_rotation_z(1.1);
    pose[Joint::LeftElbow.index()] = Quat::from_rotation_z(-elbow);
    let root = vec![Vec3::Y * (above - lowest); 30];
    let rate = FrameRate::new(30.0).unwrap();
    let motion = Motion::new(rate, None, root, pose.repeat(30)).unwrap();
    let recording = Recording {
        name: "standing".into(),
        rest_pelvis: body.rest_joint(Joint::Pelvis),
        motion,
        source: None,
        licence: None,
        notes: Vec::new(),
    };
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    native::write(path, &recording).unwrap();
}

fn mean_cm3(score: &Value) -> f64 {
    score["self_intersection"]["mean_cm3"].as_f64().unwrap()
}

#[test]
fn an_arm_in_the_belly_is_taken_out_and_the_table_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let (source, fixed) = (at(&folder, "in.motion.npz"), at(&folder, "fixed.bvh"));
    write_standing(Path::new(&source), 0.0, 0.85);
    let table = succeeds(&["repair", &source, "-o", &fixed]);
    assert!(table.contains("self_intersection_mean_cm3"), "{table}");
    assert!(table.contains("Repaired"), "{table}");
    let [before, after] = [&source, &fixed].map(|file| {
        let report: Value = serde_json::from_str(&succeeds(&["score", "--json", file])).unwrap();
        mean_cm3(&report["motions"][0]["score"])
    });
    assert!(before > 20.0 && after < 0.1 * before, "{before} {after}");
}

#[test]
fn json_has_every_measure_before_and_after() {
    let folder = tempfile::tempdir().unwrap();
    let (source, fixed) = (at(&folder, "in.motion.npz"), at(&folder, "fixed.glb"));
    write_standing(Path::new(&source), -0.03, 0.0);
    let json = succeeds(&[
        "repair", &source, "-o", &fixed, "--json", "--only", "ground",
    ]);
    let report: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["schema"], "physique.repair/1");
    assert_eq!(report["targets"]["feet"], false);
    let motion = &report["motions"][0];
    assert_eq!(motion["outcome"], "repaired");
    let depth = |score: &Value| score["ground"]["penetration_mean_cm"].as_f64().unwrap();
    assert!((depth(&motion["before"]) - 3.0).abs() < 0.01);
    assert!(depth(&motion["after"]) < 0.2, "{}", motion["after"]);
    assert!(fs::read(&fixed).unwrap().starts_with(b"glTF"));
    let schema: Value = serde_json::from_str(&succeeds(&["repair", "--schema"])).unwrap();
    let known = schema["properties"].as_object().unwrap();
    for field in report.as_object().unwrap().keys() {
        assert!(known.contains_key(field), "{field}");
    }
}

#[test]
fn sound_motion_goes_through_bit_by_bit() {
    let folder = tempfile::tempdir().unwrap();
    let [source, fixed] = ["in.motion.npz", "out.motion.npz"].map(|name| at(&folder, name));
    write_standing(Path::new(&source), 0.0, 0.0);
    let told = succeeds(&["repair", &source, "-o", &fixed]);
    assert!(told.contains("Nothing is worth a change"), "{told}");
    let read = |path: &str| native::read(Path::new(path), &Default::default()).unwrap();
    assert_eq!(read(&source).motion, read(&fixed).motion);
}

#[test]
fn a_folder_is_repaired_once_and_its_record_says_how() {
    let folder = tempfile::tempdir().unwrap();
    write_standing(&folder.path().join("in/a/belly.motion.npz"), 0.0, 0.85);
    write_standing(&folder.path().join("in/sunk.motion.npz"), -0.02, 0.0);
    let [input, output] = ["in", "out"].map(|name| at(&folder, name));
    let run = || succeeds(&["repair", &input, "-o", &output, "--to", "bvh"]);
    let table = run();
    assert!(table.contains("2 repaired"), "{table}");
    let record = folder.path().join("out/repair.jsonl");
    let first = fs::read_to_string(&record).unwrap();
    assert_eq!(first.lines().count(), 3);
    let modified = |name: &str| {
        let file = fs::metadata(folder.path().join("out").join(name)).unwrap();
        file.modified().unwrap()
    };
    let written = modified("a/belly.bvh");

    // A run that was stopped: one line is torn, one result is missing.
    fs::remove_file(folder.path().join("out/sunk.bvh")).unwrap();
    fs::write(&record, &first[..first.len() - 20]).unwrap();
    run();
    assert_eq!(modified("a/belly.bvh"), written);
    assert!(folder.path().join("out/sunk.bvh").exists());
    let again = fs::read_to_string(&record).unwrap();
    assert_eq!(again.lines().next(), first.lines().next());
    assert_eq!(again.lines().count(), 3);
}

#[test]
fn what_cannot_be_read_is_named_and_the_rest_is_repaired() {
    let folder = tempfile::tempdir().unwrap();
    write_standing(&folder.path().join("in/sunk.motion.npz"), -0.02, 0.0);
    fs::write(folder.path().join("in/broken.bvh"), "HIERARCHY\nnothing").unwrap();
    let [input, output] = ["in", "out"].map(|name| at(&folder, name));
    let complaint = fails(1, &["repair", &input, "-o", &output, "--to", "bvh"]);
    assert!(complaint.contains("broken.bvh"), "{complaint}");
    assert!(folder.path().join("out/sunk.bvh").exists());
    assert!(!folder.path().join("out/broken.bvh").exists());
}

#[test]
fn unusable_flags_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    write_bvh(&folder.path().join("walk.bvh"), "walk");
    let walk = at(&folder, "walk.bvh");
    let fixed = at(&folder, "fixed.bvh");
    let complaint = fails(1, &["repair", &walk, "-o", &fixed, "--strength", "0"]);
    assert!(complaint.contains("positive number"), "{complaint}");
    fails(2, &["repair", &walk, "-o", &fixed, "--only", "hair"]);
    let complaint = fails(1, &["repair", &walk, "-o", &walk]);
    assert!(complaint.contains("would be replaced"), "{complaint}");
    let complaint = fails(1, &["repair", &walk, "-o", &at(&folder, "out/")]);
    assert!(complaint.contains("--to"), "{complaint}");
    let empty = folder.path().join("empty.bvh");
    fs::write(&empty, "").unwrap();
    let empty = empty.display().to_string();
    let complaint = fails(1, &["repair", &empty, "-o", &fixed]);
    assert!(complaint.contains("empty.bvh"), "{complaint}");
    assert!(!Path::new(&fixed).exists());
    let output = support::physique(&["repair", &walk]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
}
