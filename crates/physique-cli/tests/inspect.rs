//! `physique inspect` as a user meets it.

#![allow(clippy::unwrap_used)]

use std::fs;

use serde_json::Value;

mod support;
use support::{at, fails, physique, succeeds, text, write_bvh};

/// A clip as BVH, its lines changed.
fn changed(
    folder: &tempfile::TempDir,
    clip: &str,
    change: impl Fn(Vec<String>) -> Vec<String>,
) -> String {
    let path = folder.path().join(format!("{clip}.bvh"));
    write_bvh(&path, clip);
    let lines = fs::read_to_string(&path).unwrap();
    let lines = change(lines.lines().map(str::to_owned).collect());
    fs::write(&path, lines.join("\n") + "\n").unwrap();
    path.display().to_string()
}

/// Where the frames begin among the lines.
fn first_frame(lines: &[String]) -> usize {
    lines
        .iter()
        .position(|line| line.starts_with("Frame Time"))
        .unwrap()
        + 1
}

fn inspect(file: &str) -> Value {
    let output = physique(&["inspect", "--json", file]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["schema"], "physique.inspect/1");
    report["files"][0].clone()
}

fn kinds(file: &str) -> Vec<String> {
    let file = inspect(file);
    let warnings = file["motions"][0]["warnings"].as_array().unwrap();
    warnings
        .iter()
        .map(|warning| warning["kind"].as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn one_file_is_told_in_full_within_100_columns() {
    let folder = tempfile::tempdir().unwrap();
    write_bvh(&folder.path().join("walk.bvh"), "walk");
    let text = succeeds(&["inspect", &at(&folder, "walk.bvh")]);
    for part in [
        "BVH: ",
        "frames at 30 a second",
        "22 joints, matched by",
        "centimetres, Y up",
        "left and right as named",
        "left_knee      left_knee",
        "turns",
        "warnings      none",
    ] {
        // Lines may break between any two words, but not in the table.
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words(&text).contains(&words(part)), "{part} in\n{text}");
    }
    let path_line = text.lines().next().unwrap();
    for line in text.lines().filter(|line| *line != path_line) {
        assert!(
            line.chars().count() <= 100 && !line.ends_with(' '),
            "`{line}`"
        );
    }
}

#[test]
fn a_walk_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    write_bvh(&folder.path().join("walk.bvh"), "walk");
    let walk = &inspect(&at(&folder, "walk.bvh"))["motions"][0];
    let number = |path: &str| walk.pointer(path).and_then(Value::as_f64).unwrap();
    let speed = number("/movement/mean_speed_m_s");
    assert!((0.8..2.0).contains(&speed), "{speed} m/s");
    assert!((number("/movement/path_m") / number("/seconds") / speed - 1.0).abs() < 0.1);
    assert!(number("/movement/turned_degrees").abs() < 15.0);
    assert!((1.5..1.9).contains(&number("/stature_m")));
    assert!(number("/hardest_fall_g") < 1.0);
    let joints = walk["range_of_motion"].as_array().unwrap();
    assert_eq!(joints.len(), 21);
    let knee = joints
        .iter()
        .find(|joint| joint["joint"] == "left_knee")
        .unwrap();
    let bend = knee["bend"]["max"].as_f64().unwrap();
    assert!(
        (40.0..90.0).contains(&bend),
        "a walker's knee bends by {bend} degrees"
    );
    assert_eq!(walk["source"]["joints"], 22);
    assert_eq!(walk["source"]["unmatched"].as_array().unwrap().len(), 0);
}

/// By hand: all that is required is there, and all that is there is described.
#[test]
fn the_schema_describes_the_json() {
    let schema: Value = serde_json::from_str(&succeeds(&["inspect", "--schema"])).unwrap();
    let folder = tempfile::tempdir().unwrap();
    write_bvh(&folder.path().join("walk.bvh"), "walk");
    let file = inspect(&at(&folder, "walk.bvh"));
    let check = |name: &str, value: &Value| {
        let schema = &schema["$defs"][name];
        for required in schema["required"].as_array().unwrap() {
            assert!(
                value.get(required.as_str().unwrap()).is_some(),
                "{required}"
            );
        }
        for (key, _) in value.as_object().unwrap() {
            assert!(
                schema["properties"].get(key).is_some(),
                "{name}.{key} is described"
            );
        }
    };
    check("FileInspection", &file);
    let motion = &file["motions"][0];
    check("MotionInspection", motion);
    check("SourceInspection", &motion["source"]);
    check("Movement", &motion["movement"]);
    check("JointRange", &motion["range_of_motion"][0]);
    check("AxisRange", &motion["range_of_motion"][0]["bend"]);
}

