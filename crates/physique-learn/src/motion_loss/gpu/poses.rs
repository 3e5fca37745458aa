//! From features to transforms of joints, a frame a unit.

use cubecl::prelude::*;

use super::memory::{
    BONES, BROKEN, Frame, JOINTS, LOCAL, POSITIONS, SUMS, SWING, SWINGS, TRANSFORM, WEIGHT, WORLD,
};
use super::skeleton;
use super::swing::Swing;
use super::vectors::{Mat3, Vec3, is_finite};

/// Poses the body of every frame.
///
/// `rows` has the frame's row in `features` and the length of its motion; `handed` is -1 where left
/// is at -x in the features.
#[cube(launch)]
pub(super) fn pose(
    features: &[f32],
    statistics: &[f32],
    rows: &[u32],
    skeleton: &[f32],
    hierarchy: &[u32],
    work: &mut [f32],
    count: usize,
    columns: usize,
    handed: f32,
) {
    let at = Frame {
        index: ABSOLUTE_POS,
        count,
    };
    if at.index < count {
        let row = rows[2 * at.index] as usize * columns;
        at.write(
            work,
            WEIGHT,
            1.0f32 / f32::cast_from(rows[2 * at.index + 1]),
        );
        place_joints(
            features, statistics, hierarchy, work, at, row, columns, handed,
        );
        point_bones(hierarchy, work, at);
        swing_joints(skeleton, hierarchy, work, at);
    }
}

/// Writes positions, and whether anything that matters is no number.
#[cube]
fn place_joints(
    features: &[f32],
    statistics: &[f32],
    hierarchy: &[u32],
    work: &mut [f32],
    at: Frame,
    row: usize,
    columns: usize,
    handed: f32,
) {
    let mut broken = 0.0f32;
    for column in 0..skeleton::HEIGHT {
        if !is_finite(features[row + column]) {
            broken = 1.0f32;
        }
    }
    for joint in 0..JOINTS {
        let first = skeleton::source(hierarchy, joint, 0usize);
        let second = skeleton::source(hierarchy, joint, 1usize);
        let first = position(features, statistics, row, columns, first);
        let second = position(features, statistics, row, columns, second);
        let middle = first.add(second).scale(0.5f32);
        if !is_finite(middle.dot(middle)) {
            broken = 1.0f32;
        }
        let middle = Vec3::new(middle.x * handed, middle.y, middle.z);
        at.write_vec3(work, POSITIONS + 3 * joint, middle);
    }
    at.write(work, BROKEN, broken);
}

/// A joint of the features, seen from the ground below the root, in the root's heading.
#[cube]
fn position(
    features: &[f32],
    statistics: &[f32],
    row: usize,
    columns: usize,
    joint: usize,
) -> Vec3 {
    let height = skeleton::column_of_height(joint);
    let y = number(features, statistics, row, columns, height);
    let mut x = 0.0f32;
    let mut z = 0.0f32;
    if joint > 0 {
        x = number(features, statistics, row, columns, height - 1);
        z = number(features, statistics, row, columns, height + 1);
    }
    Vec3::new(x, y, z)
}

/// Taken out of its normalisation: `statistics` are means, then deviations.
#[cube]
fn number(features: &[f32], statistics: &[f32], row: usize, columns: usize, column: usize) -> f32 {
    features[row + column] * statistics[columns + column] + statistics[column]
}

/// Writes where bones point, and the body's heading.
#[cube]
fn point_bones(hierarchy: &[u32], work: &mut [f32], at: Frame) {
    at.clear(work, SUMS, 3 * JOINTS);
    for joint in 1..JOINTS {
        let parent = skeleton::parent(hierarchy, joint);
        let end = at.read_vec3(&*work, POSITIONS + 3 * joint);
        let start = at.read_vec3(&*work, POSITIONS + 3 * parent);
        let bone = end.subtract(start).unit();
        at.write_unit(work, BONES + 4 * joint, bone);
        at.add_vec3(work, SUMS + 3 * parent, bone.direction);
    }
    let hips = across(&*work, at, skeleton::LEFT_HIP, skeleton::RIGHT_HIP);
    let shoulders = across(
        &*work,
        at,
        skeleton::LEFT_SHOULDER,
        skeleton::RIGHT_SHOULDER,
    );
    let sum = hips.add(shoulders);
    let forward = Vec3::new(sum.z, 0.0f32, 0.0f32 - sum.x);
    at.write_unit(work, BONES, forward.unit());
}

#[cube]
fn across(work: &[f32], at: Frame, #[comptime] left: usize, #[comptime] right: usize) -> Vec3 {
    let right = at.read_vec3(work, POSITIONS + 3 * right);
    right.subtract(at.read_vec3(work, POSITIONS + 3 * left))
}

/// Writes local rotations and transforms, parents first.
#[cube]
fn swing_joints(skeleton: &[f32], hierarchy: &[u32], work: &mut [f32], at: Frame) {
    let heading = at.read_unit(&*work, BONES);
    let (x, z) = (heading.direction.x, heading.direction.z);
    // Without a heading, as at rest: facing +Z.
    let z = select(heading.inverse_length > 0.0f32, z, 1.0f32);
    let zero = 0.0f32;
    let heading = Mat3 {
        x: Vec3::new(z, zero, x),
        y: Vec3::new(zero, 1.0f32, zero),
        z: Vec3::new(zero - x, zero, z),
    };
    at.write_mat3(work, LOCAL, heading);
    at.write_mat3(work, WORLD, heading);
    at.write_vec3(work, WORLD + 9, skeleton::offset(skeleton, 0usize));
    for joint in 1..JOINTS {
        let parent = WORLD + TRANSFORM * skeleton::parent(hierarchy, joint);
        let above = at.read_mat3(&*work, parent);
        at.write_mat3(work, LOCAL + 9 * joint, Mat3::identity());
        if skeleton::has_rest(skeleton, joint) {
            let rest = skeleton::rest(skeleton, joint);
            let now = at.read_vec3(&*work, SUMS + 3 * joint).unit();
            let swing = Swing::new(rest, now, above);
            swing.write(work, SWINGS + SWING * joint, at);
            at.write_mat3(work, LOCAL + 9 * joint, swing.rotation(rest, above));
        }
        let local = at.read_mat3(&*work, LOCAL + 9 * joint);
        let world = WORLD + TRANSFORM * joint;
        at.write_mat3(work, world, above.product(local));
        let from_parent = above.turn(skeleton::offset(skeleton, joint));
        let place = at.read_vec3(&*work, parent + 9).add(from_parent);
        at.write_vec3(work, world + 9, place);
    }
}
