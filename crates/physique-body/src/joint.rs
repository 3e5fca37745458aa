//! The 22 body joints in SMPL's order.

use std::fmt;

/// A body joint, in the order of SMPL, SMPL-H, SMPL-X and HumanML3D.
///
/// The order is topological: a parent comes before its children. `left` is the body's own left,
/// which lies at +X when the body faces +Z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
#[allow(missing_docs)] // The names are the documentation.
pub enum Joint {
    Pelvis,
    LeftHip,
    RightHip,
    Spine1,
    LeftKnee,
    RightKnee,
    Spine2,
    LeftAnkle,
    RightAnkle,
    Spine3,
    LeftFoot,
    RightFoot,
    Neck,
    LeftCollar,
    RightCollar,
    Head,
    LeftShoulder,
    RightShoulder,
    LeftElbow,
    RightElbow,
    LeftWrist,
    RightWrist,
}

use Joint::{
    Head, LeftAnkle, LeftCollar, LeftElbow, LeftFoot, LeftHip, LeftKnee, LeftShoulder, LeftWrist,
    Neck, Pelvis, RightAnkle, RightCollar, RightElbow, RightFoot, RightHip, RightKnee,
    RightShoulder, RightWrist, Spine1, Spine2, Spine3,
};

impl Joint {
    /// Number of body joints.
    pub const COUNT: usize = 22;

    /// All joints, in order.
    #[rustfmt::skip]
    pub const ALL: [Self; Self::COUNT] = [
        Pelvis, LeftHip, RightHip, Spine1, LeftKnee, RightKnee, Spine2, LeftAnkle, RightAnkle,
        Spine3, LeftFoot, RightFoot, Neck, LeftCollar, RightCollar, Head, LeftShoulder,
        RightShoulder, LeftElbow, RightElbow, LeftWrist, RightWrist,
    ];

    /// Parent of each joint by index; the pelvis has none.
    #[rustfmt::skip]
    pub const PARENTS: [Option<Self>; Self::COUNT] = [
        None, Some(Pelvis), Some(Pelvis), Some(Pelvis), Some(LeftHip), Some(RightHip),
        Some(Spine1), Some(LeftKnee), Some(RightKnee), Some(Spine2), Some(LeftAnkle),
        Some(RightAnkle), Some(Spine3), Some(Spine3), Some(Spine3), Some(Neck), Some(LeftCollar),
        Some(RightCollar), Some(LeftShoulder), Some(RightShoulder), Some(LeftElbow),
        Some(RightElbow),
    ];

    /// Hip, knee, ankle and ball of the foot: of the left leg, then of the right.
    pub const LEGS: [[Self; 4]; 2] = [
        [LeftHip, LeftKnee, LeftAnkle, LeftFoot],
        [RightHip, RightKnee, RightAnkle, RightFoot],
    ];

    /// Collar, shoulder, elbow and wrist: of the left arm, then of the right.
    pub const ARMS: [[Self; 4]; 2] = [
        [LeftCollar, LeftShoulder, LeftElbow, LeftWrist],
        [RightCollar, RightShoulder, RightElbow, RightWrist],
    ];

    /// What stands over the soles: both ankles, then both balls of the feet.
    pub const FEET: [Self; 4] = [LeftAnkle, RightAnkle, LeftFoot, RightFoot];

    /// The joint's place in SMPL's order.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The joint at `index`, if there are that many.
    pub fn from_index(index: usize) -> Option<Self> {
        Self::ALL.get(index).copied()
    }

    /// Parent in the kinematic tree; `None` for the pelvis.
    pub const fn parent(self) -> Option<Self> {
        Self::PARENTS[self.index()]
    }

    /// The same joint on the other side; joints of the midline are their own mirror.
    pub const fn mirrored(self) -> Self {
        match self {
            LeftHip => RightHip,
            RightHip => LeftHip,
            LeftKnee => RightKnee,
            RightKnee => LeftKnee,
            LeftAnkle => RightAnkle,
            RightAnkle => LeftAnkle,
            LeftFoot => RightFoot,
            RightFoot => LeftFoot,
            LeftCollar => RightCollar,
            RightCollar => LeftCollar,
            LeftShoulder => RightShoulder,
            RightShoulder => LeftShoulder,
            LeftElbow => RightElbow,
            RightElbow => LeftElbow,
            LeftWrist => RightWrist,
            RightWrist => LeftWrist,
            midline => midline,
        }
    }

