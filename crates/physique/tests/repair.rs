//! Repair: faults go, everything else stays as good as it was.

use std::sync::LazyLock;

use glam::{Quat, Vec3};
use physique::body::{Body, Joint, Sex, open_body};
use physique::measures::measures;
use physique::motion::{FrameRate, Motion, embedded};
use physique::proxy::open_proxy;
use physique::repair::PROMISE;
use physique::{MotionScore, RepairOptions, Repairer};

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

/// Real motion: what is promised holds, and what is told is what was returned.
#[test]
fn nothing_gets_worse_and_what_is_told_is_what_is_returned() {
    for name in ["jump", "walk"] {
        let clip = embedded::clip(name);
        let source = clip.expect("embedded").load().expect("readable").motion;
        let repaired = REPAIRER.repair(&source).expect("scorable");
        let scored = physique::score(&repaired.motion, REPAIRER.body()).expect("scorable");
        assert_eq!(scored, repaired.after, "{name}");
        let after = measures(&repaired.after);
        for (measure, before) in measures(&repaired.before) {
            let Some(promise) = PROMISE.iter().find(|promise| promise.measure == measure) else {
                continue;
            };
            let (_, after) = after
                .iter()
                .find(|(other, _)| *other == measure)
                .expect("kept");
            let sign = if promise.greater_is_better { -1.0 } else { 1.0 };
            let most = promise.relative * before.abs() + promise.absolute;
            assert!(
                sign * (after - before) <= most,
                "{name}: {measure} {before} to {after}"
            );
        }
    }
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
    assert!(depth(&repaired.after) < 0.5, "{}", depth(&repaired.after));
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
