//! The rest skeleton that the positions belong to.

use glam::Vec3;
use physique_body::Joint;

use super::{
    pose::{CHEST_BONES, PELVIS_BONES, upright},
    rigid::best_rotation,
};
use crate::{Error, features::JointPositions};

/// From the parent to each joint at rest: directions given, lengths measured; the three bones of
/// pelvis and chest are measured as a whole.
pub(super) struct SourceBones {
    offsets: [Vec3; Joint::COUNT],
}

impl SourceBones {
    /// Measures lengths, and the bones of pelvis and chest.
    pub(super) fn measure(
        positions: &JointPositions,
        directions: &[Vec3; Joint::COUNT],
    ) -> Result<Self, Error> {
        let mut bones = Self::at_rest(positions, directions)?;
        bones.adapt_to(positions);
        Ok(bones)
    }

    /// Takes the median length of each bone over the clip: generated motions stretch their bones.
    pub(super) fn at_rest(
        positions: &JointPositions,
        directions: &[Vec3; Joint::COUNT],
    ) -> Result<Self, Error> {
        let mut offsets = [Vec3::ZERO; Joint::COUNT];
        for joint in &Joint::ALL[1..] {
            let Some(parent) = joint.parent() else {
                continue;
            };
            let bones = positions
                .frames()
                .map(|p| p[joint.index()].distance(p[parent.index()]));
            let mut lengths: Vec<f32> = bones.collect();
            let middle = lengths.len() / 2;
            let (_, &mut median, _) = lengths.select_nth_unstable_by(middle, f32::total_cmp);
            if median <= 0.0 {
                return Err(Error::NoBone {
                    frame: 0,
                    parent: parent.name(),
                    joint: joint.name(),
                });
            }
            offsets[joint.index()] = directions[joint.index()] * median;
        }
        Ok(Self { offsets })
    }

    /// Gives the bones of pelvis and chest the angles between them that they have in the clip: hip
    /// joints sit deeper in one body model than in another. The rotation that fits the directions
    /// at rest best stays the rotation, so that nothing but shape is learnt.
    fn adapt_to(&mut self, positions: &JointPositions) {
        for (joint, ends) in [(Joint::Pelvis, PELVIS_BONES), (Joint::Spine3, CHEST_BONES)] {
            let mut sums = [Vec3::ZERO; 3];
            for p in positions.frames() {
                let now = ends.map(|end| p[end.index()] - p[joint.index()]);
                let pairs = [0, 1, 2].map(|bone| (self.offset(ends[bone]), now[bone]));
                let joint_from_world = best_rotation(&pairs, upright(p)).inverse();
                for (sum, now) in sums.iter_mut().zip(now) {
                    *sum += joint_from_world * now;
                }
            }
            for (end, sum) in ends.into_iter().zip(sums) {
                let length = self.offset(end).length();
                self.offsets[end.index()] = sum.normalize_or(self.offset(end) / length) * length;
            }
        }
    }

    /// From its parent to a joint at rest.
    pub(super) const fn offset(&self, joint: Joint) -> Vec3 {
        self.offsets[joint.index()]
    }

    /// Hip to knee to ankle, mean of both legs.
    pub(super) fn leg_length(&self) -> f32 {
        let bones = Joint::LEGS.map(|[_, knee, ankle, _]| [knee, ankle]);
        bones
            .into_iter()
            .flatten()
            .map(|joint| self.offset(joint).length())
            .sum::<f32>()
            / 2.0
    }
}
