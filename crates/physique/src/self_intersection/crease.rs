//! Folds of skin between neighbours, told apart from parts that pass through each other.

use glam::Vec3;
use physique_body::Joint;

/// How far a fold reaches from its joint, as a fraction of stature: 12 cm for a stature of 1.7 m,
/// about the radius of a shoulder or groin.
const FOLD_REACH: f32 = 0.07;

/// Whether an overlap of parts `a` and `b` about the point `middle` is a crease.
///
/// * A part with itself or with its neighbour in the kinematic tree (thigh and shin): always.
/// * Parts of the trunk (pelvis to chest) with each other: always.
/// * Parts two bones apart (upper arm and chest): within 7 % of the stature of a joint between
///   them, so that an armpit is a crease and an elbow in the ribs is not.
/// * Anything else is an intersection.
///
/// `joint_position` gives joints in the frame of `middle`; lengths are metres.
pub fn is_crease(
    a: Joint,
    b: Joint,
    middle: Vec3,
    stature: f32,
    joint_position: impl Fn(Joint) -> Vec3,
) -> bool {
    match a.tree_distance(b) {
        0 | 1 => true,
        _ if is_trunk(a) && is_trunk(b) => true,
        2 => joints_between(a, b)
            .into_iter()
            .flatten()
            .any(|joint| joint_position(joint).distance(middle) <= FOLD_REACH * stature),
        _ => false,
    }
}

const fn is_trunk(part: Joint) -> bool {
    matches!(
        part,
        Joint::Pelvis | Joint::Spine1 | Joint::Spine2 | Joint::Spine3
    )
}

/// The two joints that part `a` and `b` hang together by, for parts two bones apart: each bone of
/// the path ends in the joint of its lower part.
fn joints_between(a: Joint, b: Joint) -> [Option<Joint>; 2] {
    let (below, above) = if a > b { (a, b) } else { (b, a) };
    match below.parent() {
        // One above the other: the lower part's joint and its parent's.
        Some(middle) if middle.parent() == Some(above) => [Some(below), Some(middle)],
        // Siblings: the joint of each.
        _ => [Some(below), Some(above)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at_origin(_: Joint) -> Vec3 {
        Vec3::ZERO
    }

    fn crease(a: Joint, b: Joint, distance: f32) -> bool {
        is_crease(a, b, Vec3::X * distance, 1.7, at_origin)
    }

    #[test]
    fn neighbours_fold_anywhere() {
        assert!(crease(Joint::LeftHip, Joint::LeftKnee, 0.3));
        assert!(crease(Joint::Head, Joint::Head, 0.3));
        assert!(crease(Joint::Pelvis, Joint::Spine3, 0.3));
    }

    #[test]
    fn an_armpit_folds_but_an_elbow_in_the_ribs_intersects() {
        assert!(crease(Joint::LeftShoulder, Joint::Spine3, 0.10));
        assert!(!crease(Joint::LeftShoulder, Joint::Spine3, 0.20));
        assert!(!crease(Joint::LeftElbow, Joint::Spine3, 0.0));
        assert!(!crease(Joint::LeftWrist, Joint::RightWrist, 0.0));
    }

    #[test]
    fn the_joints_of_a_path_are_those_of_its_bones() {
        use Joint::{LeftCollar, LeftHip, LeftShoulder, RightHip, Spine3};
        let armpit = joints_between(Spine3, LeftShoulder);
        assert_eq!(armpit, [Some(LeftShoulder), Some(LeftCollar)]);
        let groin = joints_between(LeftHip, RightHip);
        assert_eq!(groin, [Some(RightHip), Some(LeftHip)]);
    }
}
