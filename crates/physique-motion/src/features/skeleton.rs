//! The two skeletons of the feature data sets.

use glam::Vec3;

/// Which skeleton joints and features belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FeatureSkeleton {
    /// HumanML3D: SMPL's 22 body joints in [`physique_body::Joint`]'s order, metres, left at +X.
    HumanMl3d,
    /// KIT-ML: 21 joints in units of about 1/600 m, mirrored: a body that faces +Z has its left at
    /// **-X**.
    Kit,
}

/// What the pipeline knows of a skeleton. Indices are joints.
pub(super) struct Definition {
    /// From the root or the chest to a tip; order matters.
    pub(super) chains: &'static [&'static [usize]],
    /// Direction of each bone, seen from its parent, when rotations are the identity.
    pub(super) directions: &'static [Vec3],
    /// Lengths of the bones of the clip that all others are brought to.
    pub(super) bone_lengths: &'static [f32],
    /// Right hip, left hip, right shoulder, left shoulder, as listed by the data set. For KIT the
    /// names are exchanged, which its mirrored X axis makes up for.
    pub(super) face: [usize; 4],
    /// The bones whose lengths give the scale.
    pub(super) leg: [usize; 2],
    /// Joints of the contact columns: first pair, second pair.
    pub(super) feet: [usize; 4],
    /// Squared distance a frame below which a foot is at rest.
    pub(super) contact_threshold: f32,
    /// The same joint on the other side.
    pub(super) mirrored: &'static [usize],
    pub(super) names: &'static [&'static str],
    pub(super) frames_per_second: f64,
}

impl FeatureSkeleton {
    /// Both skeletons.
    pub const ALL: [Self; 2] = [Self::HumanMl3d, Self::Kit];

    /// Number of joints: 22 or 21.
    pub const fn joint_count(self) -> usize {
        match self {
            Self::HumanMl3d => 22,
            Self::Kit => 21,
        }
    }

    /// Numbers a frame of its features: 263 or 251.
    pub const fn feature_count(self) -> usize {
        // 3 + 1 of the root, 3 + 6 a joint but the root, 3 a joint, 4 contacts.
        12 * self.joint_count() - 1
    }

    /// Frames a second of its data set: 20 or 12.5.
    pub const fn frames_per_second(self) -> f64 {
        self.definition().frames_per_second
    }

    /// Metres of one unit of length: KIT's is about 1/600 m.
    pub const fn metres_per_unit(self) -> f64 {
        match self {
            Self::HumanMl3d => 1.0,
            Self::Kit => 1.0 / 600.0,
        }
    }

    /// The joints that the four contact columns are of: ankle and toes of one side, then of the
    /// other.
    pub const fn foot_joints(self) -> [usize; 4] {
        self.definition().feet
    }

    /// The name of a joint, if there is one of this index.
    pub fn joint_name(self, joint: usize) -> Option<&'static str> {
        self.definition().names.get(joint).copied()
    }

    /// From the parent to each joint for identity rotations, in the data set's unit: the
    /// directions are along the axes, the lengths those of the data set's one common skeleton.
    pub fn offsets(self) -> Vec<Vec3> {
        let definition = self.definition();
        definition
            .directions
            .iter()
            .zip(definition.bone_lengths)
            .map(|(&way, &length)| way * length)
            .collect()
    }

    /// Parent of each joint; `None` for the root.
    pub fn parents(self) -> Vec<Option<usize>> {
        let mut parents = vec![None; self.joint_count()];
        for [parent, joint] in self.bones() {
            parents[joint] = Some(parent);
        }
        parents
    }

    /// Parent and joint of every bone, in the order of the chains.
    pub(super) fn bones(self) -> impl Iterator<Item = [usize; 2]> {
        self.definition()
            .chains
            .iter()
            .flat_map(|chain| links(chain))
    }

    pub(super) const fn definition(self) -> &'static Definition {
        match self {
            Self::HumanMl3d => &HUMAN_ML3D,
            Self::Kit => &KIT,
        }
    }
}

/// Upper and lower joint of every bone of a chain.
pub(super) fn links(chain: &[usize]) -> impl Iterator<Item = [usize; 2]> {
    let lower = chain.iter().skip(1);
    chain
        .iter()
        .zip(lower)
        .map(|(&above, &joint)| [above, joint])
}

const O: Vec3 = Vec3::ZERO;
const X: Vec3 = Vec3::X;
const Y: Vec3 = Vec3::Y;
const Z: Vec3 = Vec3::Z;
const WEST: Vec3 = Vec3::NEG_X;
const DOWN: Vec3 = Vec3::NEG_Y;

