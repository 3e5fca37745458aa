//! What kernels keep of each frame, and where.
//!
//! The numbers of all frames lie side by side, entry by entry: units that work on neighbouring frames
//! read and write neighbouring places.

use cubecl::prelude::*;
use physique::body::Joint;

use super::vectors::{Mat3, Unit, Vec3};

pub(super) const JOINTS: usize = Joint::COUNT;

/// Positions of the joints.
pub(super) const POSITIONS: usize = 0;
/// Local rotations.
pub(super) const LOCAL: usize = POSITIONS + 3 * JOINTS;
/// `world_from_joint`: nine numbers of the rotation, row by row, and the position.
pub(super) const WORLD: usize = LOCAL + 9 * JOINTS;
/// Where the bone from its parent to a joint points, and one over its length; for the pelvis, the
/// same of the heading.
pub(super) const BONES: usize = WORLD + TRANSFORM * JOINTS;
/// How each joint is swung, see [`super::swing`].
pub(super) const SWINGS: usize = BONES + 4 * JOINTS;
/// Sums of the directions of a joint's bones; on the way back, derivatives by them.
pub(super) const SUMS: usize = SWINGS + SWING * JOINTS;
/// Derivatives by `world_from_joint`, through the spheres.
pub(super) const BY_WORLD: usize = SUMS + 3 * JOINTS;
/// Derivatives by the rotations of `world_from_joint`, through those of joints below.
pub(super) const BY_SWINGS: usize = BY_WORLD + TRANSFORM * JOINTS;
/// Derivatives by the positions.
pub(super) const BY_POSITIONS: usize = BY_SWINGS + 9 * JOINTS;
/// What the frame counts in the gradient.
pub(super) const WEIGHT: usize = BY_POSITIONS + 3 * JOINTS;
/// 1 where the frame holds what is no number, else 0.
pub(super) const BROKEN: usize = WEIGHT + 1;
/// The loss.
pub(super) const LOSS: usize = BROKEN + 1;
/// The derivative by a turn of the frame about +Y.
pub(super) const TURNED: usize = LOSS + 1;
/// Numbers of a frame.
pub(super) const ENTRIES: usize = TURNED + 1;

/// Numbers of a transform.
pub(super) const TRANSFORM: usize = 12;
/// Numbers of a swing.
pub(super) const SWING: usize = 9;

/// One of the frames.
#[derive(CubeType, Clone, Copy)]
#[expand(derive(Clone, Copy))]
pub(super) struct Frame {
    pub(super) index: usize,
    pub(super) count: usize,
}

#[cube]
impl Frame {
    pub(super) fn read(self, work: &[f32], entry: usize) -> f32 {
        work[entry * self.count + self.index]
    }

    pub(super) fn write(self, work: &mut [f32], entry: usize, number: f32) {
        work[entry * self.count + self.index] = number;
    }

    pub(super) fn read_vec3(self, work: &[f32], entry: usize) -> Vec3 {
        Vec3::new(
            self.read(work, entry),
            self.read(work, entry + 1),
            self.read(work, entry + 2),
        )
    }

    pub(super) fn write_vec3(self, work: &mut [f32], entry: usize, vector: Vec3) {
        self.write(work, entry, vector.x);
        self.write(work, entry + 1, vector.y);
        self.write(work, entry + 2, vector.z);
    }

    pub(super) fn add_vec3(self, work: &mut [f32], entry: usize, vector: Vec3) {
        let sum = self.read_vec3(&*work, entry).add(vector);
        self.write_vec3(work, entry, sum);
    }

    pub(super) fn read_unit(self, work: &[f32], entry: usize) -> Unit {
        Unit {
            direction: self.read_vec3(work, entry),
            inverse_length: self.read(work, entry + 3),
        }
    }

    pub(super) fn write_unit(self, work: &mut [f32], entry: usize, unit: Unit) {
        self.write_vec3(work, entry, unit.direction);
        self.write(work, entry + 3, unit.inverse_length);
    }

    pub(super) fn read_mat3(self, work: &[f32], entry: usize) -> Mat3 {
        Mat3 {
            x: self.read_vec3(work, entry),
            y: self.read_vec3(work, entry + 3),
            z: self.read_vec3(work, entry + 6),
        }
    }

    pub(super) fn write_mat3(self, work: &mut [f32], entry: usize, matrix: Mat3) {
        self.write_vec3(work, entry, matrix.x);
        self.write_vec3(work, entry + 3, matrix.y);
        self.write_vec3(work, entry + 6, matrix.z);
    }

    pub(super) fn add_mat3(self, work: &mut [f32], entry: usize, matrix: Mat3) {
        let sum = self.read_mat3(&*work, entry).add(matrix);
        self.write_mat3(work, entry, sum);
    }

    /// Sets `count` numbers to 0.
    pub(super) fn clear(self, work: &mut [f32], entry: usize, #[comptime] count: usize) {
        for place in 0..count {
            self.write(work, entry + place, 0.0f32);
        }
    }
}