    /// Number of bones between two joints along the kinematic tree.
    pub fn tree_distance(self, other: Self) -> u8 {
        let (mut a, mut b, mut distance) = (self, other, 0);
        // Parents have smaller indices, so the larger of two different joints is never the root.
        while a != b {
            let (below, above) = if a > b { (a, b) } else { (b, a) };
            a = below.parent().unwrap_or(Pelvis);
            b = above;
            distance += 1;
        }
        distance
    }

    /// The name that SMPL-family files and tools use.
    #[rustfmt::skip]
    pub const fn name(self) -> &'static str {
        match self {
            Pelvis => "pelvis", LeftHip => "left_hip", RightHip => "right_hip",
            Spine1 => "spine1", LeftKnee => "left_knee", RightKnee => "right_knee",
            Spine2 => "spine2", LeftAnkle => "left_ankle", RightAnkle => "right_ankle",
            Spine3 => "spine3", LeftFoot => "left_foot", RightFoot => "right_foot",
            Neck => "neck", LeftCollar => "left_collar", RightCollar => "right_collar",
            Head => "head", LeftShoulder => "left_shoulder", RightShoulder => "right_shoulder",
            LeftElbow => "left_elbow", RightElbow => "right_elbow",
            LeftWrist => "left_wrist", RightWrist => "right_wrist",
        }
    }

    /// The part of the body that this joint moves first, in everyday words.
    #[rustfmt::skip]
    pub const fn part_name(self) -> &'static str {
        match self {
            Pelvis => "pelvis", LeftHip => "left thigh", RightHip => "right thigh",
            Spine1 => "abdomen", LeftKnee => "left shin", RightKnee => "right shin",
            Spine2 => "waist", LeftAnkle => "left foot", RightAnkle => "right foot",
            Spine3 => "chest", LeftFoot => "left toes", RightFoot => "right toes",
            Neck => "neck", LeftCollar => "left shoulder", RightCollar => "right shoulder",
            Head => "head", LeftShoulder => "left upper arm", RightShoulder => "right upper arm",
            LeftElbow => "left forearm", RightElbow => "right forearm",
            LeftWrist => "left hand", RightWrist => "right hand",
        }
    }
}

impl fmt::Display for Joint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::Joint;

    #[test]
    fn order_is_topological_and_indices_agree() {
        for (index, joint) in Joint::ALL.into_iter().enumerate() {
            assert_eq!(joint.index(), index);
            assert_eq!(Joint::from_index(index), Some(joint));
            assert!(joint.parent().is_none_or(|parent| parent < joint));
        }
        assert_eq!(Joint::from_index(Joint::COUNT), None);
    }

    #[test]
    fn mirror_is_an_involution_that_keeps_the_tree() {
        for joint in Joint::ALL {
            assert_eq!(joint.mirrored().mirrored(), joint);
            assert_eq!(
                joint.mirrored().parent(),
                joint.parent().map(Joint::mirrored)
            );
            assert_eq!(
                joint.name().replace("left", "*").replace("right", "*"),
                joint
                    .mirrored()
                    .name()
                    .replace("left", "*")
                    .replace("right", "*")
            );
        }
    }

    #[test]
    fn limbs_are_chains_of_the_tree_and_mirror_each_other() {
        for limbs in [Joint::LEGS, Joint::ARMS] {
            assert_eq!(limbs[0].map(Joint::mirrored), limbs[1]);
            for limb in limbs {
                for bone in limb.windows(2) {
                    assert_eq!(bone[1].parent(), Some(bone[0]));
                }
            }
        }
        for foot in Joint::FEET {
            assert!(Joint::LEGS.iter().any(|leg| leg[2..].contains(&foot)));
        }
    }

    #[test]
    fn tree_distance_counts_bones() {
        assert_eq!(Joint::Pelvis.tree_distance(Joint::Pelvis), 0);
        assert_eq!(Joint::LeftKnee.tree_distance(Joint::LeftHip), 1);
        assert_eq!(Joint::LeftHip.tree_distance(Joint::RightHip), 2);
        assert_eq!(Joint::LeftWrist.tree_distance(Joint::RightWrist), 8);
        assert_eq!(Joint::Head.tree_distance(Joint::LeftFoot), 9);
    }
}
