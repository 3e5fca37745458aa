//! Where each block of a feature row lies.

use std::ops::Range;

use super::FeatureSkeleton;

/// Columns of the blocks of a feature row, in their order.
///
/// | block | HumanML3D | KIT | content |
/// |---|---|---|---|
/// | `root_turn` | 0 | 0 | **half** the root's turn about +Y to the next frame, radians |
/// | `root_velocity` | 1..3 | 1..3 | x and z of the root's step, in its own heading |
/// | `root_height` | 3 | 3 | y of the root |
/// | `positions` | 4..67 | 4..64 | joints 1.., x y z, relative to the root's x and z, in its heading |
/// | `rotations` | 67..193 | 64..184 | joints 1.., 6D rotation by columns |
/// | `velocities` | 193..259 | 184..247 | joints 0.., x y z a frame, in the root's heading |
/// | `contacts` | 259..263 | 247..251 | 1 where a foot's joint rests: ankle and toe of one side, then of the other |
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FeatureLayout {
    /// Half the root's turn.
    pub root_turn: usize,
    /// The root's step.
    pub root_velocity: Range<usize>,
    /// The root's height.
    pub root_height: usize,
    /// Positions relative to the root.
    pub positions: Range<usize>,
    /// 6D rotations.
    pub rotations: Range<usize>,
    /// Steps of the joints.
    pub velocities: Range<usize>,
    /// Contacts of the feet.
    pub contacts: Range<usize>,
}

impl FeatureLayout {
    /// The layout of a skeleton's features.
    pub const fn of(skeleton: FeatureSkeleton) -> Self {
        let joints = skeleton.joint_count();
        let (rotations, velocities) = (4 + 3 * (joints - 1), 4 + 9 * (joints - 1));
        let contacts = velocities + 3 * joints;
        Self {
            root_turn: 0,
            root_velocity: 1..3,
            root_height: 3,
            positions: 4..rotations,
            rotations: rotations..velocities,
            velocities: velocities..contacts,
            contacts: contacts..contacts + 4,
        }
    }

    /// What a column of the skeleton's features holds, in words: `position of left_knee, y`.
    pub(super) fn describe(&self, skeleton: FeatureSkeleton, column: usize) -> String {
        let joint = |index: usize| skeleton.joint_name(index).unwrap_or("a joint");
        let axis = |index: usize| ["x", "y", "z"][index % 3];
        let within = |block: &Range<usize>| block.contains(&column).then(|| column - block.start);
        if column == self.root_turn {
            "turn of the root".into()
        } else if let Some(index) = within(&self.root_velocity) {
            format!("velocity of the root, {}", ["x", "z"][index % 2])
        } else if column == self.root_height {
            "height of the root".into()
        } else if let Some(index) = within(&self.positions) {
            format!("position of {}, {}", joint(1 + index / 3), axis(index))
        } else if let Some(index) = within(&self.rotations) {
            format!("rotation of {}", joint(1 + index / 6))
        } else if let Some(index) = within(&self.velocities) {
            format!("velocity of {}, {}", joint(index / 3), axis(index))
        } else {
            "contact of a foot".into()
        }
    }

    /// The seven blocks as ranges: the grain at which standard deviations are averaged.
    pub fn blocks(&self) -> [Range<usize>; 7] {
        [
            self.root_turn..self.root_turn + 1,
            self.root_velocity.clone(),
            self.root_height..self.root_height + 1,
            self.positions.clone(),
            self.rotations.clone(),
            self.velocities.clone(),
            self.contacts.clone(),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::{FeatureLayout, FeatureSkeleton};

    #[test]
    fn columns_have_names() {
        let skeleton = FeatureSkeleton::HumanMl3d;
        let layout = FeatureLayout::of(skeleton);
        let name = |column| layout.describe(skeleton, column);
        assert_eq!(name(0), "turn of the root");
        assert_eq!(name(2), "velocity of the root, z");
        assert_eq!(name(4), "position of left_hip, x");
        assert_eq!(name(192), "rotation of right_wrist");
        assert_eq!(name(193 + 4), "velocity of left_hip, y");
        assert_eq!(name(262), "contact of a foot");
    }

    #[test]
    fn columns_are_those_of_the_data_sets() {
        let layout = FeatureLayout::of(FeatureSkeleton::HumanMl3d);
        assert_eq!((layout.positions, layout.rotations), (4..67, 67..193));
        assert_eq!((layout.velocities, layout.contacts), (193..259, 259..263));
        let layout = FeatureLayout::of(FeatureSkeleton::Kit);
        assert_eq!((layout.positions, layout.rotations), (4..64, 64..184));
        assert_eq!((layout.velocities, layout.contacts), (184..247, 247..251));
    }
}
