//! The self-intersection loss of what networks generate: HumanML3D's and KIT's features.

use glam::{DMat3, DVec3};
use physique_motion::features::{
    FeatureSkeleton, GradientRule, MotionFeatures, RotationLayer, recover_from_positions,
    recover_from_positions_gradient, smpl_from_kit_gradient,
};
use rayon::prelude::*;

use crate::{Error, PoseMatrices, SelfIntersection};

/// The loss on features, through the paper's rotation layer: features to joint positions, positions
/// to swings of 22 joints, swings to spheres.
///
/// As published, no gradient reaches a joint by its parents' rotations
/// ([`GradientRule::ParentsConstant`]); [`GradientRule::Full`] is the derivative of what is computed.
/// Where the published quaternion formula is 0/0 (bones along their rest direction, a body that
/// faces +Z exactly), value and gradient are finite here.
#[derive(Debug)]
pub struct FeatureLoss {
    loss: SelfIntersection,
    layer: RotationLayer,
    rule: GradientRule,
}

/// A motion's losses, and the gradient of their weighted sum.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureGradient {
    /// `[frames]`.
    pub losses: Vec<f32>,
    /// `[frames][columns]`, flat as the features are; not normalised, as they are.
    pub by_features: Vec<f64>,
}

impl FeatureLoss {
    /// The loss of a body; `layer` must be for the skeleton of the features
    /// ([`RotationLayer::published`]).
    pub fn new(loss: SelfIntersection, layer: RotationLayer, rule: GradientRule) -> Self {
        Self { loss, layer, rule }
    }

    /// The loss of every frame.
    ///
    /// # Errors
    /// [`Error::Motion`] for features whose positions overflow.
    pub fn losses(&self, motion: &MotionFeatures) -> Result<Vec<f32>, Error> {
        let (_, poses) = self.poses(motion)?;
        let mut losses = vec![0.0; poses.len()];
        self.loss.losses(&poses, &mut losses)?;
        Ok(losses)
    }

    /// The loss of every frame and the gradient of `sum of weight * loss` by the features.
    ///
    /// # Errors
    /// As [`FeatureLoss::losses`], and [`Error::Length`] unless there is one weight a frame.
    pub fn gradient(
        &self,
        motion: &MotionFeatures,
        weights: &[f32],
    ) -> Result<FeatureGradient, Error> {
        let (joints, poses) = self.poses(motion)?;
        let mut losses = vec![0.0; poses.len()];
        let mut by_poses = vec![[[0.0; 9]; 22]; poses.len()];
        self.loss
            .gradient(&poses, weights, &mut losses, &mut by_poses)?;
        let mut by_positions = Vec::with_capacity(joints.len() * motion.skeleton().joint_count());
        for (joints, by_pose) in joints.iter().zip(&by_poses) {
            let by_rotations =
                by_pose.map(|matrix| DMat3::from_cols_array(&matrix.map(f64::from)).transpose());
            let by_joints = self.layer.gradient(joints, &by_rotations, self.rule);
            match motion.skeleton() {
                FeatureSkeleton::Kit => by_positions.extend(smpl_from_kit_gradient(&by_joints)),
                FeatureSkeleton::HumanMl3d => by_positions.extend::<[DVec3; 22]>(by_joints),
            }
        }
        Ok(FeatureGradient {
            losses,
            by_features: recover_from_positions_gradient(motion, &by_positions)?,
        })
    }

    /// [`FeatureLoss::gradient`] of a whole batch, motions side by side on all threads.
    ///
    /// # Errors
    /// Those of the first motion that has one.
    pub fn batch(
        &self,
        batch: &[(MotionFeatures, Vec<f32>)],
    ) -> Result<Vec<FeatureGradient>, Error> {
        let gradients = batch
            .par_iter()
            .map(|(motion, weights)| self.gradient(motion, weights));
        let gradients: Vec<_> = gradients.collect();
        gradients.into_iter().collect()
    }

    /// Joints in SMPL's order, and poses.
    fn poses(
        &self,
        motion: &MotionFeatures,
    ) -> Result<(Vec<[glam::Vec3; 22]>, Vec<PoseMatrices>), Error> {
        let positions = recover_from_positions(motion)?.to_smpl_joints()?;
        let joints = positions.positions().as_chunks().0.to_vec();
        let pose = |joints: &[glam::Vec3; 22]| {
            self.layer.rotations(joints).map(|rotation| {
                rotation
                    .transpose()
                    .to_cols_array()
                    .map(|number| number as f32)
            })
        };
        let poses = joints.iter().map(pose).collect();
        Ok((joints, poses))
    }
}
