//! `physique convert` as a user meets it.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

use physique::body::Joint;
use physique::motion::features::JointPositions;
use physique::motion::mapping::BodyRest;
use physique::motion::{
    FrameRate, Motion, ReadOptions, SourceMotion, UpAxis, bvh, csv, features, read_motion,
};
use serde_json::Value;

mod support;
use support::{at, body, fails, motion, succeeds, write_bvh};

fn mean_score(file: &str) -> f64 {
    let report: Value = serde_json::from_str(&succeeds(&["score", "--json", file])).unwrap();
    let score = &report["motions"][0]["score"];
    score["self_intersection"]["mean_cm3"].as_f64().unwrap()
}

/// An embedded clip as its BVH file is read: a frame time of 0.033332 s counts as 30 fps.
fn as_read(name: &str) -> Motion {
    let clip = motion(name);
    let rate = FrameRate::new(clip.frame_rate().per_second().round()).unwrap();
    let (root, rotations) = (clip.root_translation().to_vec(), clip.rotations().to_vec());
    Motion::new(rate, None, root, rotations).unwrap()
}

/// A folder of three clips in two folders.
fn recordings() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, clip) in [("a/walk", "walk"), ("a/run", "run"), ("b/walk", "walk")] {
        write_bvh(&folder.path().join(format!("in/{name}.bvh")), clip);
    }
    folder
}

#[test]
fn every_format_with_rotations_scores_as_before() {
    let folder = tempfile::tempdir().unwrap();
    write_bvh(&folder.path().join("dance.bvh"), "dance");
    let dance = at(&folder, "dance.bvh");
    let original = mean_score(&dance);
    for ending in ["bvh", "npz", "motion.npz"] {
        let target = at(&folder, &format!("converted.{ending}"));
        assert_eq!(succeeds(&["convert", &dance, &target]).trim(), target);
        let converted = mean_score(&target);
        // BVH keeps six decimals of degrees and centimetres; the others are exact.
        assert!(
            (converted / original - 1.0).abs() < 5e-3,
            "{ending}: {original} {converted}"
        );
    }
    let glb = at(&folder, "converted.glb");
    succeeds(&["convert", &dance, &glb]);
    assert!(fs::read(&glb).unwrap().starts_with(b"glTF"));
}

#[test]
fn features_and_positions_are_at_20_fps_and_say_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    write_bvh(&folder.path().join("walk.bvh"), "walk");
    let walk = at(&folder, "walk.bvh");
    let npy = at(&folder, "walk.npy");
    let complaint = fails(1, &["convert", &walk, &npy]);
    assert!(
        complaint.contains("--to 263, kit or positions"),
        "{complaint}"
    );
    let twenty = as_read("walk")
        .resampled(FrameRate::new(20.0).unwrap())
        .unwrap();
    let expected = JointPositions::from_motion(&twenty, &BodyRest::from(&body())).unwrap();
    let read = || features::read(&npy, &ReadOptions::default()).unwrap();
    succeeds(&["convert", &walk, &npy, "--to", "positions"]);
    let features::JointFile::Positions(found) = read() else {
        panic!("positions were asked for");
    };
    assert_eq!(found.frame_count(), expected.frame_count());
    for (ours, theirs) in found.positions().iter().zip(expected.positions()) {
        assert!(ours.distance(*theirs) < 1e-4, "{ours} {theirs}");
    }
    for (name, columns, rate) in [("263", 263, 20.0), ("kit", 251, 12.5)] {
        succeeds(&["convert", &walk, &npy, "--to", name]);
        let features::JointFile::Features(found) = read() else {
            panic!("features were asked for");
        };
        assert_eq!(found.skeleton().feature_count(), columns);
        assert_eq!(found.frame_rate().per_second(), rate);
    }
}

