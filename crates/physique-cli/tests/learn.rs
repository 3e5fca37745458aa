//! `physique train` and `physique generate`: from clips to a network to motions.
#![cfg(feature = "learn")]

mod support;

use std::fs;
use std::path::Path;

use support::{fails, succeeds};

const RECIPE: &str = r#"
name = "embedded"
licence = "zlib"
attribution = "DeepMimic"
mirror = true
[windows]
shortest = 1.0
longest = 9.8
[split]
test = 0.0
validation = 0.0
[[source]]
files = "{move}.motion.npz"
[words.move.walk]
does = ["walks"]
[words.move.jump]
does = ["jumps", "leaps"]
held_out.does = ["hops"]
[words.move.dance]
does = ["dances"]
[[caption]]
text = "a person {move.does}"
"#;

const PLAN: &str = r#"
[network]
width = 16
layers = 1
heads = 2
feed_forward = 32
mask_frames = true
frames_per_token = 2
[training]
batch = 2
diffusion_steps = 10
[run]
steps = 4
save_every = 2
log_every = 1
average = 0.9
[windows]
longest_seconds = 2.0
"#;

const CLIPS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../physique-motion/assets");

fn path(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A folder with a data file and a plan.
fn prepared() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("recipe.toml"), RECIPE).unwrap();
    fs::write(at("plan.toml"), PLAN).unwrap();
    let (recipe, data) = (at("recipe.toml"), at("data.pmd"));
    succeeds(&["data", "build", path(&recipe), CLIPS, "-o", path(&data)]);
    folder
}

#[test]
fn a_run_leaves_a_network_that_generates() {
    let folder = prepared();
    let at = |name: &str| folder.path().join(name);
    let (data, plan, run, model) = (at("data.pmd"), at("plan.toml"), at("run"), at("run/model"));
    let train = ["train", "mdm", "--data", path(&data), "-o", path(&run)];
    let trained = succeeds(&[&train[..], &["--plan", path(&plan), "--sample-every", "2"]].concat());
    assert_eq!(trained.trim(), path(&model));
    for file in [
        "plan.json",
        "log.jsonl",
        "state-000000004.safetensors",
        "samples/step-000000004/0.png",
        "model/CARD.md",
        "model/config.json",
    ] {
        assert!(run.join(file).exists(), "{file}");
    }
    let card = fs::read_to_string(run.join("model/CARD.md")).unwrap();
    assert!(card.contains("* licence: zlib"), "{card}");
    let log = fs::read_to_string(run.join("log.jsonl")).unwrap();

    // The same plan in two goes: the same losses.
    let again = at("again");
    let train = ["train", "mdm", "--data", path(&data), "-o", path(&again)];
    let first = ["--plan", path(&plan), "--sample-every", "0", "--steps", "2"];
    succeeds(&[&train[..], &first].concat());
    succeeds(&[&train[..], &["--sample-every", "0", "--steps", "4"]].concat());
    let losses = |log: &str| -> Vec<f64> {
        let lines = log.lines().map(|line| serde_json::from_str(line).unwrap());
        lines
            .map(|line: serde_json::Value| line["loss"].as_f64().unwrap())
            .collect()
    };
    let other = fs::read_to_string(again.join("log.jsonl")).unwrap();
    assert_eq!(losses(&log).len(), 4);
    assert_eq!(losses(&log), losses(&other));

    let motion = at("walk.npy");
    let generate = [
        "generate",
        "a person walks",
        "--model",
        path(&model),
        "--seconds",
        "2",
    ];
    let to = ["-o", path(&motion), "--to", "positions", "--png"];
    let told = succeeds(&[&generate[..], &to].concat());
    assert!(told.contains("40 frames on the open body"), "{told}");
    assert!(at("walk.png").exists());
    let first = fs::read(&motion).unwrap();
    succeeds(&[&generate[..], &to].concat());
    assert_eq!(fs::read(&motion).unwrap(), first, "the same seed");
    succeeds(&[&generate[..], &to, &["--seed", "1"]].concat());
    assert_ne!(fs::read(&motion).unwrap(), first, "another seed");

    // In 16 bits the network is half as large, and does nearly the same.
    let packed = at("packed");
    succeeds(&["train", "pack", path(&model), "-o", path(&packed)]);
    let size = |folder: &Path| {
        fs::metadata(folder.join("model.safetensors"))
            .unwrap()
            .len()
    };
    assert!(size(&packed) < size(&model) * 6 / 10);
    assert!(packed.join("CARD.md").exists());
    let by_packed = at("packed.glb");
    let from_packed = ["--model", path(&packed), "-o", path(&by_packed)];
    succeeds(&[&["generate", "a person walks"], &from_packed[..]].concat());

    // Many motions go into a folder; legs of another motion stay.
    let many = at("many");
    let to = [
        "a person jumps",
        "-n",
        "2",
        "-o",
        path(&many),
        "--to",
        "bvh",
        "--ddim",
        "--steps",
        "5",
    ];
    let json = succeeds(&[&generate[..], &to, &["--json"]].concat());
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["motions"].as_array().unwrap().len(), 4);
    assert_eq!(report["motions"][3]["text"], "a person jumps");
    assert!(many.join("003-a-person-jumps.bvh").exists());
    let edited = at("edited.bvh");
    let from = many.join("003-a-person-jumps.bvh");
    let keep = ["--from", path(&from), "--keep", "legs", "-o", path(&edited)];
    succeeds(&[&generate[..], &keep].concat());
    assert!(edited.exists());
}

#[test]
fn what_cannot_be_trained_or_generated_is_told() {
    let folder = prepared();
    let at = |name: &str| folder.path().join(name);
    let (data, plan, run, model) = (at("data.pmd"), at("plan.toml"), at("run"), at("run/model"));
    let train = ["train", "mdm", "--data", path(&data), "-o", path(&run)];
    let told = fails(1, &[&train[..], &["--plan", "huge"]].concat());
    assert!(told.contains("published, fast, kit, small"), "{told}");
    succeeds(&[&train[..], &["--plan", path(&plan), "--sample-every", "0"]].concat());
    let told = fails(1, &[&train[..], &["--plan", "fast"]].concat());
    assert!(told.contains("holds a run with another plan"), "{told}");

    let out = at("out.glb");
    let generate = ["generate", "a person walks", "-o", path(&out), "--model"];
    let told = fails(1, &[&generate[..], &[path(&at("nowhere"))]].concat());
    assert!(told.contains("nowhere"), "{told}");
    let told = fails(
        1,
        &[&generate[..], &[path(&model), "--seconds", "0"]].concat(),
    );
    assert!(told.contains("--seconds"), "{told}");
    let told = fails(
        1,
        &[&generate[..], &[path(&model), "--steps", "11"]].concat(),
    );
    assert!(told.contains("2 to 10 of the network's steps"), "{told}");
    fs::write(model.join("model.safetensors"), "broken").unwrap();
    let told = fails(1, &[&generate[..], &[path(&model)]].concat());
    assert!(told.contains("model.safetensors"), "{told}");
    assert!(!out.exists());
}
