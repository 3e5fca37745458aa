//! `physique train evaluator` and `physique evaluate`, on a small made-up data set.

#![cfg(feature = "learn")]

mod support;

use std::fs;
use std::path::Path;

use physique::motion::FrameRate;
use physique::motion::features::{
    FeatureSkeleton, JointPositions, MotionFeatures, extract, write_features,
};
use support::learning::{CLIP, PLAN};
use support::{fails, succeeds};

const ACTIONS: [&str; 4] = ["walks", "waves", "sits down", "turns left"];

/// A stick figure that turns, bobs and steps to and fro, faster or slower: every column changes.
fn clip(number: usize) -> MotionFeatures {
    let skeleton = FeatureSkeleton::HumanMl3d;
    let (offsets, parents) = (skeleton.offsets(), skeleton.parents());
    let speed = 0.1 + 0.02 * number as f32;
    let mut positions = Vec::new();
    for frame in 0..61 {
        let start = positions.len();
        let wave = (speed * frame as f32).sin();
        let turn = glam::Quat::from_rotation_y(0.3 * wave);
        for (joint, parent) in parents.iter().enumerate() {
            let sway = glam::Vec3::X * 0.02 * (speed * frame as f32 + joint as f32).sin();
            let place = match parent {
                Some(parent) => positions[start + parent] + turn * (offsets[joint] + sway),
                None => glam::Vec3::new(0.0, 0.95 + 0.02 * wave, 0.3 * wave),
            };
            positions.push(place);
        }
    }
    let rate = FrameRate::new(20.0).unwrap();
    extract(&JointPositions::new(rate, skeleton, positions).unwrap()).unwrap()
}

fn data(folder: &Path) -> String {
    for name in ["new_joint_vecs", "texts"] {
        fs::create_dir_all(folder.join(name)).unwrap();
    }
    let mut lists = [String::new(), String::new()];
    for number in 0..72 {
        let name = format!("{number:06}");
        let file = folder.join("new_joint_vecs").join(format!("{name}.npy"));
        write_features(file, &clip(number)).unwrap();
        let action = ACTIONS[number % 4];
        let text = format!("a person {action} in way {number}#a/DET person/NOUN#0.0#0.0\n");
        fs::write(folder.join("texts").join(format!("{name}.txt")), text).unwrap();
        lists[usize::from(number >= 36)] += &format!("{name}\n");
    }
    fs::write(folder.join("train.txt"), &lists[0]).unwrap();
    fs::write(folder.join("val.txt"), "").unwrap();
    fs::write(folder.join("test.txt"), &lists[1]).unwrap();
    let data = path(&folder.join("small.pmd"));
    succeeds(&["data", "build", "humanml3d", &path(folder), "-o", &data]);
    data
}

