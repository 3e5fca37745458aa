//! The turn of one joint from where its bones point at rest to where they point now:
//! `physique_motion::features::RotationLayer` in 32 bits, whose equations and names these are.

use cubecl::prelude::*;

use super::memory::Frame;
use super::vectors::{Mat3, Unit, Vec3};

/// Squared sine below which bones are folded straight back: 1 + cosine is below 1e-12.
const FOLDED: f32 = 2e-12;

/// Where the bones of a joint point at rest.
#[derive(CubeType, Clone, Copy)]
#[expand(derive(Clone, Copy))]
pub(super) struct Rest {
    pub(super) direction: Vec3,
    /// What bones that are folded straight back turn by.
    pub(super) half_turn: Mat3,
}

/// What the way back needs of the way there.
#[derive(CubeType, Clone, Copy)]
#[expand(derive(Clone, Copy))]
pub(super) struct Swing {
    /// Where the bones point now.
    pub(super) now: Unit,
    pub(super) axis: Vec3,
    /// 1 / (1 + cosine).
    pub(super) share: f32,
    /// 1 unless bones are folded straight back.
    pub(super) unfolded: f32,
}

#[cube]
impl Swing {
    /// From `rest` to `now`, seen from a parent whose rotation is `above`.
    pub(super) fn new(rest: Rest, now: Unit, above: Mat3) -> Swing {
        let in_parent = in_parent(rest, now, above);
        let axis = rest.direction.cross(in_parent);
        let cosine = rest.direction.dot(in_parent);
        let sine_square = axis.dot(axis);
        let ahead = cosine > 0.0f32;
        // Where 1 + cosine loses its digits, the same from the sine.
        let near = 1.0f32 / f32::max(1.0f32 + cosine, 0.5f32);
        let far = (1.0f32 - cosine) / f32::max(sine_square, 0.1f32 * FOLDED);
        let folded = sine_square < FOLDED && !ahead;
        Swing {
            now,
            axis,
            share: select(ahead, near, far),
            unfolded: select(folded, 0.0f32, 1.0f32),
        }
    }

    /// c I + [n]x + n n^T / (1 + c) with c = u . w and n = u x w.
    pub(super) fn rotation(self, rest: Rest, above: Mat3) -> Mat3 {
        let cosine = rest.direction.dot(in_parent(rest, self.now, above));
        let n = self.axis;
        let s = n.scale(self.share);
        let turned = Mat3 {
            x: Vec3::new(s.x * n.x + cosine, s.x * n.y - n.z, s.x * n.z + n.y),
            y: Vec3::new(s.y * n.x + n.z, s.y * n.y + cosine, s.y * n.z - n.x),
            z: Vec3::new(s.z * n.x - n.y, s.z * n.y + n.x, s.z * n.z + cosine),
        };
        let unfolded = self.unfolded > 0.0f32;
        Mat3 {
            x: chosen(unfolded, turned.x, rest.half_turn.x),
            y: chosen(unfolded, turned.y, rest.half_turn.y),
            z: chosen(unfolded, turned.z, rest.half_turn.z),
        }
    }

    /// The gradient by the direction in the parent's frame from the one by the rotation.
    pub(super) fn gradient(self, rest: Rest, by_rotation: Mat3) -> Vec3 {
        let by = by_rotation;
        let turned = by.turn(self.axis);
        let back = by.transpose().turn(self.axis);
        let trace = by.x.x + by.y.y + by.z.z;
        let by_cosine = trace - self.share * self.share * self.axis.dot(turned);
        let skew = Vec3::new(by.z.y - by.y.z, by.x.z - by.z.x, by.y.x - by.x.y);
        let by_axis = turned.add(back).scale(self.share).add(skew);
        let by_direction = rest.direction.scale(by_cosine);
        let by_direction = by_direction.add(by_axis.cross(rest.direction));
        by_direction.scale(self.unfolded)
    }

    pub(super) fn read(work: &[f32], entry: usize, at: Frame) -> Swing {
        Swing {
            now: at.read_unit(work, entry),
            axis: at.read_vec3(work, entry + 4),
            share: at.read(work, entry + 7),
            unfolded: at.read(work, entry + 8),
        }
    }

    pub(super) fn write(self, work: &mut [f32], entry: usize, at: Frame) {
        at.write_unit(work, entry, self.now);
        at.write_vec3(work, entry + 4, self.axis);
        at.write(work, entry + 7, self.share);
        at.write(work, entry + 8, self.unfolded);
    }
}

/// Where bones point in the frame of a parent; without bones, as at rest.
#[cube]
fn in_parent(rest: Rest, now: Unit, above: Mat3) -> Vec3 {
    let turned = above.transpose().turn(now.direction);
    chosen(now.inverse_length > 0.0f32, turned, rest.direction)
}

#[cube]
fn chosen(condition: bool, yes: Vec3, no: Vec3) -> Vec3 {
    Vec3::new(
        select(condition, yes.x, no.x),
        select(condition, yes.y, no.y),
        select(condition, yes.z, no.z),
    )
}
