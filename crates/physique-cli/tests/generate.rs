//! `physique generate` by the embedded network.
#![cfg(feature = "learn")]

mod support;

use std::fs;

use support::learning::path;
use support::{fails, physique, text};

const BOTH: &str = "a person runs and raises both hands";

/// Texts that tell two things at once are divided, and it is said; what they are divided into may be
/// given by hand.
#[test]
fn two_things_at_once_are_divided() {
    let folder = tempfile::tempdir().unwrap();
    let made = |name: &str, asked: &[&str]| {
        let file = folder.path().join(name);
        let few = ["--seconds", "1", "--steps", "5", "--to", "positions", "-o"];
        let output = physique(&[&["generate"], asked, &few, &[path(&file)]].concat());
        let told = text(&output.stderr);
        assert!(output.status.success(), "{told}");
        (fs::read(&file).unwrap(), told)
    };
    let (divided, told) = made("divided.npy", &[BOTH]);
    let legs = "legs as \"a person runs\", trunk and arms as \"a person raises both hands\"";
    assert!(told.contains(legs), "{told}");
    let by_hand = [
        "a person runs",
        "--upper-body",
        "a person raises both hands",
    ];
    let (by_hand, told) = made("by-hand.npy", &by_hand);
    assert_eq!(divided, by_hand);
    assert!(!told.contains("two things"), "{told}");
    let (undivided, told) = made("undivided.npy", &[BOTH, "--undivided"]);
    assert!(!told.contains("two things"), "{told}");
    let (legs, _) = made("legs.npy", &["a person runs"]);
    assert!(divided != undivided && divided != legs);
}

#[test]
fn parts_of_a_known_motion_leave_no_room_for_others() {
    let folder = tempfile::tempdir().unwrap();
    let (known, out) = (
        folder.path().join("walk.bvh"),
        folder.path().join("out.npy"),
    );
    support::write_bvh(&known, "dance");
    let from = ["--from", path(&known), "--keep", "legs", "-o", path(&out)];
    let asked = [
        "generate",
        "a person runs",
        "--upper-body",
        "a person waves",
    ];
    let told = fails(2, &[&asked[..], &from].concat());
    assert!(told.contains("--upper-body"), "{told}");
    assert!(!out.exists());
}

/// Networks inside the program go by name, whatever folders there are.
#[test]
fn embedded_networks_go_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let made = |name: &str, asked: &[&str]| {
        let file = folder.path().join(name);
        let text = ["generate", "a person walks", "-o", path(&file)];
        let few = ["--seconds", "1", "--steps", "3", "--to", "positions"];
        let output = assert_cmd::Command::cargo_bin("physique")
            .unwrap()
            .args([&text[..], &few, asked].concat())
            .current_dir(folder.path())
            .output()
            .unwrap();
        let told = support::text(&output.stderr);
        assert!(output.status.success(), "{told}");
        (fs::read(&file).unwrap(), told)
    };
    let (default, _) = made("default.npy", &[]);
    let (small, told) = made("small.npy", &["--model", "mdm-small"]);
    assert_eq!(default, small);
    assert!(!told.contains("folder"), "{told}");
    fs::create_dir(folder.path().join("mdm-small-free")).unwrap();
    let (free, told) = made("free.npy", &["--model", "mdm-small-free"]);
    assert_ne!(free, small);
    assert!(
        told.contains("./mdm-small-free would be the folder"),
        "{told}"
    );
    let out = folder.path().join("none.npy");
    let other = ["--model", "mdm-huge", "--to", "positions", "-o", path(&out)];
    let told = fails(1, &[&["generate", "a person walks"][..], &other].concat());
    let expected = "mdm-huge: expected mdm-small, mdm-small-free, a folder";
    assert!(told.contains(expected), "{told}");
    assert!(!out.exists());
}
