//! `physique data`: build, show, recipe.

mod support;

use std::fs;

use support::learning::{CLIPS, path, recipe};
use support::{fails, succeeds};

/// A word for runs besides.
const RUNS: &str = "[words.move.run]\ndoes = [\"runs\"]\n";

#[test]
fn from_a_recipe_to_tables_and_lists() {
    let folder = tempfile::tempdir().unwrap();
    let (recipe, data) = (folder.path().join("mine.toml"), folder.path().join("a.pmd"));
    fs::write(&recipe, self::recipe(0.34, RUNS)).unwrap();
    let build = ["data", "build", path(&recipe), CLIPS, "-o", path(&data)];
    let told = succeeds(&build);
    assert!(told.contains("6 motions found, 3 kept"), "{told}");
    assert!(
        told.contains("4 captions to train with, 1 held out"),
        "{told}"
    );
    assert!(told.contains("2 no-caption"), "{told}");
    assert!(told.contains("1 too-short (run.motion: "), "{told}");

    let json = succeeds(&[&build[..], &["--json"]].concat());
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["found"], 6);
    assert_eq!(
        report["splits"]["test"]["clips"], 2,
        "a clip and its mirror image"
    );
    assert_eq!(report["labels"]["move"]["jump"]["clips"], 2);
    let shown = succeeds(&["data", "show", path(&data), "--json", "--verify"]);
    assert_eq!(shown, json);

    let clips = succeeds(&["data", "show", path(&data), "--clips"]);
    assert!(clips.contains("jump.motion mirrored"), "{clips}");
    let left_out = succeeds(&["data", "show", path(&data), "--left-out"]);
    assert!(
        left_out.contains("get_up.motion: no-caption: No caption"),
        "{left_out}"
    );
}

#[test]
fn recipes_are_listed_and_printed() {
    let list = succeeds(&["data", "recipe"]);
    for name in ["bandai-namco", "100style", "cmu", "humanml3d", "kit"] {
        assert!(list.contains(name), "{list}");
    }
    let text = succeeds(&["data", "recipe", "100style"]);
    assert!(text.contains("[[source]]"), "{text}");
}

#[test]
fn what_cannot_be_built_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("a.pmd");
    let told = fails(1, &["data", "build", "nonsense", CLIPS, "-o", path(&data)]);
    assert!(
        told.contains("nor an embedded recipe: bandai-namco"),
        "{told}"
    );
    let told = fails(1, &["data", "build", "humanml3d", CLIPS, "-o", path(&data)]);
    assert!(told.contains("train.txt"), "{told}");
    let told = fails(1, &["data", "recipe", "nonsense"]);
    assert!(told.contains("no recipe is called"), "{told}");
    fs::write(&data, "PHYSDATA").unwrap();
    let told = fails(1, &["data", "show", path(&data)]);
    assert!(told.contains("expected 64 bytes, found 8 bytes"), "{told}");
}
