//! Slow and readable: posing and the self-intersection loss from the equations, in `f64`.
//!
//! The tests hold the fast kernels against this module, value and gradient; it is public so that
//! yours can too. It handles one frame at a time, in time proportional to the number of pairs.

use glam::{DMat3, DVec3};
use physique_body::Joint;

use crate::{Pairs, Penalty, PoseMatrices, SphereBody};

/// Local rotations of one frame, as `f64` matrices.
pub type Rotations = [DMat3; Joint::COUNT];

/// Row-major `f32` matrices as `f64`.
pub fn rotations(matrices: &PoseMatrices) -> Rotations {
    matrices.map(|matrix| DMat3::from_cols_array(&matrix.map(f64::from)).transpose())
}

/// A posed sphere body.
#[derive(Clone, Debug)]
pub struct Posed {
    /// Rotation and position of every joint in the world.
    pub world_from_joint: [(DMat3, DVec3); Joint::COUNT],
    /// `[spheres]` centres in the world.
    pub centres: Vec<DVec3>,
}

/// Derivatives of a loss of one frame to all that it depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// By the entries of the local rotation matrices, as if they were free numbers.
    pub rotations: Rotations,
    /// By a translation of the whole body.
    pub translation: DVec3,
    /// By the rest joints.
    pub rest_joints: [DVec3; Joint::COUNT],
    /// By the rest centres.
    pub centres: Vec<DVec3>,
    /// By the radii.
    pub radii: Vec<f64>,
}

/// Poses a body whose root is moved by `translation`.
pub fn pose(body: &SphereBody, rotations: &Rotations, translation: DVec3) -> Posed {
    let rest = body.rest_joints.map(|joint| joint.as_dvec3());
    let mut world = [(DMat3::IDENTITY, DVec3::ZERO); Joint::COUNT];
    for joint in 0..Joint::COUNT {
        world[joint] = match Joint::ALL[joint].parent().map(Joint::index) {
            None => (rotations[joint], rest[joint] + translation),
            Some(parent) => {
                let (rotation, position) = world[parent];
                let offset = rest[joint] - rest[parent];
                (rotation * rotations[joint], rotation * offset + position)
            }
        };
    }
    let centre = |sphere: usize| {
        let terms = body.blend_weights[sphere].map(|(joint, weight)| {
            let joint = usize::from(joint);
            let (rotation, position) = world[joint];
            let from_joint = body.centres[sphere].as_dvec3() - rest[joint];
            (rotation * from_joint + position) * f64::from(weight)
        });
        terms.into_iter().sum()
    };
    Posed {
        world_from_joint: world,
        centres: (0..body.sphere_count()).map(centre).collect(),
    }
}

/// Carries derivatives by the posed centres back to the pose and the rest body.
pub fn pose_backward(
    body: &SphereBody,
    rotations: &Rotations,
    posed: &Posed,
    by_centres: &[DVec3],
) -> Gradient {
    let rest = body.rest_joints.map(|joint| joint.as_dvec3());
    let world = &posed.world_from_joint;
    let mut gradient = Gradient {
        rotations: [DMat3::ZERO; Joint::COUNT],
        translation: DVec3::ZERO,
        rest_joints: [DVec3::ZERO; Joint::COUNT],
        centres: vec![DVec3::ZERO; body.sphere_count()],
        radii: vec![0.0; body.sphere_count()],
    };
    let mut by_world = [(DMat3::ZERO, DVec3::ZERO); Joint::COUNT];
    for (sphere, &by_centre) in by_centres.iter().enumerate() {
        for (joint, weight) in body.blend_weights[sphere] {
            let joint = usize::from(joint);
            let weighted = by_centre * f64::from(weight);
            let from_joint = body.centres[sphere].as_dvec3() - rest[joint];
            by_world[joint].0 += outer(weighted, from_joint);
            by_world[joint].1 += weighted;
            let at_rest = world[joint].0.transpose() * weighted;
            gradient.centres[sphere] += at_rest;
            gradient.rest_joints[joint] -= at_rest;
        }
    }
    // Children first: world = parent's world * [rotation | offset].
    for joint in (0..Joint::COUNT).rev() {
        let (by_rotation, by_position) = by_world[joint];
        let Some(parent) = Joint::ALL[joint].parent().map(Joint::index) else {
            gradient.rotations[joint] = by_rotation;
            gradient.rest_joints[joint] += by_position;
            gradient.translation = by_position;
            continue;
        };
        let world_from_parent = world[parent].0.transpose();
        gradient.rotations[joint] = world_from_parent * by_rotation;
        let offset = rest[joint] - rest[parent];
        by_world[parent].0 +=
            by_rotation * rotations[joint].transpose() + outer(by_position, offset);
        by_world[parent].1 += by_position;
        gradient.rest_joints[joint] += world_from_parent * by_position;
        gradient.rest_joints[parent] -= world_from_parent * by_position;
    }
    gradient
}

/// The self-intersection loss of one frame, `sum over pairs of penalty(max(0, r_i + r_j - |c_i -
/// c_j| - tolerance))`, and its gradient. Centres that coincide push nowhere.
pub fn self_intersection(
    body: &SphereBody,
    pairs: &Pairs,
    penalty: Penalty,
    tolerance: f64,
    rotations: &Rotations,
) -> (f64, Gradient) {
    let posed = pose(body, rotations, DVec3::ZERO);
    let mut loss = 0.0;
    let mut by_centres = vec![DVec3::ZERO; body.sphere_count()];
    let mut by_radii = vec![0.0; body.sphere_count()];
    for (i, j) in pairs.iter() {
        let apart = posed.centres[i] - posed.centres[j];
        let touching = f64::from(body.radii[i]) + f64::from(body.radii[j]);
        let depth = touching - apart.length() - tolerance;
        if depth > 0.0 {
            let (cost, by_depth) = penalty.of(depth);
            loss += cost;
            let push = apart.normalize_or_zero() * by_depth;
            by_centres[i] -= push;
            by_centres[j] += push;
            by_radii[i] += by_depth;
            by_radii[j] += by_depth;
        }
    }
    let mut gradient = pose_backward(body, rotations, &posed, &by_centres);
    gradient.radii = by_radii;
    (loss, gradient)
}

/// a b^T.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
