//! The chain of joints: `world_from_joint = world_from_parent * [rotation | offset]`.

use physique_body::Joint;

use super::Workspace;
use super::vectors::{rotation, splat};
use super::workspace::Transform;
use crate::lanes::{Lanes, Simd};
use crate::plan::Plan;

/// Parents by index; the pelvis's own is never asked for.
pub(super) const PARENTS: [usize; Joint::COUNT] = {
    let mut parents = [0; Joint::COUNT];
    let mut joint = 1;
    while joint < Joint::COUNT {
        if let Some(parent) = Joint::PARENTS[joint] {
            parents[joint] = parent.index();
        }
        joint += 1;
    }
    parents
};

#[inline(always)]
pub(super) fn forward<S: Simd>(simd: S, plan: &Plan, work: &mut Workspace<S::Lanes>) {
    let world = &mut work.world_from_joint;
    let [x, y, z] = splat(simd, plan.offsets[0]);
    let [a, b, c, d, e, f, g, h, i] = work.local[0];
    world[0] = [a, b, c, d, e, f, g, h, i, x, y, z];
    for joint in 1..Joint::COUNT {
        let parent = world[PARENTS[joint]];
        let local = &work.local[joint];
        let [x, y, z] = splat(simd, plan.offsets[joint]);
        for row in 0..3 {
            let [a, b, c] = [parent[3 * row], parent[3 * row + 1], parent[3 * row + 2]];
            for column in 0..3 {
                let product = c * local[6 + column];
                let product = b.mul_add(local[3 + column], product);
                world[joint][3 * row + column] = a.mul_add(local[column], product);
            }
            let position = parent[9 + row];
            world[joint][9 + row] = a.mul_add(x, b.mul_add(y, c.mul_add(z, position)));
        }
    }
}

/// From derivatives by `world_from_joint` to those by the local rotations, which they replace.
#[inline(always)]
pub(super) fn backward<S: Simd>(simd: S, plan: &Plan, work: &mut Workspace<S::Lanes>) {
    for joint in (1..Joint::COUNT).rev() {
        let parent = PARENTS[joint];
        let by_joint = work.by_world[joint];
        let offset = splat(simd, plan.offsets[joint]);
        let by_parent = &mut work.by_world[parent];
        let local = &mut work.local[joint];
        add_parent::<S>(by_parent, &by_joint, local, offset);
        let world = &work.world_from_joint[parent];
        for row in 0..3 {
            for column in 0..3 {
                // world_from_parent^T * by_joint
                let product = world[6 + row] * by_joint[6 + column];
                let product = world[3 + row].mul_add(by_joint[3 + column], product);
                local[3 * row + column] = world[row].mul_add(by_joint[column], product);
            }
        }
    }
    work.local[0] = rotation(&work.by_world[0]);
}

/// `by_parent += [by_rotation * rotation^T + by_position * offset^T | by_position]`.
#[inline(always)]
fn add_parent<S: Simd>(
    by_parent: &mut Transform<S::Lanes>,
    by_joint: &Transform<S::Lanes>,
    rotation: &[S::Lanes; 9],
    offset: [S::Lanes; 3],
) {
    for row in 0..3 {
        let [a, b, c] = [
            by_joint[3 * row],
            by_joint[3 * row + 1],
            by_joint[3 * row + 2],
        ];
        let by_position = by_joint[9 + row];
        for column in 0..3 {
            let sum = by_position.mul_add(offset[column], by_parent[3 * row + column]);
            let sum = a.mul_add(rotation[3 * column], sum);
            let sum = b.mul_add(rotation[3 * column + 1], sum);
            by_parent[3 * row + column] = c.mul_add(rotation[3 * column + 2], sum);
        }
        by_parent[9 + row] = by_parent[9 + row] + by_position;
    }
}
