//! The rest skeleton that the positions belong to.

use glam::Vec3;
use physique_body::Joint;

use crate::{Error, features::JointPositions};

/// From the parent to each joint at rest: directions given, lengths measured.
pub(super) struct SourceBones {
    offsets: [Vec3; Joint::COUNT],
}

impl SourceBones {
    /// Takes the median length of each bone over the clip: generated motions stretch their bones.
    pub(super) fn measure(
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

    /// From its parent to a joint at rest.
    pub(super) const fn offset(&self, joint: Joint) -> Vec3 {
        self.offsets[joint.index()]
    }

    /// Hip to knee to ankle, mean of both legs.
    pub(super) fn leg_length(&self) -> f32 {
        let bones = [
            Joint::LeftKnee,
            Joint::LeftAnkle,
            Joint::RightKnee,
            Joint::RightAnkle,
        ];
        bones
            .map(|joint| self.offset(joint).length())
            .iter()
            .sum::<f32>()
            / 2.0
    }
}
