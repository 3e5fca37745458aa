//! Repair: faults go, everything else stays as good as it was.

use std::sync::LazyLock;

use glam::{Quat, Vec3};
use physique::body::{Body, Joint, Sex, open_body};
use physique::measures::measures;
use physique::motion::{FrameRate, Motion, embedded};
use physique::proxy::open_proxy;
use physique::repair::{Outcome, PROMISE, Targets};
use physique::{MotionScore, RepairOptions, Repaired, Repairer};

static REPAIRER: LazyLock<Repairer> = LazyLock::new(|| {
    let body = Body::mean(open_body().expect("embedded"), Sex::Neutral).expect("mean");
    let proxy = open_proxy().expect("embedded");
    let spheres = proxy.of_body(&body).expect("in range");
    let pairs = proxy.pairs().expect("few");
    Repairer::new(body, spheres, &pairs, RepairOptions::default()).expect("they fit")
});

/// Height that puts the lowest skin of the rest body on the ground.
fn standing() -> Vec3 {
    let vertices = REPAIRER.body().rest_vertices();
    let lowest = vertices
        .iter()
        .map(|vertex| vertex.y)
        .fold(f32::MAX, f32::min);
    Vec3::Y * -lowest
}

fn mean_cm3(score: &MotionScore) -> f64 {
    let found = score.self_intersection.as_ref();
    found.expect("measured").mean_cm3
}

fn embedded(name: &str) -> Motion {
    let clip = embedded::clip(name).expect("embedded");
    clip.load().expect("readable").motion
}

/// What is promised holds, and what is told is what was returned.
fn assert_promise_kept(name: &str, source: &Motion, repaired: &Repaired) {
    let scored = physique::score(&repaired.motion, REPAIRER.body()).expect("scorable");
    assert_eq!(scored, repaired.after, "{name}");
    let after = measures(&repaired.after);
    for (measure, before) in measures(&repaired.before) {
        let Some(promise) = PROMISE.iter().find(|promise| promise.measure == measure) else {
            continue;
        };
        let found = after.iter().find(|(other, _)| *other == measure);
        let (_, after) = found.expect("kept");
        let sign = if promise.greater_is_better { -1.0 } else { 1.0 };
        assert!(
            sign * (after - before) <= promise.allowed(before),
            "{name}: {measure} {before} to {after}"
        );
    }
    let changed = repaired.motion != *source;
    let told = matches!(
        repaired.outcome,
        Outcome::Repaired | Outcome::RepairedInPart
    );
    assert_eq!(changed, told, "{name}: {:?}", repaired.outcome);
}

/// Smooth damage of every joint and the root, always the same for a seed.
fn damaged(source: &Motion, seed: u32, degrees: f32) -> Motion {
    let noise = |place: usize, frame: usize| {
        let phase = (place as f32 * 12.9898 + seed as f32 * 78.233).sin() * 43.758;
        (phase + frame as f32 * 0.15 * (1.0 + 0.1 * phase.sin())).sin()
    };
    let mut rotations = source.rotations().to_vec();
    for (place, rotation) in rotations.iter_mut().enumerate() {
        let (frame, joint) = (place / Joint::COUNT, place % Joint::COUNT);
        let axis = [0, 1, 2].map(|axis| noise(3 * joint + axis, frame));
        let turn = Vec3::from(axis) * degrees.to_radians();
        *rotation = (Quat::from_scaled_axis(turn) * *rotation).normalize();
    }
    let root = source.root_translation().iter().enumerate();
    let root = root.map(|(frame, root)| *root + Vec3::Y * (0.02 * noise(99, frame)));
    Motion::new(source.frame_rate(), None, root.collect(), rotations).expect("finite")
}

#[test]
fn nothing_gets_worse_and_what_is_told_is_what_is_returned() {
    for name in ["jump", "walk", "run"] {
        let source = embedded(name);
        let repaired = REPAIRER.repair(&source).expect("scorable");
        assert_promise_kept(name, &source, &repaired);
    }
}

#[test]
fn nothing_gets_worse_whatever_the_damage() {
    for (seed, degrees) in [(1, 6.0), (2, 12.0), (3, 25.0)] {
        let source = damaged(&embedded("walk"), seed, degrees);
        let repaired = REPAIRER.repair(&source).expect("scorable");
        assert_promise_kept(&format!("walk, damage {seed}"), &source, &repaired);
    }
}

#[test]
fn the_result_is_the_same_for_any_number_of_threads() {
    let source = damaged(&embedded("walk"), 4, 10.0);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("threads");
        pool.install(|| REPAIRER.repair(&source)).expect("scorable")
    };
    let one = with(1);
    assert!(matches!(
        one.outcome,
        Outcome::Repaired | Outcome::RepairedInPart
    ));
    assert_eq!(one, with(3));
}

#[test]
fn sound_motion_stays_as_it_is_to_the_bit() {
    let frames = 40;
    let mut pose = [Quat::IDENTITY; Joint::COUNT];
    pose[Joint::LeftShoulder.index()] = Quat::from_rotation_z(-0.9);
    pose[Joint::RightShoulder.index()] = Quat::from_rotation_z(0.9);
    let rate = FrameRate::new(30.0).expect("a rate");
    let root = vec![standing(); frames];
    let source = Motion::new(rate, None, root, pose.repeat(frames)).expect("finite");
    let repaired = REPAIRER.repair(&source).expect("scorable");
    assert_eq!(repaired.outcome, Outcome::Sound);
    assert_eq!(repaired.motion, source);
    assert_eq!(repaired.change.frames_percent, 0.0);
}

