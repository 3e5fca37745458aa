//! Motions in NumPy arrays, pickles and PyTorch files, told apart by shapes and keys.

#![allow(clippy::unwrap_used)]

use std::path::PathBuf;

use glam::Vec3;
use physique_body::Joint;
use physique_motion::features::{FeatureSkeleton, FeatureStatistics, JointPositions, extract};
use physique_motion::npz::npy_f32;
use physique_motion::{
    Error, FrameRate, NamedMotion, PositionClip, ReadOptions, SourceMotion, parse_motion,
    parse_motions, read_each, read_motion, read_motions,
};

mod support;

fn fixture(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures/arrays")
        .join(name)
}

fn positions(motion: SourceMotion) -> PositionClip {
    match motion {
        SourceMotion::Positions(clip) => clip,
        other => panic!("positions were expected, found {other:?}"),
    }
}

fn walk(frames: usize) -> JointPositions {
    let (motion, body) = (support::walk(frames), support::figure());
    let joints = (0..frames).flat_map(|frame| support::pose(&motion, &body, frame).1);
    let rate = FrameRate::new(20.0).unwrap();
    JointPositions::new(rate, FeatureSkeleton::HumanMl3d, joints.collect()).unwrap()
}

fn flat(positions: &[Vec3]) -> Vec<f32> {
    positions.iter().flat_map(Vec3::to_array).collect()
}

#[test]
fn positions_and_features_are_told_by_their_shape() {
    let walk = walk(30);
    let bytes = npy_f32(&[30, 22, 3], &flat(walk.positions())).unwrap();
    let clip = positions(parse_motion(bytes, "walk.npy", &ReadOptions::default()).unwrap());
    assert_eq!(clip.positions, walk);
    assert!(
        clip.notes[0].contains("20 frames a second"),
        "{:?}",
        clip.notes
    );

    let features = extract(&walk).unwrap();
    let bytes = npy_f32(&[29, 263], features.values()).unwrap();
    let motions = parse_motions(bytes, "walk.npy", &ReadOptions::default()).unwrap();
    let [NamedMotion { name, format, .. }] = motions.as_slice() else {
        panic!("one motion was expected");
    };
    assert_eq!((name.as_str(), *format), ("walk.npy", "HumanML3D features"));
}

#[test]
fn mdm_results_hold_many_motions_with_texts_and_lengths() {
    let path = fixture("mdm_results.npy");
    let motions = read_motions(&path, &ReadOptions::default()).unwrap();
    let names: Vec<_> = motions.iter().map(|motion| motion.name.as_str()).collect();
    let expected = [0, 1, 2, 3].map(|index| format!("mdm_results.npy#{index}"));
    assert_eq!(names, expected);
    let texts: Vec<_> = motions
        .iter()
        .filter_map(|motion| motion.text.as_deref())
        .collect();
    assert_eq!(
        texts,
        [
            "a person walks",
            "a person waits",
            "a person walks",
            "a person waits"
        ]
    );
    for (index, (motion, frames)) in motions.into_iter().zip([6, 4, 6, 2]).enumerate() {
        let clip = positions(motion.motion).positions;
        assert_eq!(clip.frame_count(), frames);
        for frame in 0..frames {
            let wrist = clip.frame(frame)[Joint::RightWrist.index()];
            let ahead = index as f32 + 0.01 * frame as f32;
            assert!(
                wrist.distance(Vec3::new(-0.69, 1.4, ahead - 0.055)) < 1e-6,
                "{wrist}"
            );
        }
    }
}

#[test]
fn one_of_many_is_named_by_its_number() {
    let path = fixture("mdm_results.npy");
    let error = read_motion(&path, &ReadOptions::default()).unwrap_err();
    assert!(
        matches!(error, Error::ManyMotions { found: 4, .. }),
        "{error}"
    );
    let one = fixture("mdm_results.npy#3");
    let clip = positions(read_motion(&one, &ReadOptions::default()).unwrap());
    assert_eq!(clip.positions.frame_count(), 2);
    let error = read_motions(fixture("mdm_results.npy#4"), &ReadOptions::default()).unwrap_err();
    assert!(
        error.to_string().contains("none called mdm_results.npy#4"),
        "{error}"
    );
}

#[test]
fn a_broken_motion_does_not_hide_its_neighbours() {
    let mut values = flat(walk(5).positions()).repeat(3);
    // Motion 1, frame 2, joint 4.
    values[330 + 2 * 66 + 4 * 3] = f32::NAN;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("three.npy");
    std::fs::write(&path, npy_f32(&[3, 5, 22, 3], &values).unwrap()).unwrap();
    let motions = read_each(&path, &ReadOptions::default()).unwrap();
    let read: Vec<bool> = motions.iter().map(|(_, motion)| motion.is_ok()).collect();
    assert_eq!(read, [true, false, true]);
    let error = read_motions(&path, &ReadOptions::default())
        .unwrap_err()
        .to_string();
    for word in ["three.npy", "motion 1", "Frame 2", "left_knee"] {
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn arrays_of_other_shapes_are_told_what_was_expected() {
    let bytes = npy_f32(&[4, 5], &[0.0; 20]).unwrap();
    let error = parse_motions(bytes, "odd.npy", &ReadOptions::default())
        .unwrap_err()
        .to_string();
    for word in ["odd.npy", "[frames][263]", "[frames][22][3]", "[4, 5]"] {
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn normalised_features_are_refused_or_undone() {
    let features = extract(&walk(30)).unwrap();
    // A deviation for each block and a mean of its own for each column, as data sets have.
    let mean: Vec<f32> = (0..263)
        .map(|column| 0.3 + 0.1 * (column as f32).sin())
        .collect();
    let mut deviation = vec![0.12; 263];
    deviation[67..193].fill(0.3);
    deviation[259..].fill(0.36);
    let statistics = FeatureStatistics::new(features.skeleton(), mean, deviation).unwrap();
    let mut values = features.values().to_vec();
    statistics.normalise(&mut values);
    let bytes = npy_f32(&[29, 263], &values).unwrap();
    let error = parse_motion(bytes.clone(), "gen.npy", &ReadOptions::default()).unwrap_err();
    let error = error.to_string();
    assert!(
        error.contains("look normalised") && error.contains("--mean"),
        "{error}"
    );

    let options = ReadOptions {
        statistics: Some(statistics),
        ..ReadOptions::default()
    };
    let clip = positions(parse_motion(bytes, "gen.npy", &options).unwrap());
    let plain = npy_f32(&[29, 263], features.values()).unwrap();
    let expected = positions(parse_motion(plain, "walk.npy", &options).unwrap());
    assert!(
        expected
            .notes
            .iter()
            .any(|note| note.contains("not normalised"))
    );
    let distances = clip
        .positions
        .positions()
        .iter()
        .zip(expected.positions.positions());
    let largest = distances.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(largest < 1e-4, "{largest} m");
}

#[test]
fn a_feature_that_is_no_number_is_named_with_its_joint() {
    let features = extract(&walk(8)).unwrap();
    let mut values = features.values().to_vec();
    values[3 * 263 + 4 + 3 * 3] = f32::NAN;
    let bytes = npy_f32(&[7, 263], &values).unwrap();
    let error = parse_motion(bytes, "nan.npy", &ReadOptions::default())
        .unwrap_err()
        .to_string();
    for word in ["nan.npy", "Frame 3", "position of left_knee, x"] {
        assert!(error.contains(word), "{error}");
    }
}
