//! A T-pose that a mapping file gives tells what the axes of a rig mean.

#![allow(clippy::unwrap_used)]

mod support;

use std::{fmt::Write as _, path::Path};

use glam::Quat;
use physique_body::Joint;
use physique_motion::{
    bvh,
    mapping::{AlignedBy, Mapped, MappingOptions, NameTable, map_to_body},
};
use support::{Rig, figure, largest_turn, walk};

/// A rig whose zero pose is no human pose.
fn rig() -> Rig {
    Rig::bones_along(glam::Vec3::Y, glam::Vec3::X, true)
}

/// Maps the rig's walk with a mapping file of nothing but this T-pose.
fn map_with(world_from_joint: impl Fn(Joint) -> Option<Quat>) -> Mapped {
    let mut text = String::from("[t_pose]\n");
    for joint in Joint::ALL {
        if let Some(rotation) = world_from_joint(joint) {
            let [x, y, z, w] = rotation.to_array();
            writeln!(text, "{joint} = [{x:.5}, {y:.5}, {z:.5}, {w:.5}]").unwrap();
        }
    }
    let options = MappingOptions {
        table: Some(NameTable::parse(&text, Path::new("map.toml")).unwrap()),
        share_wrist_twist: false,
        ..MappingOptions::default()
    };
    let text = rig().bvh(&walk(60));
    let clip = bvh::parse(text.as_bytes(), "rig.bvh", &bvh::BvhOptions::default()).unwrap();
    map_to_body(&clip, &figure(), &options).unwrap()
}

/// The body rests in a T-pose with its joints level: the rig's joints are then turned so.
fn true_t_pose(joint: Joint) -> Quat {
    rig().joint_from_body[joint.index()].inverse()
}

#[test]
fn a_known_t_pose_gives_the_motion_back() {
    let mapped = map_with(|joint| Some(true_t_pose(joint)));
    assert_eq!(
        mapped.report.aligned_by,
        AlignedBy::KnownTPose,
        "{}",
        mapped.report
    );
    let (turn, joint) = largest_turn(&mapped.motion, &walk(60), &figure());
    assert!(
        turn < 0.2,
        "{joint} is off by {turn} degrees\n{}",
        mapped.report
    );
    // Feet, hips and limbs are seen over the clip, twist and trunk only guessed.
    let guessed = map_with(|_| None);
    assert_eq!(guessed.report.aligned_by, AlignedBy::Anatomy);
    assert!(largest_turn(&guessed.motion, &walk(60), &figure()).0 > 1.0);
}

#[test]
fn a_t_pose_of_another_rig_is_not_believed() {
    let down = Quat::from_rotation_z(-1.2);
    let arms_down = |joint: Joint| {
        let is_left_arm = Joint::ARMS[0][1..].contains(&joint);
        let turn = if is_left_arm { down } else { Quat::IDENTITY };
        Some(turn * true_t_pose(joint))
    };
    let mapped = map_with(arms_down);
    assert_eq!(mapped.report.aligned_by, AlignedBy::Anatomy);
    let notes = mapped.report.notes.join("\n");
    assert!(notes.contains("does not stand with level arms"), "{notes}");
}

#[test]
fn a_t_pose_that_leaves_out_a_human_joint_is_not_believed() {
    let mapped = map_with(|joint| (joint != Joint::Spine2).then(|| true_t_pose(joint)));
    assert_eq!(mapped.report.aligned_by, AlignedBy::Anatomy);
    let notes = mapped.report.notes.join("\n");
    assert!(notes.contains("it says nothing of spine2"), "{notes}");
}
