//! Rows of features as joints, each frame in its own heading, and the gradient on its way back.

use glam::Vec3;
use physique_body::Joint;
use physique_motion::features::{
    FeatureLayout, FeatureSkeleton, GradientRule, smpl_from_kit, smpl_from_kit_gradient,
};

use super::{FeatureBatch, JointFrame};
use crate::Error;

impl FeatureBatch<'_> {
    pub(super) fn check(&self) -> Result<(), Error> {
        let (motions, columns) = (self.lengths.len(), self.skeleton.feature_count());
        let expected = motions.saturating_mul(self.frames).saturating_mul(columns);
        let known = self
            .statistics
            .is_none_or(|statistics| statistics.skeleton() == self.skeleton);
        let within = self.lengths.iter().all(|&length| length <= self.frames);
        if self.features.len() == expected && known && within {
            return Ok(());
        }
        Err(Error::Batch {
            expected: format!("{motions} motions of up to {} x {columns}", self.frames),
            found: format!(
                "{} numbers of motions of up to {} frames, statistics of {:?}",
                self.features.len(),
                self.lengths.iter().max().unwrap_or(&0),
                self.statistics.map(|statistics| statistics.skeleton()),
            ),
        })
    }

    /// Rows of one motion after the other, those within motions only.
    fn motions(&self) -> impl Iterator<Item = &[f32]> {
        let columns = self.skeleton.feature_count();
        let motions = self.features.chunks_exact((self.frames * columns).max(1));
        let motions = motions.zip(self.lengths);
        motions.map(move |(motion, &length)| &motion[..length * columns])
    }

    /// SMPL's joints of all frames within motions, one motion after the other: seen from the ground
    /// below the root, in the root's heading.
    pub(super) fn joints(&self) -> Vec<JointFrame> {
        let columns = self.skeleton.feature_count();
        let rows = self
            .motions()
            .flat_map(|motion| motion.chunks_exact(columns));
        let mut joints = Vec::with_capacity(self.lengths.iter().sum());
        joints.extend(rows.map(|row| match self.skeleton {
            FeatureSkeleton::HumanMl3d => self.row_joints(row),
            FeatureSkeleton::Kit => {
                let kit: [[f32; 3]; 21] = self.row_joints(row);
                // It fails for another number of joints only.
                smpl_from_kit(&kit.map(Vec3::from_array))
                    .map_or([[f32::NAN; 3]; Joint::COUNT], |joints| {
                        joints.map(|joint| joint.to_array())
                    })
            }
        }));
        joints
    }

    /// The skeleton's own joints of a row. Where the path is no number, neither is the root.
    fn row_joints<const N: usize>(&self, row: &[f32]) -> [[f32; 3]; N] {
        const HEIGHT: usize = FeatureLayout::of(FeatureSkeleton::HumanMl3d).root_height;
        let mut joints = [[0.0; 3]; N];
        let numbers = HEIGHT..HEIGHT + 1 + 3 * (N - 1);
        let flat = &mut joints.as_flattened_mut()[2..];
        flat.copy_from_slice(&row[numbers.clone()]);
        if let Some(statistics) = self.statistics {
            let mean = &statistics.mean()[numbers.clone()];
            let deviation = &statistics.deviation()[numbers];
            for ((number, mean), deviation) in flat.iter_mut().zip(mean).zip(deviation) {
                *number = *number * deviation + mean;
            }
        }
        let path = row[..HEIGHT].iter().map(|number| number * 0.0).sum::<f32>();
        joints[0] = [path, joints[0][2], path];
        joints
    }

    /// The gradient by the features from the one by [`FeatureBatch::joints`].
    ///
    /// Joints move with the path as one, which changes nothing: the root's velocity has no
    /// gradient. Nor has its turn, if parents' rotations follow; where they count as constants it
    /// has one, as published.
    pub(super) fn gradient(&self, by_joints: &[JointFrame], rule: GradientRule) -> Vec<f32> {
        let columns = self.skeleton.feature_count();
        let mut by_features = vec![0.0; self.features.len()];
        let mut rest = by_joints;
        let by_motions = by_features.chunks_exact_mut((self.frames * columns).max(1));
        for (rows, by_motion) in self.motions().zip(by_motions) {
            let by_frames;
            (by_frames, rest) = rest.split_at(rows.len() / columns);
            match self.skeleton {
                FeatureSkeleton::HumanMl3d => {
                    self.motion_gradient(rows, by_frames.iter().copied(), by_motion, rule);
                }
                FeatureSkeleton::Kit => {
                    let by_kit = by_frames.iter().map(|by_smpl| {
                        let by_smpl = by_smpl.map(|by| Vec3::from_array(by).as_dvec3());
                        smpl_from_kit_gradient(&by_smpl).map(|by| by.as_vec3().to_array())
                    });
                    self.motion_gradient(rows, by_kit, by_motion, rule);
                }
            }
        }
        by_features
    }

    /// The gradient of one motion, whose rows these are.
    fn motion_gradient<const N: usize>(
        &self,
        rows: &[f32],
        by_frames: impl DoubleEndedIterator<Item = [[f32; 3]; N]> + ExactSizeIterator,
        by_motion: &mut [f32],
        rule: GradientRule,
    ) {
        let layout = FeatureLayout::of(self.skeleton);
        let columns = self.skeleton.feature_count();
        let deviation = |column: usize| {
            let statistics = self.statistics;
            statistics.map_or(1.0, |statistics| statistics.deviation()[column])
        };
        // A turn turns all frames after it.
        let mut by_half_turn = 0.0_f64;
        for (frame, mut by_joints) in by_frames.enumerate().rev() {
            let by_row = &mut by_motion[frame * columns..][..columns];
            if rule == GradientRule::ParentsConstant {
                by_row[layout.root_turn] = by_half_turn as f32 * deviation(layout.root_turn);
                let joints = self.row_joints::<N>(&rows[frame * columns..][..columns]);
                let turned = joints.iter().zip(&by_joints);
                let turned: f32 = turned.map(|(at, by)| at[2] * by[0] - at[0] * by[2]).sum();
                by_half_turn -= 2.0 * f64::from(turned);
            }
            by_joints[0][2] = by_joints[0][1];
            let by_numbers = &by_joints.as_flattened()[2..];
            let place = layout.root_height..layout.positions.end;
            for ((by, column), by_number) in
                by_row[place.clone()].iter_mut().zip(place).zip(by_numbers)
            {
                *by = by_number * deviation(column);
            }
        }
    }
}