fn path(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

#[test]
fn from_data_to_the_row_of_real_motions() {
    let folder = tempfile::tempdir().unwrap();
    let data = data(folder.path());
    let evaluator = path(&folder.path().join("evaluator"));
    let train = [
        "train",
        "evaluator",
        "--data",
        &data,
        "-o",
        &evaluator,
        "--steps",
        "2",
    ];
    let told = succeeds(&train);
    assert_eq!(told.trim_end(), evaluator);

    let json = path(&folder.path().join("out.json"));
    let evaluate = [
        "evaluate",
        "--data",
        &data,
        "--evaluator",
        &evaluator,
        "--repetitions",
        "2",
        "--json",
        &json,
        "--body",
        "open-low",
    ];
    let told = succeeds(&evaluate);
    let rows: Vec<_> = told.lines().filter(|line| line.contains('±')).collect();
    assert_eq!(rows.len(), 1, "{told}");
    assert!(rows[0].starts_with("Real"), "{told}");
    assert!(
        told.contains(
            "Real: 32 real motions: FID is biased upwards; 32 pairs for diversity; 2 repetitions."
        ),
        "{told}"
    );
    let report: serde_json::Value = serde_json::from_slice(&fs::read(&json).unwrap()).unwrap();
    assert_eq!(report["data"]["clips"], 36);
    assert_eq!(report["seed"], 10);
    assert_eq!(report["evaluation"]["body"], "open-low");
    assert_eq!(report["evaluation"]["protocol"]["repetitions"], 2);
    let row = &report["evaluation"]["rows"][0];
    assert_eq!(row["motions"], 32);
    assert_eq!(row["fid"]["repetitions"], 2);
    assert_eq!(row["self_intersection_cm3"]["half_width"], 0.0);
    assert!(
        report["evaluation"]["evaluator"]
            .as_str()
            .unwrap()
            .contains("data humanml3d")
    );
    // Done: nothing is left to go on with.
    let partial = folder.path().join("out.json.partial");
    assert!(!partial.exists());

    // Repetitions that an earlier run made are taken over; those of another one are not.
    let first = succeeds(&evaluate);
    assert_eq!(first, told);
    fs::write(&partial, "{\"settings\":\"others\",\"row\":\"Real\",\"measures\":{\"repetition\":0,\"motions\":32,\"real_motions\":32,\"diversity_pairs\":32,\"r_precision\":[0,0,0],\"multimodal_distance\":0,\"fid\":0,\"diversity\":0,\"multimodality\":null,\"self_intersection_cm3\":null}}\n").unwrap();
    let told = fails(1, &evaluate);
    assert!(
        told.contains("out.json.partial: belongs to an evaluation with other settings"),
        "{told}"
    );
}

#[test]
fn what_is_missing_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let data = data(folder.path());
    let told = fails(2, &["evaluate", "--data", &data]);
    assert!(told.contains("--evaluator"), "{told}");
    let told = fails(1, &["evaluate", "--data", &data, "--evaluator", &data]);
    assert!(told.contains("needs --glove, --mean and --std"), "{told}");
    let told = fails(
        1,
        &[
            "evaluate",
            "--data",
            &data,
            "--evaluator",
            &path(folder.path()),
        ],
    );
    assert!(told.contains("config.json"), "{told}");
    let told = fails(1, &["evaluate", "--data", &data, "--judge", "content"]);
    assert!(told.contains("Known motions"), "{told}");
}

/// Networks that CLIP reads for: the encoder is asked for, and taken from the flags.
#[test]
fn networks_are_evaluated_with_their_own_encoder() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| path(&folder.path().join(name));
    let data = data(folder.path());
    fs::write(folder.path().join("plan.toml"), PLAN).unwrap();
    let run = at("run");
    let train = ["train", "mdm", "--data", &data, "-o", &run, "--text", CLIP];
    let plan = ["--plan", &at("plan.toml"), "--sample-every", "0"];
    succeeds(&[&train[..], &plan].concat());
    let evaluator = at("evaluator");
    let train = ["train", "evaluator", "--data", &data, "-o", &evaluator];
    succeeds(&[&train[..], &["--steps", "1"]].concat());

    let model = at("run/model");
    let evaluate = ["evaluate", "--data", &data, "--evaluator", &evaluator];
    let less = [
        "--repetitions",
        "1",
        "--multimodality",
        "0",
        "--motions",
        "32",
    ];
    let less = [&less[..], &["--no-self-intersection", "--steps", "2"]].concat();
    let evaluate = [&evaluate[..], &less, &["--model", &model]].concat();
    let told = fails(1, &evaluate);
    assert!(
        told.contains("trained with the text encoder CLIP; say where it lies"),
        "{told}"
    );
    let told = fails(1, &[&evaluate[..], &["--text", "minilm"]].concat());
    assert!(
        told.contains("--text FOLDER|FILE, found all-MiniLM-L6-v2"),
        "{told}"
    );
    let told = succeeds(&[&evaluate[..], &["--text", "minilm", "--text", CLIP]].concat());
    assert!(told.lines().any(|line| line.starts_with("model")), "{told}");

    // A published file has its data set's statistics; this one is of six columns.
    let published = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../physique-learn/tests/fixtures/checkpoints/flat.pt"
    );
    let evaluate = [
        "evaluate",
        "--data",
        &data,
        "--evaluator",
        &evaluator,
        "--model",
        published,
    ];
    let told = fails(1, &[&evaluate[..], &["--text", CLIP]].concat());
    assert!(
        told.contains("expected 6 columns, as the network has"),
        "{told}"
    );

    let out = at("out.bvh");
    let generate = [
        "generate",
        "a person walks",
        "-o",
        &out,
        "--model",
        &model,
        "--steps",
        "2",
    ];
    let told = fails(1, &generate);
    assert!(told.contains("text encoder CLIP"), "{told}");
    let told = fails(
        1,
        &[&generate[..], &["--text", CLIP, "--after", &out]].concat(),
    );
    assert!(told.contains("makes whole motions"), "{told}");
    succeeds(&[&generate[..], &["--text", CLIP, "--seconds", "2"]].concat());
}