#[test]
fn text_holds_the_clip_at_its_own_rate_or_the_one_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    write_bvh(&folder.path().join("walk.bvh"), "walk");
    let (walk, text) = (at(&folder, "walk.bvh"), at(&folder, "walk.csv"));
    let original = as_read("walk");
    for arguments in [&[][..], &["--resample", "60"]] {
        succeeds(&[&["convert", &walk, &text], arguments].concat());
        let bytes = fs::read(&text).unwrap();
        let found = csv::parse_positions(&bytes, Path::new(&text), &ReadOptions::default());
        let rate = found.unwrap().frame_rate().per_second();
        let expected = if arguments.is_empty() {
            original.frame_rate().per_second()
        } else {
            60.0
        };
        assert!((rate - expected).abs() < 1e-4, "{rate} {expected}");
    }
    let rotations = at(&folder, "walk.rotations.csv");
    succeeds(&["convert", &walk, &rotations]);
    let bytes = fs::read(&rotations).unwrap();
    assert_eq!(csv::Content::of(&bytes), Some(csv::Content::Rotations));
}

#[test]
fn bvh_takes_axis_and_unit_and_others_refuse_them() {
    let folder = tempfile::tempdir().unwrap();
    write_bvh(&folder.path().join("walk.bvh"), "walk");
    let (walk, other) = (at(&folder, "walk.bvh"), at(&folder, "other.bvh"));
    succeeds(&["convert", &walk, &other, "--up", "z", "--unit", "m"]);
    let options = bvh::BvhOptions::default();
    let (was, is) = (
        bvh::read(&walk, &options).unwrap(),
        bvh::read(&other, &options).unwrap(),
    );
    assert_eq!(is.conversion().up_axis, UpAxis::Z);
    assert!((is.conversion().metres_per_unit - 1.0).abs() < 1e-9);
    for joint in Joint::ALL {
        let place = |clip: &physique::motion::SkeletonClip| {
            clip.pose(5).positions[clip.skeleton().find(joint.name()).unwrap()]
        };
        assert!(place(&was).distance(place(&is)) < 1e-4, "{joint}");
    }
    let complaint = fails(1, &["convert", &walk, &at(&folder, "x.glb"), "--up", "z"]);
    assert!(
        complaint.contains("Y up and metres by definition"),
        "{complaint}"
    );
    fails(2, &["convert", &walk, &other, "--resample", "0"]);
}

#[test]
fn a_folder_is_mirrored_and_a_second_run_keeps_what_is_done() {
    let folder = recordings();
    let (input, output) = (at(&folder, "in"), at(&folder, "out"));
    let convert = |more: &[&str]| {
        succeeds(
            &[
                &["convert", &input, &output, "--to", "csv", "--jobs", "2"],
                more,
            ]
            .concat(),
        )
    };
    assert!(convert(&[]).contains("3 written"));
    let results =
        ["a/walk.csv", "a/run.csv", "b/walk.csv"].map(|name| at(&folder, &format!("out/{name}")));
    let before = results.each_ref().map(|path| fs::read(path).unwrap());
    assert!(convert(&[]).contains("0 written, 3 kept"));
    // A source that changed, a result that was cut off and one that is gone are made again.
    let later = SystemTime::now() + Duration::from_secs(60);
    fs::File::options()
        .write(true)
        .open(at(&folder, "in/a/walk.bvh"))
        .unwrap()
        .set_modified(later)
        .unwrap();
    fs::write(&results[1], &before[1][..before[1].len() / 2]).unwrap();
    fs::remove_file(&results[2]).unwrap();
    assert!(convert(&[]).contains("3 written"));
    assert_eq!(
        results.each_ref().map(|path| fs::read(path).unwrap()),
        before
    );
    // Other settings make all results old; so does --force.
    assert!(convert(&["--stature", "1.5"]).contains("3 written"));
    assert!(convert(&["--stature", "1.5", "--force"]).contains("3 written"));
    // Nothing but results and the memory of the settings is there.
    let files = fs::read_dir(folder.path().join("out")).unwrap();
    let mut files: Vec<_> = files.map(|file| file.unwrap().file_name()).collect();
    files.sort();
    assert_eq!(files, [".physique-convert.csv-of-positions.json", "a", "b"]);
}

