//! `physique score` as a user meets it.

#![allow(clippy::unwrap_used)]

use std::fs;

use serde_json::Value;

mod schema;
mod support;
use support::{at, folder_of_clips, physique, succeeds, text};

#[test]
fn score_prints_a_row_a_motion() {
    let folder = folder_of_clips();
    let output = physique(&["score", &at(&folder, "dance.bvh"), &at(&folder, "walk.bvh")]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    let words = [
        "dance.bvh",
        "walk.bvh",
        "self-intersection",
        "ground",
        "feet",
        "cm³",
        "open body",
    ];
    for word in words {
        assert!(table.contains(word), "{word} in {table}");
    }
    assert!(
        table.lines().all(|line| line.chars().count() <= 100),
        "{table}"
    );
}

#[test]
fn json_is_complete_and_the_same_for_any_number_of_threads() {
    let folder = folder_of_clips();
    let clips = folder.path().display().to_string();
    let one = physique(&["score", "--json", "--threads", "1", &clips]);
    let many = physique(&["score", "--json", "--threads", "4", &clips]);
    assert_eq!(one.stdout, many.stdout, "byte for byte");
    let report: Value = serde_json::from_slice(&one.stdout).unwrap();
    assert_eq!(report["schema"], "physique.score/2");
    assert_eq!(report["protocols"][0], "native");
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

#[test]
fn the_schema_describes_the_json() {
    let schema: Value = serde_json::from_str(&succeeds(&["score", "--schema"])).unwrap();
    let folder = folder_of_clips();
    let broken = at(&folder, "broken.bvh");
    fs::write(&broken, "HIERARCHY").unwrap();
    let files = [&at(&folder, "walk.bvh"), &broken];
    let all = ["score", "--json", "--series", "--protocol", "all"];
    let output = physique(&[&all[..], &files.map(String::as_str)].concat());
    let mut report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(schema::problems(&schema, &report), Vec::<String>::new());
    // The check can fail.
    report["motions"][0]["score"]["ground"]["penetration_mean_cm"] = "deep".into();
    report["floor"] = "attic".into();
    assert_eq!(schema::problems(&schema, &report).len(), 2);
}

#[test]
fn csv_has_a_line_a_motion_and_units_in_its_names() {
    let folder = folder_of_clips();
    let target = at(&folder, "scores.csv");
    let clips = [at(&folder, "dance.bvh"), at(&folder, "walk.bvh")];
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
    let dance = at(&folder, "dance.bvh");
    let output = physique(&["score", "--protocol", "sia", "--json", &dance]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let score = &report["motions"][0]["score"];
    assert_eq!(score["self_intersection"], Value::Null);
    assert!(score["sia"]["volume_cm3"].as_f64().unwrap() > 1e4);
}

#[test]
fn what_cannot_be_scored_is_null_with_a_reason_and_a_failure() {
    let folder = folder_of_clips();
    let broken = at(&folder, "broken.bvh");
    fs::write(&broken, "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0").unwrap();
    let empty = at(&folder, "empty.bvh");
    let dance = fs::read_to_string(at(&folder, "dance.bvh")).unwrap();
    let head = dance.split("MOTION").next().unwrap();
    fs::write(
        &empty,
        format!("{head}MOTION\nFrames: 0\nFrame Time: 0.03\n"),
    )
    .unwrap();
    let missing = at(&folder, "missing.bvh");
    for file in [&broken, &empty, &missing] {
        let output = physique(&["score", "--json", file, &at(&folder, "walk.bvh")]);
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
    let dance = at(&folder, "dance.bvh");
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
    let dance = at(&folder, "dance.bvh");
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
fn every_protocol_is_listed_with_its_source_and_measured() {
    let listed = succeeds(&["score", "--protocols"]);
    let help = succeeds(&["score", "--help"]);
    let folder = folder_of_clips();
    let walk = at(&folder, "walk.bvh");
    let all = succeeds(&[
        "score",
        "--json",
        "--protocol",
        "all",
        "--without",
        "self",
        &walk,
    ]);
    let report: Value = serde_json::from_str(&all).unwrap();
    let names = report["protocols"].as_array().unwrap();
    assert_eq!(names.len(), 12);
    let published = report["motions"][0]["score"]["published"]
        .as_array()
        .unwrap();
    assert_eq!(published.len(), 10);
    for name in names.iter().map(|name| name.as_str().unwrap()) {
        assert!(listed.contains(name) && help.contains(name), "{name}");
    }
    let gmd = published
        .iter()
        .find(|score| score["protocol"] == "gmd")
        .unwrap();
    assert_eq!(gmd["frame_rate_fps"], 20.0);
    assert!(gmd["measures"]["skating_ratio"].is_number());
}

#[test]
fn only_what_is_asked_for_is_measured() {
    let folder = folder_of_clips();
    let walk = at(&folder, "walk.bvh");
    let score = |arguments: &[&str]| {
        let json = succeeds(&[&["score", "--json", &walk], arguments].concat());
        let report: Value = serde_json::from_str(&json).unwrap();
        report["motions"][0]["score"].clone()
    };
    let fast = score(&["--without", "self"]);
    assert!(fast["self_intersection"].is_null() && fast["feet"].is_object());
    let feet = score(&["--only", "feet,smoothness"]);
    assert!(feet["ground"].is_null() && feet["feet"] == fast["feet"]);
    let all = score(&[]);
    assert_eq!(all["ground"], fast["ground"]);
    assert!(all["series"].is_null());
    let series = &score(&["--only", "ground", "--series"])["series"];
    let count = all["frames"].as_u64().unwrap() as usize;
    assert_eq!(series["lowest_skin_cm"].as_array().unwrap().len(), count);
    assert!(series["self_intersection_cm3"].is_null());
    let nothing = physique(&["score", "--only", "self", "--protocol", "sia", &walk]);
    assert_eq!(nothing.status.code(), Some(0), "sia has no groups");
}

#[test]
fn the_floor_is_where_it_is_told_to_be() {
    let folder = folder_of_clips();
    let walk = at(&folder, "walk.bvh");
    let ground = |floor: &str| {
        let json = succeeds(&[
            "score",
            "--json",
            "--without",
            "self",
            "--floor",
            floor,
            &walk,
        ]);
        let report: Value = serde_json::from_str(&json).unwrap();
        let score = &report["motions"][0]["score"];
        let figure = |value: &Value| value.as_f64().unwrap();
        (
            figure(&score["floor_height_m"]),
            figure(&score["ground"]["penetration_worst_cm"]),
        )
    };
    let (zero, sunk) = ground("zero");
    assert!(zero == 0.0 && sunk > 0.0);
    let (lowest, none) = ground("lowest");
    assert!(
        (100.0 * lowest + sunk).abs() < 1e-4 && none < 1e-4,
        "{lowest} {sunk} {none}"
    );
    let (_, humos) = ground("humos-sink");
    assert!((humos - 2.0).abs() < 1e-4, "{humos}");
    let (estimated, _) = ground("estimated");
    assert!(estimated > lowest && estimated < lowest + 0.03);
}

#[test]
fn every_format_says_the_same() {
    let folder = folder_of_clips();
    let clips = folder.path().display().to_string();
    let [json, lines, csv, parquet, frames] =
        ["s.json", "s.jsonl", "s.csv", "s.parquet", "frames.csv"].map(|name| at(&folder, name));
    let common = ["score", "--without", "self", &clips];
    succeeds(&[&common[..], &["-o", &json]].concat());
    succeeds(&[&common[..], &["-o", &lines]].concat());
    succeeds(
        &[
            &common[..],
            &["-o", &csv, "--parquet", &parquet, "--frames", &frames],
        ]
        .concat(),
    );
    let report: Value = serde_json::from_slice(&fs::read(json).unwrap()).unwrap();
    let slide = |motion: &Value| motion["score"]["feet"]["slide_mean_cm_s"].as_f64().unwrap();
    let expected: Vec<f64> = report["motions"]
        .as_array()
        .unwrap()
        .iter()
        .map(slide)
        .collect();
    let lines = fs::read_to_string(lines).unwrap();
    let rows = lines
        .lines()
        .skip(1)
        .map(|line| serde_json::from_str::<Value>(line).unwrap());
    assert_eq!(rows.map(|row| slide(&row)).collect::<Vec<_>>(), expected);
    let mut reader = csv::Reader::from_path(csv).unwrap();
    let names = reader.headers().unwrap().clone();
    let column = names
        .iter()
        .position(|name| name == "feet_slide_mean_cm_s")
        .unwrap();
    let values = reader
        .records()
        .map(|row| row.unwrap()[column].parse::<f64>().unwrap());
    assert_eq!(values.collect::<Vec<_>>(), expected);
    assert!(fs::read(parquet).unwrap().starts_with(b"PAR1"));
    let count: u64 = report["motions"]
        .as_array()
        .unwrap()
        .iter()
        .map(|motion| motion["score"]["frames"].as_u64().unwrap())
        .sum();
    let frames = csv::Reader::from_path(frames)
        .unwrap()
        .into_records()
        .count();
    assert_eq!(frames as u64, count);
    let leftovers = fs::read_dir(folder.path()).unwrap();
    let partial = leftovers.filter(|entry| {
        let name = entry.as_ref().unwrap().file_name();
        name.to_string_lossy().contains("partial")
    });
    assert_eq!(partial.count(), 0, "journals are gone");
}
