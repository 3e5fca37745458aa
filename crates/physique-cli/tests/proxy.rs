//! `physique proxy`: fit in small, count pairs, evaluate.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use assert_cmd::Command;

fn physique() -> Command {
    Command::cargo_bin("physique").unwrap()
}

#[test]
fn a_small_fit_from_start_to_table() {
    let folder = tempfile::tempdir().unwrap();
    let proxy = folder.path().join("proxy.safetensors");
    let fit = || {
        let mut command = physique();
        command
            .args(["proxy", "fit", "--body", "open-low", "--spheres", "16"])
            .args([
                "--bodies",
                "3",
                "--points",
                "24000",
                "--step-points",
                "1024",
            ])
            .args(["--epochs", "2", "--joint-epochs", "1", "--beta-range", "1"])
            .arg("-o")
            .arg(&proxy);
        command
    };
    fit().assert().success();
    let first = std::fs::read(&proxy).unwrap();
    // Again: everything is taken from the work folder, and is the same.
    fit().assert().success();
    assert_eq!(std::fs::read(&proxy).unwrap(), first);
    // Another recipe in the same folder is refused, with what to do.
    let output = fit()
        .args(["--seed", "11"])
        .assert()
        .failure()
        .get_output()
        .clone();
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("another work folder"), "{message}");

    // Poses of an embedded clip; the file is renewed in place.
    let clips = concat!(env!("CARGO_MANIFEST_DIR"), "/../physique-motion/assets");
    let output = physique()
        .args([
            "proxy",
            "pairs",
            "--body",
            "open-low",
            "--every",
            "10",
            "--motions",
            clips,
        ])
        .arg("--proxy")
        .arg(&proxy)
        .assert()
        .success()
        .get_output()
        .clone();
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("of 120 pairs"), "{message}");
    assert_ne!(std::fs::read(&proxy).unwrap(), first);
}

#[test]
fn the_embedded_proxy_is_evaluated() {
    let output = physique()
        .args(["proxy", "evaluate", "--bodies", "2", "--json"])
        .assert()
        .success()
        .get_output()
        .clone();
    let evaluation: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(evaluation["spheres"], 192);
    assert_eq!(evaluation["bodies"], 2);
    let mean = evaluation["vertices"]["mean_cm"].as_f64().unwrap();
    assert!(mean > 0.0 && mean < 0.6, "{mean}");

    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("spheres.png");
    let output = physique()
        .args([
            "proxy",
            "evaluate",
            "--bodies",
            "1",
            "--spheres",
            "128",
            "--png",
        ])
        .arg(&picture)
        .assert()
        .success()
        .get_output()
        .clone();
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(
        table.contains("all vertices") && table.contains("left_wrist"),
        "{table}"
    );
    assert!(std::fs::read(&picture).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn what_is_not_embedded_is_said() {
    let output = physique()
        .args(["proxy", "evaluate", "--spheres", "100"])
        .assert()
        .failure()
        .get_output()
        .clone();
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("128, 192 or 256"), "{message}");
}
