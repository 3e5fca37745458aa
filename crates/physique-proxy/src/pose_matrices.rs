//! Poses as matrices, in the layout that training code keeps them in.

use glam::{Mat3, Quat};
use physique_body::Joint;

/// One frame's 22 local rotations (`parent_from_joint`, relative to the rest pose) in [`Joint`]'s
/// order, each a 3×3 matrix in **row-major** order, as a PyTorch tensor of shape `(22, 3, 3)`.
///
/// A tensor of shape `(frames, 22, 3, 3)` is a slice of these: `bytemuck::cast_slice` converts
/// without a copy. Losses treat the nine entries as free numbers and so do their gradients.
pub type PoseMatrices = [[f32; 9]; Joint::COUNT];

/// The matrices of one frame's quaternions; joints that are missing rest.
pub fn pose_matrices(rotations: &[Quat]) -> PoseMatrices {
    let mut matrices = [Mat3::IDENTITY.to_cols_array(); Joint::COUNT];
    for (matrix, rotation) in matrices.iter_mut().zip(rotations) {
        *matrix = Mat3::from_quat(*rotation).transpose().to_cols_array();
    }
    matrices
}