#[test]
fn patterns_and_results_inside_the_source_folder() {
    let folder = recordings();
    let (pattern, output) = (at(&folder, "in/**/w*.bvh"), at(&folder, "in/out"));
    assert!(succeeds(&["convert", &pattern, &output, "--to", "bvh"]).contains("2 written"));
    assert!(folder.path().join("in/out/a/walk.bvh").is_file());
    // The results of the first run are no sources of the second.
    let again = succeeds(&["convert", &at(&folder, "in"), &output, "--to", "bvh"]);
    assert!(
        again.contains("1 written") && again.contains("2 kept"),
        "{again}"
    );
    let none = fails(
        1,
        &["convert", &at(&folder, "in/*.abc"), &output, "--to", "bvh"],
    );
    assert!(none.contains("no file matches"), "{none}");
}

#[test]
fn inputs_are_never_replaced_and_clashes_are_refused() {
    let folder = recordings();
    let walk = at(&folder, "in/a/walk.bvh");
    let before = fs::read(&walk).unwrap();
    let input = at(&folder, "in");
    for arguments in [
        vec!["convert", &walk, &walk],
        vec!["convert", &input, &input, "--to", "bvh"],
    ] {
        let complaint = fails(1, &arguments);
        assert!(
            complaint.contains("would be replaced") || complaint.contains("no motion files"),
            "{complaint}"
        );
    }
    assert_eq!(fs::read(&walk).unwrap(), before);
    let other = at(&folder, "in/b/walk.bvh");
    let output = at(&folder, "flat/");
    let complaint = fails(1, &["convert", &walk, &other, &output, "--to", "glb"]);
    assert!(complaint.contains("would both become"), "{complaint}");
    assert!(!Path::new(&output).exists(), "nothing was written");
    let complaint = fails(1, &["convert", &input, &at(&folder, "out")]);
    assert!(complaint.contains("say the format"), "{complaint}");
    let complaint = fails(1, &["convert", &walk, &at(&folder, "converted.fbx")]);
    assert!(complaint.contains(".glb"), "{complaint}");
}

#[test]
fn failures_are_listed_at_the_end_and_the_others_are_converted() {
    let folder = recordings();
    let broken = folder.path().join("in/b/broken.bvh");
    fs::write(&broken, "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0").unwrap();
    let output = at(&folder, "out");
    let complaint = fails(
        1,
        &["convert", &at(&folder, "in"), &output, "--to", "motion"],
    );
    let told = complaint.matches("not converted").count();
    assert!(
        told == 1 && complaint.contains("in/b/broken.bvh: line"),
        "{complaint}"
    );
    for name in ["a/walk", "a/run", "b/walk"] {
        let path = folder.path().join(format!("out/{name}.motion.npz"));
        let found = read_motion(&path, &ReadOptions::default()).unwrap();
        assert!(matches!(found, SourceMotion::Body(_)));
    }
}

#[test]
fn all_motions_of_a_file_go_into_a_folder_of_its_name() {
    let results = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../physique-motion/tests/fixtures/arrays/mdm_results.npy"
    );
    let folder = tempfile::tempdir().unwrap();
    let output = at(&folder, "out");
    let said = succeeds(&["convert", results, &(output.clone() + "/"), "--to", "bvh"]);
    let files = fs::read_dir(folder.path().join("out/mdm_results"))
        .unwrap()
        .count();
    assert!(
        files > 1 && said.contains(&format!("{files} written")),
        "{said}"
    );
    let again = succeeds(&["convert", results, &output, "--to", "bvh"]);
    assert!(
        again.contains(&format!("0 written, {files} kept")),
        "{again}"
    );
    // One of them by its number goes to one file; all of them do not.
    let one = at(&folder, "one.bvh");
    succeeds(&["convert", &format!("{results}#1"), &one]);
    let by_number = fs::read(folder.path().join("out/mdm_results/1.bvh")).unwrap();
    assert_eq!(fs::read(&one).unwrap(), by_number);
    assert!(fails(1, &["convert", results, &one]).contains("#0"));
}
