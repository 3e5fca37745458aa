//! The other verbs as a user meets them: output, files and exit codes.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use physique::motion::embedded;
use serde_json::Value;

mod support;
use support::{at, folder_of_clips, physique, text};

#[test]
fn view_draws_a_picture() {
    let folder = folder_of_clips();
    let sheet = at(&folder, "sheet.png");
    let output = physique(&[
        "view",
        "--png",
        &sheet,
        "--moments",
        "3",
        &at(&folder, "walk.bvh"),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(is_png(Path::new(&sheet)));
}

#[test]
fn demo_scores_and_draws_real_motion_and_a_generated_one() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("demo");
    let output = physique(&["demo", "-o", &target.display().to_string()]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let scores = fs::read_to_string(target.join("scores.json")).unwrap();
    let report: Value = serde_json::from_str(&scores).unwrap();
    let motions = report["motions"].as_array().unwrap();
    let generated = usize::from(cfg!(feature = "learn"));
    assert_eq!(motions.len(), embedded::clips().len() + generated);
    if generated > 0 {
        let text = "a tired person walks and waves with the left hand";
        assert_eq!(motions[motions.len() - 1]["text"], text);
    }
    for motion in motions {
        let name = motion["file"].as_str().unwrap();
        let picture: PathBuf = target.join(format!("{name}.png"));
        assert!(is_png(&picture), "{name}");
    }
}

fn is_png(path: &Path) -> bool {
    fs::read(path).is_ok_and(|bytes| bytes.starts_with(b"\x89PNG\r\n\x1a\n"))
}
