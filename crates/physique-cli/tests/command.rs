//! The command as a user meets it: output, files and exit codes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use physique::body::{Body, Sex, open_body};
use physique::load::load_recording;
use physique::motion::bvh::{BvhWriteOptions, write_clip};
use physique::motion::{SkeletonClip, embedded};
use serde_json::Value;

fn physique(arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("physique").unwrap();
    command.args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A folder with the embedded dance and walk as BVH.
fn folder_of_clips() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let body = Body::mean(open_body().unwrap(), Sex::Neutral).unwrap();
    for clip in embedded::clips() {
        if ["dance", "walk"].contains(&clip.name) {
            let motion = load_recording(clip.load().unwrap(), &body).unwrap().motion;
            let clip_of_body = SkeletonClip::from_motion(&motion, &(&body).into()).unwrap();
            let path = folder.path().join(format!("{}.bvh", clip.name));
            write_clip(path, &clip_of_body, &BvhWriteOptions::default()).unwrap();
        }
    }
    folder
}

fn path(folder: &tempfile::TempDir, name: &str) -> String {
    folder.path().join(name).display().to_string()
}

#[test]
fn score_prints_a_row_a_motion() {
    let folder = folder_of_clips();
    let output = physique(&[
        "score",
        &path(&folder, "dance.bvh"),
        &path(&folder, "walk.bvh"),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    for word in ["dance.bvh", "walk.bvh", "cm³", "left", "open body"] {
        assert!(table.contains(word), "{word} in {table}");
    }
}

#[test]
fn json_is_complete_and_the_same_for_any_number_of_threads() {
    let folder = folder_of_clips();
    let clips = folder.path().display().to_string();
    let one = physique(&["score", "--json", "--threads", "1", &clips]);
    let many = physique(&["score", "--json", "--threads", "4", &clips]);
    assert_eq!(one.stdout, many.stdout, "byte for byte");
    let report: Value = serde_json::from_slice(&one.stdout).unwrap();
    assert_eq!(report["schema"], "physique.score/1");
    assert_eq!(report["protocol"], "native");
    assert!(report["body"]["stature_m"].as_f64().unwrap() > 1.5);
    let motions = report["motions"].as_array().unwrap();
    assert_eq!(motions.len(), 2);
    let dance = &motions[0];
    assert!(dance["file"].as_str().unwrap().ends_with("dance.bvh"));
    assert!(
        dance["score"]["self_intersection"]["mean_cm3"]
            .as_f64()
            .unwrap()
            > 1.0
    );
    assert!(dance["mapping"]["mean_error_cm"].as_f64().unwrap() < 0.5);
    assert_eq!(dance["unscorable"], Value::Null);
}

/// What the schema demands of the report, by hand: every required property is there.
#[test]
fn the_schema_describes_the_json() {
    let schema: Value = serde_json::from_slice(&physique(&["score", "--schema"]).stdout).unwrap();
    let folder = folder_of_clips();
    let output = physique(&["score", "--json", &path(&folder, "walk.bvh")]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let check = |schema: &Value, value: &Value| {
        let required = schema["required"].as_array().unwrap();
        assert!(!required.is_empty());
        for name in required {
            assert!(value.get(name.as_str().unwrap()).is_some(), "{name}");
        }
        for (name, _) in value.as_object().unwrap() {
            assert!(
                schema["properties"].get(name).is_some(),
                "{name} is described"
            );
        }
    };
    check(&schema, &report);
    check(&schema["$defs"]["MotionReport"], &report["motions"][0]);
    let score = &report["motions"][0]["score"];
    check(&schema["$defs"]["MotionScore"], score);
    check(
        &schema["$defs"]["SelfIntersection"],
        &score["self_intersection"],
    );
}

#[test]
fn csv_has_a_line_a_motion_and_units_in_its_names() {
    let folder = folder_of_clips();
    let target = path(&folder, "scores.csv");
    let clips = [path(&folder, "dance.bvh"), path(&folder, "walk.bvh")];
    let output = physique(&["score", "--csv", "-o", &target, &clips[0], &clips[1]]);
    assert_eq!(output.status.code(), Some(0));
    let mut reader = csv::Reader::from_path(&target).unwrap();
    let names = reader.headers().unwrap().clone();
    let mean = names
        .iter()
        .position(|name| name == "self_intersection_mean_cm3")
        .unwrap();
    let rows: Vec<_> = reader.records().collect::<Result<_, _>>().unwrap();
    assert_eq!(rows.len(), 2);
    assert!(
        rows.iter()
            .all(|row| row[mean].parse::<f64>().unwrap() >= 0.0)
    );
}

#[test]
fn the_published_protocol_has_its_own_measures() {
    let folder = folder_of_clips();
    let dance = path(&folder, "dance.bvh");
    let output = physique(&["score", "--protocol", "sia", "--json", &dance]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let score = &report["motions"][0]["score"];
    assert_eq!(score["self_intersection"], Value::Null);
    assert!(score["sia"]["volume_cm3"].as_f64().unwrap() > 1e4);
}

#[test]
fn what_cannot_be_scored_is_null_with_a_reason_and_a_failure() {
    let folder = folder_of_clips();
    let broken = path(&folder, "broken.bvh");
    fs::write(&broken, "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0").unwrap();
    let empty = path(&folder, "empty.bvh");
    let dance = fs::read_to_string(path(&folder, "dance.bvh")).unwrap();
    let head = dance.split("MOTION").next().unwrap();
    fs::write(
        &empty,
        format!("{head}MOTION\nFrames: 0\nFrame Time: 0.03\n"),
    )
    .unwrap();
    let missing = path(&folder, "missing.bvh");
    for file in [&broken, &empty, &missing] {
        let output = physique(&["score", "--json", file, &path(&folder, "walk.bvh")]);
        assert_eq!(output.status.code(), Some(1), "{file}");
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(report["motions"][0]["score"], Value::Null, "{file}");
        let reason = report["motions"][0]["unscorable"].as_str().unwrap();
        assert!(
            reason.len() > 20 && !reason.contains("panicked"),
            "{reason}"
        );
        assert!(
            report["motions"][1]["score"].is_object(),
            "the others are scored"
        );
        assert!(text(&output.stderr).contains(file.as_str()));
    }
}

#[test]
fn conditions_decide_the_exit_code() {
    let folder = folder_of_clips();
    let dance = path(&folder, "dance.bvh");
    let code = |condition: &str| {
        let output = physique(&["score", "--fail-on", condition, &dance]);
        output.status.code()
    };
    assert_eq!(code("self_intersection_mean_cm3>1000000"), Some(0));
    assert_eq!(code("self_intersection_mean_cm3>=0"), Some(3));
    assert_eq!(code("frames<0 or self_intersection_worst_cm3>1"), Some(3));
    assert_eq!(
        code("sia_volume_cm3>1"),
        Some(1),
        "not measured by this protocol"
    );
    assert_eq!(code("nonsense>1"), Some(2));
}

#[test]
fn the_body_is_the_one_asked_for() {
    let folder = folder_of_clips();
    let dance = path(&folder, "dance.bvh");
    let body = |arguments: &[&str]| {
        let output = physique(&[&["score", "--json", &dance], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let figure = |name: &str| report["body"][name].as_f64().unwrap();
        let score = &report["motions"][0]["score"]["self_intersection"];
        (
            figure("stature_m"),
            figure("mass_kg"),
            score["mean_cm3"].as_f64().unwrap(),
        )
    };
    let slim = body(&["--sex", "male", "--stature", "1.8", "--mass", "65"]);
    let heavy = body(&["--sex", "male", "--stature", "1.8", "--mass", "115"]);
    assert!(
        (slim.0 - 1.8).abs() < 1e-3 && (slim.1 - 65.0).abs() < 0.01,
        "{slim:?}"
    );
    assert!((heavy.1 - 115.0).abs() < 0.01);
    assert!(
        heavy.2 > 2.0 * slim.2,
        "a heavier body passes through itself more: {slim:?} {heavy:?}"
    );
    let impossible = physique(&["score", "--stature", "9", &dance]);
    assert_eq!(impossible.status.code(), Some(1));
    assert!(text(&impossible.stderr).contains("can represent"));
}

#[test]
fn view_draws_a_picture() {
    let folder = folder_of_clips();
    let sheet = path(&folder, "sheet.png");
    let output = physique(&[
        "view",
        "--png",
        &sheet,
        "--moments",
        "3",
        &path(&folder, "walk.bvh"),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(is_png(Path::new(&sheet)));
}

#[test]
fn demo_scores_and_draws_real_motion() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("demo");
    let output = physique(&["demo", "-o", &target.display().to_string()]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let scores = fs::read_to_string(target.join("scores.json")).unwrap();
    let report: Value = serde_json::from_str(&scores).unwrap();
    let motions = report["motions"].as_array().unwrap();
    assert_eq!(motions.len(), embedded::clips().len());
    for motion in motions {
        let name = motion["file"].as_str().unwrap();
        let picture: PathBuf = target.join(format!("{name}.png"));
        assert!(is_png(&picture), "{name}");
    }
}

fn is_png(path: &Path) -> bool {
    fs::read(path).is_ok_and(|bytes| bytes.starts_with(b"\x89PNG\r\n\x1a\n"))
}
