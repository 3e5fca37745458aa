//! Alignment from a pose of the source in which a person stands straight.

use glam::{Quat, Vec3};
use physique_body::Joint;

use super::{alignment::LIMB_BONES, axes::swing, body_rest::BodyRest, figure::Figure};

/// `joint_from_body` by source joint, from a standing pose.
///
/// Trunk, head and collars of the body are at rest in that pose. Each bone of a limb swings the
/// shortest way from rest to where the source's bone points, carried along by the bone above: an
/// arm of an A-pose is a T-pose's arm let down. Feet stand flat and point as the source's do.
pub(super) fn joint_from_body(
    source: &Figure<'_>,
    world_from_figure: Quat,
    body: &BodyRest,
) -> Vec<Quat> {
    let figure_from_world = world_from_figure.inverse();
    let mut figure_from_body = [Quat::IDENTITY; Joint::COUNT];
    for (joint, child) in LIMB_BONES {
        let parent = joint
            .parent()
            .map_or(Quat::IDENTITY, |parent| figure_from_body[parent.index()]);
        let (Some(from), Some(to)) = (source.human.source_of(joint), source.human.source_of(child))
        else {
            figure_from_body[joint.index()] = parent;
            continue;
        };
        let bone = figure_from_world * (source.at(to) - source.at(from));
        let carried = parent * body.bone(joint, child);
        figure_from_body[joint.index()] = swing(carried, bone) * parent;
    }
    for (ankle, foot, limbs) in [
        (Joint::LeftAnkle, Joint::LeftFoot, &source.human.left),
        (Joint::RightAnkle, Joint::RightFoot, &source.human.right),
    ] {
        let bone = source
            .ball(limbs)
            .map_or(Vec3::ZERO, |ball| ball - source.at(limbs.ankle));
        let bone = figure_from_world * bone;
        let heading = Vec3::new(bone.x, 0.0, bone.z);
        let turn = swing(body.foot_heading(ankle), heading);
        figure_from_body[ankle.index()] = turn;
        figure_from_body[foot.index()] = turn;
    }
    for (wrist, elbow) in [
        (Joint::LeftWrist, Joint::LeftElbow),
        (Joint::RightWrist, Joint::RightElbow),
    ] {
        figure_from_body[wrist.index()] = figure_from_body[elbow.index()];
    }

    // Joints that are none of the body's stay upright with the trunk.
    let mut joint_from_body: Vec<Quat> = source
        .pose
        .rotations
        .iter()
        .map(|world_from_joint| world_from_joint.inverse() * world_from_figure)
        .collect();
    for joint in Joint::ALL {
        if let Some(index) = source.human.source_of(joint) {
            joint_from_body[index] *= figure_from_body[joint.index()];
        }
    }
    joint_from_body
}
