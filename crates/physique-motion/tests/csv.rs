//! Motions as text: what is written comes back, and mistakes are named with their line.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use glam::Vec3;
use physique_body::Joint;
use physique_motion::csv::{
    Content, format_positions, format_rotations, parse_positions, parse_rotations,
};
use physique_motion::features::JointPositions;
use physique_motion::{Error, FrameRate, Limits, ReadOptions};

mod support;
use support::{figure, walk};

fn positions() -> JointPositions {
    JointPositions::from_motion(&walk(40), &figure()).unwrap()
}

fn read(text: &str) -> Result<JointPositions, Error> {
    parse_positions(
        text.as_bytes(),
        Path::new("walk.csv"),
        &ReadOptions::default(),
    )
}

#[test]
fn positions_are_those_of_forward_kinematics() {
    let (motion, body) = (walk(40), figure());
    for (frame, joints) in positions().frames().enumerate() {
        let expected = support::pose(&motion, &body, frame).1;
        for (joint, expected) in joints.iter().zip(expected) {
            assert!(joint.distance(expected) < 1e-6);
        }
    }
}

#[test]
fn positions_come_back_to_the_micrometre() {
    let positions = positions();
    let text = format_positions(&positions).unwrap();
    assert_eq!(Content::of(text.as_bytes()), Some(Content::Positions));
    assert!(text.starts_with("time_s,pelvis_x_m,pelvis_y_m,pelvis_z_m,left_hip_x_m,"));
    assert_eq!(text.lines().count(), 1 + positions.frame_count());
    let again = read(&text).unwrap();
    assert_eq!(again.frame_rate(), positions.frame_rate());
    for (ours, theirs) in again.positions().iter().zip(positions.positions()) {
        assert!(ours.distance(*theirs) < 1e-6);
    }
}

#[test]
fn rotations_come_back() {
    let motion = walk(40);
    let pelvis = figure().joint(Joint::Pelvis);
    let text = format_rotations(&motion, pelvis);
    assert_eq!(Content::of(text.as_bytes()), Some(Content::Rotations));
    let options = ReadOptions::default();
    let again = parse_rotations(text.as_bytes(), Path::new("walk.csv"), &options).unwrap();
    assert_eq!(
        (again.name.as_str(), again.rest_pelvis),
        ("walk", Vec3::ZERO)
    );
    for (ours, theirs) in again.motion.rotations().iter().zip(motion.rotations()) {
        assert!(ours.angle_between(*theirs) < 1e-3);
    }
    let places = again.motion.root_translation().iter();
    for (ours, theirs) in places.zip(motion.root_translation()) {
        assert!(ours.distance(*theirs + pelvis) < 1e-6);
    }
}

#[test]
fn rates_follow_from_the_times() {
    for fps in [12.5, 20.0, 29.97, 59.94, 120.0, 240.0] {
        let rate = FrameRate::new(fps).unwrap();
        let motion = walk(7).resampled(rate).unwrap();
        let positions = JointPositions::from_motion(&motion, &figure()).unwrap();
        let again = read(&format_positions(&positions).unwrap()).unwrap();
        assert_eq!(again.frame_rate().per_second(), fps);
    }
}

#[test]
fn mistakes_are_named_with_their_line() {
    let text = format_positions(&positions()).unwrap();
    let line = |number: usize| text.lines().nth(number).unwrap().to_owned();
    let expect = |broken: String, place: &str, found: &str| {
        let error = read(&broken).unwrap_err().to_string();
        assert!(error.contains(place) && error.contains(found), "{error}");
        assert!(error.starts_with("walk.csv"), "{error}");
    };
    let (third, _) = line(3)
        .rsplit_once(',')
        .map(|(a, b)| (a.to_owned(), b.to_owned()))
        .unwrap();
    expect(text.replace(&line(3), &third), "line 4", "found 66");
    expect(
        text.replace(&line(3), &format!("{third},NaN")),
        "line 4",
        "`NaN`",
    );
    expect(
        text.replace(&line(3), &format!("{third},1e99")),
        "line 4",
        "`1e99`",
    );
    expect(
        text.replace(&line(3), &format!("{third},elbow")),
        "line 4",
        "`elbow`",
    );
    expect(text.replace(&line(3), ""), "the times", "even steps");
    expect(
        [line(0), line(1)].join("\n"),
        "the times",
        "give the frame rate",
    );
    expect(line(0), "the times", "none");
    expect(
        String::from_utf8_lossy(b"time_s\n\xff").into_owned(),
        "line 2",
        "a time in seconds",
    );
}

#[test]
fn limits_hold_and_cut_files_never_panic() {
    let text = format_positions(&positions()).unwrap();
    let options = ReadOptions {
        limits: Limits {
            frames: 10,
            ..Limits::default()
        },
        ..ReadOptions::default()
    };
    let limited = parse_positions(text.as_bytes(), Path::new("walk.csv"), &options);
    assert!(matches!(limited, Err(Error::Limit { limit: 10, .. })));
    for end in (0..text.len()).step_by(97) {
        let whole_lines = text[..end].ends_with('\n');
        let cut = read(&text[..end]);
        assert!(cut.is_err() || whole_lines || text[end..].starts_with('\n') || end > 2000);
    }
}
