//! From transforms of joints to the loss and its derivatives by them: a frame a cube.
//!
//! A unit poses some of the spheres and compares each with all others, so that what pushes a sphere is
//! added up in one place and in one order: no atomic sums, the same bits every time. Two spheres that
//! touch are therefore measured twice.

use cubecl::prelude::*;

use super::memory::{BY_WORLD, Frame, JOINTS, LOSS, TRANSFORM, WEIGHT, WORLD};
use super::vectors::Vec3;

/// Units of a cube.
pub(super) const UNITS: usize = 64;

/// Most joints that a sphere follows.
pub(super) const INFLUENCES: usize = 4;

/// Squared distance below which centres coincide: they push nowhere.
const LEAST: f32 = 1e-30;

/// Numbers of a body that the kernel is compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct SphereCounts {
    pub(super) spheres: usize,
    /// Words of 32 bits, one a sphere, that say what a sphere is compared with.
    pub(super) words: usize,
    /// Whether an overlap costs its depth; else the square of that.
    pub(super) linear: bool,
}

impl SphereCounts {
    /// Where the arms of spheres end and their reaches begin.
    const fn reaches(self) -> usize {
        self.spheres * INFLUENCES * 4
    }

    /// Where the joints of spheres end and the words begin.
    const fn partners(self) -> usize {
        self.spheres * INFLUENCES
    }

    /// Where the words end and the followers of joints begin.
    const fn followers(self) -> usize {
        self.partners() + self.spheres * self.words
    }

    /// Bytes of memory that the units of a cube share.
    pub(super) const fn shared_bytes(self) -> usize {
        4 * (JOINTS * TRANSFORM + 7 * self.spheres + UNITS)
    }
}

/// Writes the loss and the derivatives of its share in the sum by the transforms of all joints.
///
/// `numbers` and `indices` are those of [`super::tables`].
#[cube(launch)]
pub(super) fn intersect(
    numbers: &[f32],
    indices: &[u32],
    work: &mut [f32],
    count: usize,
    #[comptime] counts: SphereCounts,
) {
    let at = Frame {
        index: CUBE_POS,
        count,
    };
    let unit = UNIT_POS as usize;
    let mut world = Shared::<[f32]>::new_slice(comptime!(JOINTS * TRANSFORM));
    // Centre and reach.
    let mut spheres = Shared::<[f32]>::new_slice(comptime!(4 * counts.spheres));
    let mut pushes = Shared::<[f32]>::new_slice(comptime!(3 * counts.spheres));
    let mut sums = Shared::<[f32]>::new_slice(UNITS);

    for entry in range_stepped(unit, comptime!(JOINTS * TRANSFORM), UNITS) {
        world[entry] = at.read(&*work, WORLD + entry);
    }
    sync_cube();

    for sphere in range_stepped(unit, counts.spheres, UNITS) {
        let mut centre = Vec3::new(0.0f32, 0.0f32, 0.0f32);
        for influence in 0..INFLUENCES {
            let place = INFLUENCES * sphere + influence;
            let joint = TRANSFORM * indices[place] as usize;
            let arm = 4 * place;
            let (x, y, z) = (numbers[arm], numbers[arm + 1], numbers[arm + 2]);
            let weight = numbers[arm + 3];
            centre.x += world[joint] * x + world[joint + 1] * y + world[joint + 2] * z;
            centre.y += world[joint + 3] * x + world[joint + 4] * y + world[joint + 5] * z;
            centre.z += world[joint + 6] * x + world[joint + 7] * y + world[joint + 8] * z;
            centre.x += world[joint + 9] * weight;
            centre.y += world[joint + 10] * weight;
            centre.z += world[joint + 11] * weight;
        }
        spheres[4 * sphere] = centre.x;
        spheres[4 * sphere + 1] = centre.y;
        spheres[4 * sphere + 2] = centre.z;
        spheres[4 * sphere + 3] = numbers[comptime!(counts.reaches()) + sphere];
    }
    sync_cube();

    let mut loss = 0.0f32;
    for sphere in range_stepped(unit, counts.spheres, UNITS) {
        let own = 4 * sphere;
        let (own_x, own_y, own_z) = (spheres[own], spheres[own + 1], spheres[own + 2]);
        let own_reach = spheres[own + 3];
        let mut push = Vec3::new(0.0f32, 0.0f32, 0.0f32);
        for other in 0..counts.spheres {
            let x = own_x - spheres[4 * other];
            let y = own_y - spheres[4 * other + 1];
            let z = own_z - spheres[4 * other + 2];
            let reach = own_reach + spheres[4 * other + 3];
            let square = x * x + y * y + z * z;
            // Few come near: only they ask whether they are compared at all.
            if reach > 0.0f32 && square < reach * reach {
                let word = comptime!(counts.partners()) + sphere * counts.words + other / 32;
                let bit = (indices[word] >> (other % 32) as u32) & 1u32;
                let distance = f32::sqrt(f32::max(square, LEAST));
                let depth = f32::max(reach - distance, 0.0f32);
                if bit == 1u32 && depth > 0.0f32 {
                    let mut cost = depth * depth;
                    let mut slope = 2.0f32 * depth;
                    if comptime!(counts.linear) {
                        cost = depth;
                        slope = 1.0f32;
                    }
                    // Each pair is met twice.
                    if sphere < other {
                        loss += cost;
                    }
                    let away = slope / distance;
                    push.x -= away * x;
                    push.y -= away * y;
                    push.z -= away * z;
                }
            }
        }
        pushes[3 * sphere] = push.x;
        pushes[3 * sphere + 1] = push.y;
        pushes[3 * sphere + 2] = push.z;
    }
    sums[unit] = loss;
    sync_cube();

    if unit == 0 {
        let mut sum = 0.0f32;
        for place in 0..UNITS {
            sum += sums[place];
        }
        at.write(work, LOSS, sum);
    }
    let weight = at.read(&*work, WEIGHT);
    let followers = comptime!(counts.followers());
    for entry in range_stepped(unit, comptime!(JOINTS * TRANSFORM), UNITS) {
        let joint = entry / TRANSFORM;
        let number = entry % TRANSFORM;
        // Nine numbers of the rotation, by the arms; three of the position, by the weights.
        let is_rotation = number < 9;
        let row = select(is_rotation, number / 3, number % 3);
        let column = select(is_rotation, number % 3, 3usize);
        let start = indices[followers + joint] as usize;
        let end = indices[followers + joint + 1] as usize;
        let mut sum = 0.0f32;
        for follower in start..end {
            let place = indices[followers + JOINTS + 1 + follower] as usize;
            sum += pushes[3 * (place / INFLUENCES) + row] * numbers[4 * place + column];
        }
        at.write(work, BY_WORLD + entry, sum * weight);
    }
}