#[test]
fn single_frames_are_repaired_too() {
    let mut pose = [Quat::IDENTITY; Joint::COUNT];
    pose[Joint::LeftShoulder.index()] = Quat::from_rotation_z(-1.2);
    pose[Joint::LeftElbow.index()] = Quat::from_rotation_z(-1.2);
    let rate = FrameRate::new(120.0).expect("a rate");
    for frames in [1, 2, 5] {
        let root = vec![standing(); frames];
        let source = Motion::new(rate, None, root, pose.repeat(frames)).expect("finite");
        let repaired = REPAIRER.repair(&source).expect("scorable");
        assert_promise_kept("folded arm", &source, &repaired);
        let (before, after) = (mean_cm3(&repaired.before), mean_cm3(&repaired.after));
        assert!(after < 0.2 * before, "{frames} frames: {before} to {after}");
    }
}

#[test]
fn only_what_is_asked_for_is_repaired() {
    let body = REPAIRER.body().clone();
    let proxy = open_proxy().expect("embedded");
    let spheres = proxy.of_body(&body).expect("in range");
    let options = RepairOptions {
        targets: Targets {
            self_intersection: false,
            ground: false,
            feet: true,
        },
        ..RepairOptions::default()
    };
    let pairs = proxy.pairs().expect("few");
    let feet_only = Repairer::new(body, spheres, &pairs, options).expect("they fit");
    let source = arm_in_belly();
    let repaired = feet_only.repair(&source).expect("scorable");
    assert_eq!(repaired.outcome, Outcome::Sound);
    assert_eq!(repaired.motion, source);
}

/// A walk over a belt that runs: planted feet are carried along.
#[test]
fn feet_that_slide_slide_less() {
    let walk = embedded("walk");
    let frame_s = walk.frame_rate().frame_seconds() as f32;
    let root = walk.root_translation().iter().enumerate();
    let root = root.map(|(frame, root)| *root + Vec3::X * (0.1 * frame as f32 * frame_s));
    let rotations = walk.rotations().to_vec();
    let source = Motion::new(walk.frame_rate(), None, root.collect(), rotations).expect("finite");
    let repaired = REPAIRER.repair(&source).expect("scorable");
    let slide = |score: &MotionScore| score.feet.as_ref().expect("measured").slide_mean_cm_s;
    let (clean, before, after) = (
        slide(&physique::score(&walk, REPAIRER.body()).expect("scorable")),
        slide(&repaired.before),
        slide(&repaired.after),
    );
    assert!(before > clean + 3.0, "{clean} {before}");
    assert!(
        after < before - 0.6 * (before - clean),
        "{clean}: {before} to {after}, {:?}",
        repaired.held_back_by
    );
}

/// Stands for eight seconds and slowly lays the left forearm across the belly, a little too deep.
fn arm_in_belly() -> Motion {
    let frames = 240;
    let mut rotations = Vec::new();
    for frame in 0..frames {
        let swing = (std::f32::consts::PI * frame as f32 / (frames - 1) as f32).sin();
        let mut pose = [Quat::IDENTITY; Joint::COUNT];
        pose[Joint::LeftShoulder.index()] = Quat::from_rotation_z(-1.1);
        pose[Joint::RightShoulder.index()] = Quat::from_rotation_z(1.1);
        pose[Joint::LeftElbow.index()] = Quat::from_rotation_z(-0.85 * swing * swing);
        rotations.extend(pose);
    }
    let rate = FrameRate::new(30.0).expect("a rate");
    Motion::new(rate, None, vec![standing(); frames], rotations).expect("finite")
}

#[test]
fn an_arm_is_taken_out_of_the_belly_and_the_legs_stay() {
    let source = arm_in_belly();
    let repaired = REPAIRER.repair(&source).expect("scorable");
    let (before, after) = (mean_cm3(&repaired.before), mean_cm3(&repaired.after));
    assert!(before > 20.0, "{before}");
    assert!(
        after < 0.1 * before,
        "{before} to {after}, {:?}",
        repaired.held_back_by
    );
    for frame in 0..source.frame_count() {
        for joint in Joint::LEGS.iter().flatten() {
            let turn = repaired.motion.frame_rotations(frame)[joint.index()]
                .angle_between(source.frame_rotations(frame)[joint.index()]);
            assert!(turn < 0.05, "{joint} turned by {turn} in frame {frame}");
        }
    }
}

#[test]
fn a_sunken_body_is_lifted() {
    let frames = 30;
    let mut pose = [Quat::IDENTITY; Joint::COUNT];
    pose[Joint::LeftShoulder.index()] = Quat::from_rotation_z(-1.0);
    pose[Joint::RightShoulder.index()] = Quat::from_rotation_z(1.0);
    let root = vec![standing() - 0.03 * Vec3::Y; frames];
    let rate = FrameRate::new(30.0).expect("a rate");
    let source = Motion::new(rate, None, root, pose.repeat(frames)).expect("finite");
    let repaired = REPAIRER.repair(&source).expect("scorable");
    let depth = |score: &MotionScore| score.ground.as_ref().expect("measured").penetration_mean_cm;
    assert!((depth(&repaired.before) - 3.0).abs() < 0.01);
    assert!(depth(&repaired.after) < 0.2, "{}", depth(&repaired.after));
}

#[test]
fn nothing_of_no_strength() {
    let body = Body::mean(open_body().expect("embedded"), Sex::Neutral).expect("mean");
    let proxy = open_proxy().expect("embedded");
    let spheres = proxy.of_body(&body).expect("in range");
    let options = RepairOptions {
        strength: 0.0,
        ..RepairOptions::default()
    };
    let refused = Repairer::new(body, spheres, &proxy.pairs().expect("few"), options);
    let message = refused.err().expect("no strength").to_string();
    assert!(message.contains("positive number; found 0"), "{message}");
}
