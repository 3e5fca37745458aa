//! DeepMimic's files: axes, joints, timing, and broken files.

#![allow(clippy::unwrap_used)]

use std::f32::consts::FRAC_PI_2;

use glam::Vec3;
use physique_motion::deep_mimic::{self, JOINTS};
use physique_motion::{Error, FrameRate, Limits, ReadOptions, SkeletonClip};
use proptest::prelude::*;

/// A row that stands upright at (1, 0.85, 2) and faces +X, as DeepMimic does.
fn standing(duration: f64) -> [f64; 44] {
    let mut row = [0.0; 44];
    row[0] = duration;
    (row[1], row[2], row[3]) = (1.0, 0.85, 2.0);
    for at in [4, 8, 12, 16, 21, 25, 30, 35, 39] {
        row[at] = 1.0;
    }
    row
}

fn text(rows: &[[f64; 44]]) -> String {
    let rows: Vec<Vec<f64>> = rows.iter().map(|row| row.to_vec()).collect();
    format!(r#"{{"Loop": "wrap", "Frames": {rows:?}}}"#)
}

fn parse(text: &str) -> Result<SkeletonClip, Error> {
    deep_mimic::parse(text.as_bytes(), "walk.txt", &ReadOptions::default())
}

fn position(clip: &SkeletonClip, frame: usize, name: &str) -> Vec3 {
    clip.pose(frame).positions[clip.skeleton().find(name).unwrap()]
}

#[test]
fn standing_faces_z_with_the_left_at_x() {
    let clip = parse(&text(&[standing(0.02), standing(0.0)])).unwrap();
    assert_eq!(clip.frame_count(), 2);
    assert_eq!(clip.frame_rate().per_second(), 50.0);
    // DeepMimic's +X is our +Z, its +Z our -X.
    let near = |name, expected: Vec3| {
        let found = position(&clip, 0, name);
        assert!(
            found.distance(expected) < 1e-6,
            "{name}: {found}, not {expected}"
        );
    };
    near("root", Vec3::new(-2.0, 0.85, 1.0));
    near("left_hip", Vec3::new(-2.0 + 0.084_887, 0.85, 1.0));
    near(
        "right_ankle",
        Vec3::new(-2.0 - 0.084_887, 0.85 - 0.831_416, 1.0),
    );
    near(
        "left_wrist",
        Vec3::new(
            -2.0 + 0.183_11,
            0.85 + 0.479_651 - 0.533_735,
            1.0 - 0.024_05,
        ),
    );
    let ankle = clip.skeleton().find("left_ankle").unwrap();
    let toe = clip.skeleton().joints()[ankle].end_sites[0];
    assert!(toe.z > 0.1, "toes point forward: {toe}");
}

#[test]
fn every_column_moves_the_joint_it_should() {
    // A lateral axis in DeepMimic's +Z is our -X; a turn about it by a right angle takes down to
    // forward at elbows (positive) and to backward at knees (negative).
    let mut row = standing(0.02);
    row[29] = f64::from(FRAC_PI_2);
    row[34] = -f64::from(FRAC_PI_2);
    let clip = parse(&text(&[row, row])).unwrap();
    let forearm = position(&clip, 0, "right_wrist") - position(&clip, 0, "right_elbow");
    assert!(
        forearm.distance(Vec3::new(0.0, 0.0, 0.258_947)) < 1e-6,
        "{forearm}"
    );
    let shank = position(&clip, 0, "left_ankle") - position(&clip, 0, "left_knee");
    assert!(
        shank.distance(Vec3::new(0.0, 0.0, -0.409_870)) < 1e-6,
        "{shank}"
    );

    // Each quaternion column turns its own joint and nothing else.
    for (name, column) in [
        ("root", 4),
        ("chest", 8),
        ("neck", 12),
        ("right_hip", 16),
        ("right_ankle", 21),
        ("right_shoulder", 25),
        ("left_hip", 30),
        ("left_ankle", 35),
        ("left_shoulder", 39),
    ] {
        let mut row = standing(0.02);
        // A right angle about DeepMimic's vertical: the same about ours.
        (row[column], row[column + 2]) = (2.0, 2.0);
        let clip = parse(&text(&[row, row])).unwrap();
        for (joint, &found) in JOINTS.iter().enumerate() {
            let (axis, angle) = clip.rotation(0, joint).to_axis_angle();
            let expected = if found == name { FRAC_PI_2 } else { 0.0 };
            assert!(
                (angle * axis.y - expected).abs() < 1e-6,
                "{name}: {}",
                JOINTS[joint]
            );
        }
    }
}

#[test]
fn varying_durations_are_resampled_at_the_shortest() {
    let mut rows = [standing(0.1), standing(0.3), standing(0.1), standing(0.0)];
    for (row, x) in rows.iter_mut().zip([0.0, 1.0, 4.0, 5.0]) {
        row[1] = x;
    }
    let clip = parse(&text(&rows)).unwrap();
    assert_eq!(clip.frame_count(), 6);
    for frame in 0..6 {
        // 10 m/s all the way.
        let z = position(&clip, frame, "root").z;
        assert!((z - frame as f32).abs() < 1e-5, "{frame}: {z}");
    }
    assert!(clip.conversion().notes[0].contains("resampled"));
}

#[test]
fn a_single_frame_takes_the_frame_rate_given() {
    assert!(
        parse(&text(&[standing(0.0)]))
            .unwrap_err()
            .to_string()
            .contains("option")
    );
    let options = ReadOptions {
        frame_rate: Some(FrameRate::new(30.0).unwrap()),
        ..ReadOptions::default()
    };
    let clip = deep_mimic::parse(text(&[standing(0.0)]).as_bytes(), "a", &options).unwrap();
    assert!((clip.frame_rate().per_second() - 30.0).abs() < 1e-9);
}

#[test]
fn broken_files_say_where() {
    let mut no_rotation = standing(0.1);
    no_rotation[16] = 0.0;
    let mut backward = standing(0.1);
    backward[0] = -0.1;
    for (text, expected) in [
        (String::new(), "line 1"),
        ("{}".into(), "Frames"),
        (r#"{"Frames": []}"#.into(), "at least one frame"),
        (
            r#"{"Frames": [[0.1, 2, 3]]}"#.into(),
            "frame 0: expected 44 numbers",
        ),
        (r#"{"Frames": [[NaN]]}"#.into(), "line 1"),
        (r#"{"Frames": [[1e999]]}"#.into(), "line 1"),
        (text(&[standing(0.1), no_rotation]), "frame 1, right_hip"),
        (text(&[backward]), "frame 0, duration"),
    ] {
        let error = parse(&text).unwrap_err().to_string();
        assert!(
            error.contains(expected) && error.contains("walk.txt"),
            "{error}"
        );
    }
}

#[test]
fn too_many_frames_whether_written_or_resampled() {
    let options = ReadOptions {
        limits: Limits {
            frames: 100,
            ..Limits::default()
        },
        ..ReadOptions::default()
    };
    let written = text(&[standing(0.1); 200]);
    // A microsecond beside a day: resampling would make 86 thousand million frames.
    let resampled = text(&[standing(1e-6), standing(86_400.0), standing(0.0)]);
    for text in [written, resampled] {
        let error = deep_mimic::parse(text.as_bytes(), "a", &options).unwrap_err();
        assert!(matches!(error, Error::Limit { limit: 100, .. }), "{error}");
    }
}

#[test]
fn every_truncation_is_an_error() {
    let text = text(&[standing(0.1); 3]);
    for length in (0..text.len()).step_by(5) {
        assert!(parse(&text[..length]).is_err(), "{length}");
    }
}

proptest! {
    #[test]
    fn any_numbers_are_read_or_refused(
        rows in prop::collection::vec(prop::collection::vec(any::<f64>(), 44), 1..4)
    ) {
        let text = format!(r#"{{"Frames": {rows:?}}}"#);
        if let Ok(clip) = parse(&text) {
            prop_assert!(clip.pose(0).rotations.iter().all(|rotation| rotation.is_finite()));
        }
    }
}
