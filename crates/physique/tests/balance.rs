//! Whoever takes over a motion keeps its centre of mass over the feet.

use glam::{Quat, Vec3};
use physique::body::{Body, Joint, Sex, open_body};
use physique::motion::mapping::{BodyRest, MappingOptions, map_to_body};
use physique::motion::{FrameRate, Motion, SkeletonClip};
use physique::physics::{Physics, PhysicsOptions};

/// Joints above the waist.
fn is_above_waist(joint: Joint) -> bool {
    let mut at = Some(joint);
    while let Some(joint) = at {
        if joint == Joint::Spine1 {
            return true;
        }
        at = joint.parent();
    }
    false
}

/// A figure whose trunk is shorter: hips and legs are the body's.
fn short_trunk(body: &Body) -> BodyRest {
    let mut short = BodyRest::from(body);
    let waist = short.joint(Joint::Spine1).y;
    for joint in Joint::ALL
        .into_iter()
        .filter(|&joint| is_above_waist(joint))
    {
        let height = &mut short.joints[joint.index()].y;
        *height = waist + 0.6 * (*height - waist);
    }
    short
}

/// Hips to one side, trunk to the other, feet where they are: the pelvis rolls, legs stay upright,
/// the waist bends back.
fn sway(frames: usize) -> Motion {
    let mut rotations = vec![Quat::IDENTITY; frames * Joint::COUNT];
    for (frame, pose) in rotations.chunks_mut(Joint::COUNT).enumerate() {
        let roll = 0.1 * (frame as f32 * 0.4).sin();
        pose[Joint::Pelvis.index()] = Quat::from_rotation_z(roll);
        for joint in [Joint::LeftHip, Joint::RightHip] {
            pose[joint.index()] = Quat::from_rotation_z(-roll);
        }
        pose[Joint::LeftShoulder.index()] = Quat::from_rotation_z(-1.3);
        pose[Joint::RightShoulder.index()] = Quat::from_rotation_z(1.3);
    }
    let rate = FrameRate::new(30.0).unwrap();
    Motion::new(rate, None, vec![Vec3::ZERO; frames], rotations).unwrap()
}

/// Where the source's mass is from side to side: segments of de Leva's masses, half-way along.
fn source_centre(positions: &[Vec3]) -> f32 {
    let at = |joint: Joint| positions[joint.index()].x;
    let middle = |left: Joint| (at(left) + at(left.mirrored())) / 2.0;
    let trunk = [
        middle(Joint::LeftHip),
        at(Joint::Pelvis),
        at(Joint::Spine1),
        at(Joint::Spine2),
        at(Joint::Spine3),
        middle(Joint::LeftShoulder),
    ];
    let segment = |from: Joint, to: Joint| (middle(from) + middle(to)) / 2.0;
    0.43 * trunk.iter().sum::<f32>() / 6.0
        + 0.07 * at(Joint::Head)
        + 0.053 * segment(Joint::LeftShoulder, Joint::LeftElbow)
        + 0.042 * segment(Joint::LeftElbow, Joint::LeftWrist)
        + 0.289 * segment(Joint::LeftHip, Joint::LeftKnee)
        + 0.091 * segment(Joint::LeftKnee, Joint::LeftAnkle)
        + 0.025 * middle(Joint::LeftAnkle)
}

/// From the least to the greatest.
fn range(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
}

#[test]
fn a_longer_trunk_does_not_sway_its_mass_further_than_the_source() {
    let body = Body::mean(open_body().unwrap(), Sex::Neutral).unwrap();
    let clip = SkeletonClip::from_motion(&sway(60), &short_trunk(&body)).unwrap();
    let physics = Physics::new(&body).unwrap();
    let swing = |options: &MappingOptions| {
        let mapped = map_to_body(&clip, &BodyRest::from(&body), options).unwrap();
        let found = physics.measure(&mapped.motion, &PhysicsOptions::default());
        let frames = found.unwrap().frames;
        range(frames.iter().map(|frame| frame.centre_of_mass.x))
    };
    let poses: Vec<_> = (0..60).map(|frame| clip.pose(frame)).collect();
    let source = range(
        poses
            .iter()
            .map(|pose| f64::from(source_centre(&pose.positions))),
    );
    let kept = swing(&MappingOptions::default());
    assert!((kept - source).abs() < 0.25 * source, "{kept} {source}");
    // With hips where the source has them, the longer trunk takes the centre along.
    let by_hips = swing(&MappingOptions {
        plant_feet: false,
        ..MappingOptions::default()
    });
    assert!(by_hips > 1.4 * source, "{by_hips} {source}");
}
