//! `physique train` and `physique generate`: from clips to a network to motions.
#![cfg(feature = "learn")]

mod support;

use std::fs;
use std::path::Path;

use support::learning::{CLIPS, PLAN, path, recipe};
use support::{fails, succeeds};

/// A folder with a data file and a plan.
fn prepared() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("recipe.toml"), recipe(0.0, "")).unwrap();
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

    // The same plan in two goes: the same losses.
    let again = at("again");
    let train = ["train", "mdm", "--data", path(&data), "-o", path(&again)];
    let first = ["--plan", path(&plan), "--sample-every", "0", "--steps", "2"];
    succeeds(&[&train[..], &first].concat());
    succeeds(&[&train[..], &["--sample-every", "0", "--steps", "4"]].concat());
    assert_eq!(losses(&run).len(), 4);
    assert_eq!(losses(&run), losses(&again));

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

/// Losses of all steps of a run.
fn losses(run: &Path) -> Vec<f64> {
    let log = fs::read_to_string(run.join("log.jsonl")).unwrap();
    let lines = log.lines().map(|line| serde_json::from_str(line).unwrap());
    lines
        .map(|line: serde_json::Value| line["loss"].as_f64().unwrap())
        .collect()
}

#[test]
fn a_run_starts_from_a_trained_network() {
    let folder = prepared();
    let at = |name: &str| folder.path().join(name);
    let (data, plan, first) = (at("data.pmd"), at("plan.toml"), at("first"));
    let arguments = |run: &Path, flags: &[&str]| -> Vec<String> {
        let all = ["train", "mdm", "--data", path(&data), "-o", path(run)];
        let all = all.iter().chain(&["--sample-every", "0"]).chain(flags);
        all.map(|&argument| argument.to_owned()).collect()
    };
    fn borrowed(arguments: &[String]) -> Vec<&str> {
        arguments.iter().map(String::as_str).collect()
    }
    let train = |run: &Path, flags: &[&str]| succeeds(&borrowed(&arguments(run, flags)));
    let refused = |run: &Path, flags: &[&str]| fails(1, &borrowed(&arguments(run, flags)));
    train(&first, &["--plan", path(&plan)]);
    let model = first.join("model");

    // The shape comes with the network.
    let tuned = at("tuned");
    let sia = ["--self-intersection", "0.01", "--batch", "2"];
    let steps = ["--steps", "4", "--save-every", "2"];
    let start = ["--start-from", path(&model)];
    train(&tuned, &[&start[..], &sia, &steps].concat());
    let kept = fs::read_to_string(tuned.join("plan.json")).unwrap();
    let kept: serde_json::Value = serde_json::from_str(&kept).unwrap();
    assert_eq!(kept["network"]["width"], 16);
    assert_eq!(kept["training"]["diffusion_steps"], 10);
    assert_eq!(kept["started_from"]["path"], path(&model));
    assert_eq!(kept["started_from"]["sha256"].as_str().unwrap().len(), 64);
    let card = fs::read_to_string(tuned.join("model/CARD.md")).unwrap();
    assert!(card.contains("* started_from: "), "{card}");

    // Killed after its first checkpoint, without the network that it started from; and before it could
    // keep that: the same losses.
    let whole = losses(&tuned);
    assert_eq!(whole.len(), 1, "of the last step");
    let forget = |steps: &[u64]| {
        for step in steps {
            fs::remove_file(tuned.join(format!("state-{step:09}.safetensors"))).unwrap();
        }
    };
    forget(&[2, 4]);
    fs::rename(&model, at("moved")).unwrap();
    train(&tuned, &[]);
    assert_eq!(losses(&tuned), whole);
    forget(&[0, 2, 4]);
    assert!(refused(&tuned, &[]).contains(path(&model)));
    fs::rename(at("moved"), &model).unwrap();
    train(&tuned, &start);
    assert_eq!(losses(&tuned), whole);

    // Another network, another shape, another text encoder.
    let other = first.join("state-000000002.safetensors");
    let told = refused(&tuned, &["--start-from", path(&other)]);
    assert!(told.contains("holds a run that started from"), "{told}");
    let told = refused(&at("new"), &[&start[..], &["--plan", "small"]].concat());
    assert!(told.contains("model, the network's "), "{told}");
    let told = refused(&at("new"), &[&start[..], &["--text", "none"]].concat());
    let expected = "was trained with the text encoder all-MiniLM-L6-v2";
    assert!(told.contains(expected), "{told}");
    assert!(!at("new").exists());
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
