//! Everything that a repair weighs, as one number with its gradient.

use glam::{DMat3, DVec3, Mat3};
use physique_body::Joint;
use physique_physics::soles::SOLE_POINTS;
use physique_proxy::{PoseMatrices, SelfIntersection};
use rayon::prelude::*;

use super::balance::Balance;
use super::change::{FRAMES_A_TASK, Source, UNKNOWNS, add_turns};
use super::descent::Cost;
use super::feet::Feet;
use super::figure::{Figure, Pose};
use super::ground::Ground;
use super::preconditioner::Preconditioner;
use super::stiffness::Stiffness;
use super::touch::Touches;
use super::wrench::Wrenches;

/// Two spheres 1 m in each other, in units of the stiffness; and a gap that opens by 1 m where
/// hands touched.
const DEPTH: f64 = 1e4;

/// How much each part counts; 1 is the usual.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    pub(super) spheres: f64,
    pub(super) ground: f64,
    pub(super) feet: f64,
    pub(super) balance: f64,
}

/// What is weighed, in units of the stiffness.
pub(super) struct Objective<'a> {
    pub(super) source: &'a Source,
    pub(super) figure: &'a Figure,
    pub(super) stiffness: &'a Stiffness,
    pub(super) preconditioner: &'a Preconditioner,
    pub(super) spheres: &'a SelfIntersection,
    pub(super) touches: &'a Touches,
    pub(super) feet: &'a Feet,
    pub(super) balance: &'a Balance,
    /// None where the ground is left alone.
    pub(super) ground: Option<&'a Ground>,
    /// `[frames]` weights of the self-intersection.
    pub(super) self_weights: &'a [f32],
    pub(super) weights: Weights,
}

impl Cost for Objective<'_> {
    fn evaluate(&self, at: &[f64], gradient: &mut [f64]) -> f64 {
        gradient.fill(0.0);
        let mut cost = self.stiffness.cost(at, gradient);
        let poses = self.source.poses(self.figure, at);
        let Some((of_spheres, by_poses)) = self.spheres(&poses) else {
            // Rotations that are no numbers: a step that the search takes back.
            return f64::MAX;
        };
        cost += of_spheres;

        let mut soles = vec![[DVec3::ZERO; SOLE_POINTS]; poses.len()];
        let mut centres = vec![DVec3::ZERO; poses.len()];
        cost += self.feet.cost(&poses, self.weights.feet, &mut soles);
        let balance = self.weights.balance;
        cost += self.balance.cost(&poses, balance, &mut centres, &mut soles);

        let of_frames: Vec<f64> = gradient
            .par_chunks_exact_mut(UNKNOWNS)
            .zip(at.par_chunks_exact(UNKNOWNS))
            .enumerate()
            .with_min_len(FRAMES_A_TASK)
            .map_init(
                Wrenches::default,
                |wrenches, (frame, (gradient, change))| {
                    let pose = &poses[frame];
                    wrenches.clear(&self.figure.rig);
                    let cost = self.push(frame, pose, wrenches);
                    let world = &pose.world_from_rest;
                    for (sole, force) in self.figure.soles().iter().zip(soles[frame]) {
                        wrenches.push_skin(sole, world, force);
                    }
                    wrenches.push_centre(&self.figure.moments, world, centres[frame]);
                    let mut turns = by_poses[frame]
                        .map_or([DVec3::ZERO; Joint::COUNT], |by_pose| {
                            turns_of(&by_pose, pose)
                        });
                    let root = wrenches.carry(&self.figure.rig, world, &mut turns);
                    add_turns(change, &turns, root, gradient);
                    cost
                },
            )
            .collect();
        cost += of_frames.iter().sum::<f64>();
        if cost.is_finite() { cost } else { f64::MAX }
    }

    fn precondition(&self, gradient: &mut [f64]) {
        self.preconditioner.solve(self.stiffness, gradient);
    }
}

impl Objective<'_> {
    /// The self-intersection loss of the frames that have a weight, and its derivatives by their
    /// rotation matrices.
    fn spheres(&self, poses: &[Pose]) -> Option<(f64, Vec<Option<PoseMatrices>>)> {
        let mut by_frames = vec![None; poses.len()];
        let weighted = self.self_weights.iter().enumerate();
        let active: Vec<_> = weighted
            .filter_map(|(frame, &weight)| (weight > 0.0).then_some(frame))
            .collect();
        if active.is_empty() {
            return Some((0.0, by_frames));
        }
        let matrices: Vec<_> = active
            .iter()
            .map(|&frame| matrices(&poses[frame]))
            .collect();
        let scale = (DEPTH * self.weights.spheres) as f32;
        let weights = active.iter().map(|&frame| scale * self.self_weights[frame]);
        let weights: Vec<_> = weights.collect();
        let mut losses = vec![0.0; active.len()];
        let mut by_poses: Vec<PoseMatrices> = vec![Default::default(); active.len()];
        self.spheres
            .gradient(&matrices, &weights, &mut losses, &mut by_poses)
            .ok()?;
        for (&frame, by_pose) in active.iter().zip(by_poses) {
            by_frames[frame] = Some(by_pose);
        }
        let terms = losses.iter().zip(&weights);
        let cost = terms.map(|(loss, weight)| f64::from(loss * weight)).sum();
        Some((cost, by_frames))
    }

    /// What looks at one frame alone.
    fn push(&self, frame: usize, pose: &Pose, wrenches: &mut Wrenches) -> f64 {
        let mut cost = 0.0;
        if let Some(ground) = self.ground {
            let weight = self.weights.ground;
            cost += ground.cost(self.figure, frame, pose, weight, wrenches);
        }
        if self.self_weights[frame] > 0.0 {
            let weight = DEPTH * self.weights.spheres;
            cost += self.touches.cost(frame, pose, weight, wrenches);
        }
        cost
    }
}

/// The rotations, for the spheres.
fn matrices(pose: &Pose) -> PoseMatrices {
    pose.rotations.map(|rotation| {
        let single = Mat3::from_cols_array(&rotation.to_cols_array().map(|x| x as f32));
        single.transpose().to_cols_array()
    })
}

/// From derivatives by the rotation matrices to those by small turns: the antisymmetric part of
/// `G R^T`.
fn turns_of(by_pose: &PoseMatrices, pose: &Pose) -> [DVec3; Joint::COUNT] {
    std::array::from_fn(|joint| {
        let by_matrix = DMat3::from_cols_array(&by_pose[joint].map(f64::from)).transpose();
        let product = by_matrix * pose.rotations[joint].transpose();
        DVec3::new(
            product.y_axis.z - product.z_axis.y,
            product.z_axis.x - product.x_axis.z,
            product.x_axis.y - product.y_axis.x,
        )
    })
}

#[cfg(test)]
mod tests;