#[rustfmt::skip]
static HUMAN_ML3D: Definition = Definition {
    chains: &[
        &[0, 2, 5, 8, 11], &[0, 1, 4, 7, 10], &[0, 3, 6, 9, 12, 15], &[9, 14, 17, 19, 21],
        &[9, 13, 16, 18, 20],
    ],
    directions: &[
        O, X, WEST, Y, DOWN, DOWN, Y, DOWN, DOWN, Y, Z, Z, Y, X, WEST, Z, DOWN, DOWN, DOWN, DOWN,
        DOWN, DOWN,
    ],
    bone_lengths: &[
        0.0, 0.103_074, 0.109_883, 0.131_568, 0.393_623, 0.390_188, 0.143_190, 0.432_433,
        0.425_643, 0.057_365, 0.143_382, 0.149_419, 0.219_360, 0.137_487, 0.143_383, 0.103_039,
        0.131_614, 0.122_984, 0.256_840, 0.263_092, 0.266_012, 0.269_876,
    ],
    face: [2, 1, 17, 16],
    leg: [5, 8],
    feet: [7, 10, 8, 11],
    contact_threshold: 0.002,
    mirrored: &[
        0, 2, 1, 3, 5, 4, 6, 8, 7, 9, 11, 10, 12, 14, 13, 15, 17, 16, 19, 18, 21, 20,
    ],
    names: &[
        "pelvis", "left_hip", "right_hip", "spine1", "left_knee", "right_knee", "spine2",
        "left_ankle", "right_ankle", "spine3", "left_foot", "right_foot", "neck", "left_collar",
        "right_collar", "head", "left_shoulder", "right_shoulder", "left_elbow", "right_elbow",
        "left_wrist", "right_wrist",
    ],
    frames_per_second: 20.0,
};

#[rustfmt::skip]
static KIT: Definition = Definition {
    chains: &[
        &[0, 11, 12, 13, 14, 15], &[0, 16, 17, 18, 19, 20], &[0, 1, 2, 3, 4], &[3, 5, 6, 7],
        &[3, 8, 9, 10],
    ],
    directions: &[
        O, Y, Y, Y, Y, X, DOWN, DOWN, WEST, DOWN, DOWN, X, DOWN, DOWN, Z, Z, WEST, DOWN, DOWN, Z, Z,
    ],
    bone_lengths: &[
        0.0, 80.0, 120.0, 44.0, 30.0, 110.0, 188.0, 145.0, 110.0, 188.0, 145.0, 52.0, 245.0, 246.0,
        30.2736, 56.2892, 52.0, 245.0, 246.0, 30.2736, 56.2872,
    ],
    face: [11, 16, 5, 8],
    leg: [17, 18],
    feet: [19, 20, 14, 15],
    contact_threshold: 0.05,
    mirrored: &[
        0, 1, 2, 3, 4, 8, 9, 10, 5, 6, 7, 16, 17, 18, 19, 20, 11, 12, 13, 14, 15,
    ],
    names: &[
        "root", "BP", "BT", "BLN", "BUN", "LS", "LE", "LW", "RS", "RE", "RW", "LH", "LK", "LA",
        "LMrot", "LF", "RH", "RK", "RA", "RMrot", "RF",
    ],
    frames_per_second: 12.5,
};

#[cfg(test)]
mod tests {
    use super::FeatureSkeleton;

    #[test]
    fn tables_agree_with_each_other() {
        for skeleton in FeatureSkeleton::ALL {
            let (definition, joints) = (skeleton.definition(), skeleton.joint_count());
            assert_eq!(definition.directions.len(), joints);
            assert_eq!(definition.bone_lengths.len(), joints);
            assert_eq!(definition.names.len(), joints);
            assert_eq!(skeleton.bones().count(), joints - 1);
            let parents = skeleton.parents();
            for joint in 0..joints {
                let twin = definition.mirrored[joint];
                assert_eq!(definition.mirrored[twin], joint);
                let mirrored_parent = parents[joint].map(|parent| definition.mirrored[parent]);
                assert_eq!(parents[twin], mirrored_parent);
            }
        }
        assert_eq!(FeatureSkeleton::HumanMl3d.feature_count(), 263);
        assert_eq!(FeatureSkeleton::Kit.feature_count(), 251);
    }

    #[test]
    fn human_ml3d_has_the_bodys_joints() {
        let skeleton = FeatureSkeleton::HumanMl3d;
        let parents = skeleton.parents();
        for joint in physique_body::Joint::ALL {
            assert_eq!(skeleton.joint_name(joint.index()), Some(joint.name()));
            assert_eq!(
                parents[joint.index()],
                joint.parent().map(physique_body::Joint::index)
            );
            assert_eq!(
                skeleton.definition().mirrored[joint.index()],
                joint.mirrored().index()
            );
        }
        assert_eq!(skeleton.joint_name(22), None);
    }
}