#[test]
fn good_clips_have_no_warnings() {
    let folder = tempfile::tempdir().unwrap();
    for clip in ["walk", "run", "jump"] {
        write_bvh(&folder.path().join(format!("{clip}.bvh")), clip);
        let found = kinds(&at(&folder, &format!("{clip}.bvh")));
        assert!(found.is_empty(), "{clip}: {found:?}");
    }
}

#[test]
fn a_jump_told_at_the_wrong_rate_contradicts_it() {
    let folder = tempfile::tempdir().unwrap();
    let retold = |factor: f64| {
        changed(&folder, "jump", |mut lines| {
            let line = first_frame(&lines) - 1;
            let (_, seconds) = lines[line].split_once(": ").unwrap();
            let seconds: f64 = seconds.parse().unwrap();
            lines[line] = format!("Frame Time: {}", seconds / factor);
            lines
        })
    };
    for factor in [0.5, 2.0] {
        let found = kinds(&retold(factor));
        assert!(
            found.contains(&"frame-rate".to_owned()),
            "{factor}: {found:?}"
        );
    }
}

#[test]
fn stretched_frozen_and_teleporting_clips_are_told() {
    let folder = tempfile::tempdir().unwrap();
    write_bvh(&folder.path().join("dance.bvh"), "dance");
    let stretched = at(&folder, "stretched.bvh");
    succeeds(&[
        "convert",
        &at(&folder, "dance.bvh"),
        &stretched,
        "--resample",
        "120",
    ]);
    assert_eq!(kinds(&stretched), ["in-between-frames"]);
    let frozen = changed(&folder, "walk", |mut lines| {
        let at = first_frame(&lines) + 10;
        let still = lines[at].clone();
        lines.splice(at..at, std::iter::repeat_n(still, 40));
        let frames = lines
            .iter()
            .position(|line| line.starts_with("Frames:"))
            .unwrap();
        let count: usize = lines[frames][8..].parse().unwrap();
        lines[frames] = format!("Frames: {}", count + 40);
        lines
    });
    assert!(kinds(&frozen).contains(&"frozen".to_owned()));
    let teleports = changed(&folder, "run", |mut lines| {
        let first = first_frame(&lines) + 8;
        for line in &mut lines[first..] {
            let (x, rest) = line.split_once(' ').unwrap();
            *line = format!("{} {rest}", x.parse::<f64>().unwrap() + 200.0);
        }
        lines
    });
    assert!(kinds(&teleports).contains(&"jump".to_owned()));
}

#[test]
fn what_cannot_be_read_is_told_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let broken = changed(&folder, "walk", |mut lines| {
        let line = first_frame(&lines) + 3;
        lines[line] = lines[line].replacen(' ', " nan ", 1);
        lines
    });
    let line = fs::read_to_string(&broken)
        .unwrap()
        .lines()
        .position(|line| line.contains("nan"))
        .unwrap();
    let file = inspect(&broken);
    let reason = file["unreadable"].as_str().unwrap();
    assert!(reason.contains(&format!("line {}", line + 1)), "{reason}");
    fails(1, &["inspect", &broken]);
    let missing = inspect(&at(&folder, "missing.bvh"));
    assert_eq!(missing["bytes"], Value::Null);
}

#[test]
fn many_files_are_a_table_and_bodies_are_told_too() {
    let folder = tempfile::tempdir().unwrap();
    for clip in ["walk", "dance"] {
        write_bvh(&folder.path().join(format!("{clip}.bvh")), clip);
    }
    let body = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../physique-body/assets/open_body_low.npz"
    );
    let body_path = at(&folder, "body.npz");
    fs::copy(body, &body_path).unwrap();
    let table = succeeds(&["inspect", &folder.path().display().to_string()]);
    for part in [
        "walk.bvh",
        "dance.bvh",
        "body model",
        "3 files, 2 motions",
        "minutes",
    ] {
        assert!(table.contains(part), "{part} in\n{table}");
    }
    let told = succeeds(&["inspect", &body_path]);
    assert!(
        told.contains("vertices") && told.contains("betas"),
        "{told}"
    );
    let warnings = succeeds(&["inspect", "--warnings", &at(&folder, "walk.bvh")]);
    assert!(warnings.contains("0 motions with warnings"), "{warnings}");
    let results = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../physique-motion/tests/fixtures/arrays/mdm_results.npy"
    );
    let output = physique(&["inspect", results]);
    assert!(text(&output.stdout).contains("mdm_results.npy#1"));
}
