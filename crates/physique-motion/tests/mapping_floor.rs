//! The floor of a recording: turned level where it slopes a little, told of where it is uneven.

#![allow(clippy::unwrap_used)]

mod support;

use glam::{Quat, Vec3};
use physique_body::Joint;
use physique_motion::{
    FrameRate, Motion, bvh,
    mapping::{Mapped, MappingOptions, map_to_body},
};
use support::{Rig, figure, largest_distance, largest_turn};

/// A figure that stands in places along X, `height` of the place over the floor, and is carried
/// from one to the next in two frames.
fn stops(height: impl Fn(usize) -> f32) -> Motion {
    let mut translations = Vec::new();
    for stop in 0..8 {
        let at = |stop: usize| Vec3::new(0.6 * stop as f32, height(stop), 0.0);
        translations.extend([at(stop); 10]);
        translations.extend([1.0, 2.0].map(|third| at(stop).lerp(at(stop + 1), third / 3.0)));
    }
    let rotations = vec![Quat::IDENTITY; translations.len() * Joint::COUNT];
    Motion::new(FrameRate::new(30.0).unwrap(), None, translations, rotations).unwrap()
}

/// The motion in a world that is turned about its origin.
fn tilted(motion: &Motion, tilt: Quat) -> Motion {
    let pelvis = figure().joint(Joint::Pelvis);
    let translations = motion.root_translation().iter();
    let translations = translations.map(|&at| tilt * (pelvis + at) - pelvis);
    let mut rotations = motion.rotations().to_vec();
    for rotation in rotations.iter_mut().step_by(Joint::COUNT) {
        *rotation = tilt * *rotation;
    }
    Motion::new(motion.frame_rate(), None, translations.collect(), rotations).unwrap()
}

fn map(motion: &Motion, level_floor: bool) -> Mapped {
    // Not the body's own skeleton, whose motions are left alone.
    let text = Rig::arms_down(45.0).bvh(motion);
    let clip = bvh::parse(text.as_bytes(), "rig.bvh", &bvh::BvhOptions::default()).unwrap();
    let options = MappingOptions {
        level_floor,
        ..MappingOptions::default()
    };
    map_to_body(&clip, &figure(), &options).unwrap()
}

fn says(mapped: &Mapped, words: &str) -> bool {
    mapped.report.notes.iter().any(|note| note.contains(words))
}

#[test]
fn a_floor_that_slopes_a_little_is_turned_level() {
    let truth = stops(|_| 0.0);
    for degrees in [1.0_f32, -0.6] {
        let tilt = Quat::from_rotation_z(degrees.to_radians());
        let recorded = tilted(&truth, tilt);
        let mapped = map(&recorded, true);
        let words = format!("slopes by {:.1} degrees", degrees.abs());
        assert!(says(&mapped, &words), "{}", mapped.report);
        let expected = map(&truth, true).motion;
        let (turn, joint) = largest_turn(&mapped.motion, &expected, &figure());
        assert!(turn < 0.15, "{joint} {turn}");
        let (distance, joint) = largest_distance(&mapped.motion, &expected, &figure());
        assert!(distance < 2e-3, "{joint} {distance}");

        let as_recorded = map(&recorded, false).motion.frame_rotations(0)[0];
        assert!(as_recorded.angle_between(tilt).to_degrees() < 0.1);
    }
}

#[test]
fn a_level_floor_is_left_alone() {
    for rise in [0.0, 0.002] {
        let mapped = map(&stops(|stop| rise * stop as f32), true);
        assert!(!says(&mapped, "slopes"), "{}", mapped.report);
        assert!(!says(&mapped, "uneven"), "{}", mapped.report);
    }
}

#[test]
fn steps_and_ramps_are_told_of_and_kept() {
    // A kerb of 20 cm, and 5 cm at every stop.
    for motion in [
        stops(|stop| if stop < 5 { 0.0 } else { 0.2 }),
        stops(|stop| 0.05 * stop as f32),
    ] {
        let mapped = map(&motion, true);
        assert!(!says(&mapped, "slopes"), "{}", mapped.report);
        assert!(says(&mapped, "the ground is uneven"), "{}", mapped.report);
        let (distance, joint) = largest_distance(&mapped.motion, &motion, &figure());
        assert!(distance < 5e-3, "{joint} {distance}");
    }
}
