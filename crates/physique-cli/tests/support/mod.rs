//! Running the command, and clips for it.

#![allow(dead_code, unreachable_pub, clippy::unwrap_used)] // Every test file uses some of it.

pub mod learning;

use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use physique::body::{Body, Sex, open_body};
use physique::load::load_recording;
use physique::motion::bvh::{BvhWriteOptions, write_clip};
use physique::motion::{Motion, SkeletonClip, embedded};

pub fn physique(arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("physique").unwrap();
    command.args(arguments).output().unwrap()
}

/// The command with exit code 0; what it printed.
pub fn succeeds(arguments: &[&str]) -> String {
    let output = physique(arguments);
    let complaint = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {complaint}");
    text(&output.stdout)
}

/// The command with this exit code; what it printed on standard error.
pub fn fails(code: i32, arguments: &[&str]) -> String {
    let output = physique(arguments);
    let complaint = text(&output.stderr);
    assert_eq!(
        output.status.code(),
        Some(code),
        "{arguments:?}: {complaint}"
    );
    complaint
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

pub fn body() -> Body {
    Body::mean(open_body().unwrap(), Sex::Neutral).unwrap()
}

/// An embedded clip on the mean body.
pub fn motion(name: &str) -> Motion {
    let recording = embedded::clip(name).unwrap().load().unwrap();
    load_recording(recording, &body()).unwrap().motion
}

/// An embedded clip as BVH.
pub fn write_bvh(path: &Path, name: &str) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let clip = SkeletonClip::from_motion(&motion(name), &(&body()).into()).unwrap();
    write_clip(path, &clip, &BvhWriteOptions::default()).unwrap();
}

/// Joins, for arguments.
pub fn at(folder: &tempfile::TempDir, name: &str) -> String {
    folder.path().join(name).display().to_string()
}

/// A folder with the embedded dance and walk as BVH.
pub fn folder_of_clips() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["dance", "walk"] {
        write_bvh(&folder.path().join(format!("{name}.bvh")), name);
    }
    folder
}
