//! The chain of joints, frame by frame: for what is not fused over many frames.

use glam::{DMat3, DVec3, Mat3, Vec3};
use physique_body::Joint;

use crate::PoseMatrices;

/// Rotation and position of every joint.
pub(crate) type Chain = [(Mat3, Vec3); Joint::COUNT];

/// Derivatives by a chain.
pub(crate) type ByChain = [(DMat3, DVec3); Joint::COUNT];

/// `world_from_joint` of a pose about the rest root.
pub(crate) fn world_from_joint(
    rest_joints: &[Vec3; Joint::COUNT],
    rotations: &PoseMatrices,
) -> Chain {
    let mut world = [(Mat3::IDENTITY, Vec3::ZERO); Joint::COUNT];
    for joint in Joint::ALL {
        let index = joint.index();
        let local = local(rotations, index);
        world[index] = match joint.parent().map(Joint::index) {
            None => (local, rest_joints[index]),
            Some(parent) => {
                let (rotation, position) = world[parent];
                let offset = rest_joints[index] - rest_joints[parent];
                (rotation * local, rotation * offset + position)
            }
        };
    }
    world
}

/// From derivatives by `world_from_joint`, which are used up, to those by the local rotations.
pub(crate) fn backward(
    rest_joints: &[Vec3; Joint::COUNT],
    rotations: &PoseMatrices,
    world: &Chain,
    by_world: &mut ByChain,
) -> [DMat3; Joint::COUNT] {
    let mut by_local = [DMat3::ZERO; Joint::COUNT];
    for index in (0..Joint::COUNT).rev() {
        let (by_rotation, by_position) = by_world[index];
        let Some(parent) = Joint::ALL[index].parent().map(Joint::index) else {
            by_local[index] = by_rotation;
            continue;
        };
        by_local[index] = world[parent].0.as_dmat3().transpose() * by_rotation;
        let offset = (rest_joints[index] - rest_joints[parent]).as_dvec3();
        let local = local(rotations, index).as_dmat3();
        by_world[parent].0 += by_rotation * local.transpose() + outer(by_position, offset);
        by_world[parent].1 += by_position;
    }
    by_local
}

/// Row-major in the layout of poses.
fn local(rotations: &PoseMatrices, joint: usize) -> Mat3 {
    Mat3::from_cols_array(&rotations[joint]).transpose()
}

/// a b^T.
pub(crate) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
