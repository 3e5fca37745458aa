//! From derivatives by the transforms of joints to those by features, a frame a unit.

use cubecl::prelude::*;

use super::memory::{
    BONES, BY_POSITIONS, BY_SWINGS, BY_WORLD, Frame, JOINTS, LOCAL, POSITIONS, SUMS, SWING, SWINGS,
    TRANSFORM, TURNED, WORLD,
};
use super::skeleton;
use super::swing::Swing;
use super::vectors::{Mat3, Vec3};

/// Writes the rows of `gradient`, which hold zeros before, and the derivative by a turn of each frame.
///
/// `full` says whether the gradient reaches a joint's rotation through those of its parents.
#[cube(launch)]
pub(super) fn pose_back(
    statistics: &[f32],
    rows: &[u32],
    skeleton: &[f32],
    hierarchy: &[u32],
    work: &mut [f32],
    gradient: &mut [f32],
    count: usize,
    columns: usize,
    handed: f32,
    #[comptime] full: bool,
) {
    let at = Frame {
        index: ABSOLUTE_POS,
        count,
    };
    if at.index < count {
        joints_back(skeleton, hierarchy, work, at, full);
        bones_back(hierarchy, work, at);
        let row = rows[2 * at.index] as usize * columns;
        let mut turned = 0.0f32;
        for joint in 0..JOINTS {
            let by = at.read_vec3(&*work, BY_POSITIONS + 3 * joint);
            let position = at.read_vec3(&*work, POSITIONS + 3 * joint);
            turned += position.z * by.x - position.x * by.z;
            // Half to each of the joints that it lies in the middle of.
            let half = Vec3::new(by.x * handed, by.y, by.z).scale(0.5f32);
            let first = skeleton::source(hierarchy, joint, 0usize);
            let second = skeleton::source(hierarchy, joint, 1usize);
            add(statistics, gradient, row, columns, first, half);
            add(statistics, gradient, row, columns, second, half);
        }
        at.write(work, TURNED, turned * handed);
    }
}

/// Adds to the columns of a joint's position.
#[cube]
fn add(
    statistics: &[f32],
    gradient: &mut [f32],
    row: usize,
    columns: usize,
    joint: usize,
    by: Vec3,
) {
    let height = skeleton::column_of_height(joint);
    let deviations = columns + height;
    gradient[row + height] += by.y * statistics[deviations];
    if joint > 0 {
        gradient[row + height - 1] += by.x * statistics[deviations - 1];
        gradient[row + height + 1] += by.z * statistics[deviations + 1];
    }
}

/// From transforms to where bones point, children first.
#[cube]
fn joints_back(
    skeleton: &[f32],
    hierarchy: &[u32],
    work: &mut [f32],
    at: Frame,
    #[comptime] full: bool,
) {
    at.clear(work, BY_SWINGS, 9 * JOINTS);
    at.clear(work, SUMS, 3 * JOINTS);
    for step in 1..JOINTS {
        let joint = JOINTS - step;
        let parent = skeleton::parent(hierarchy, joint);
        let above = at.read_mat3(&*work, WORLD + TRANSFORM * parent);
        let local = at.read_mat3(&*work, LOCAL + 9 * joint);

        let by_world = at.read_mat3(&*work, BY_WORLD + TRANSFORM * joint);
        let by_position = at.read_vec3(&*work, BY_WORLD + TRANSFORM * joint + 9);
        let by_offset = by_position.outer(skeleton::offset(skeleton, joint));
        let by_parent = by_world.product(local.transpose()).add(by_offset);
        at.add_mat3(work, BY_WORLD + TRANSFORM * parent, by_parent);
        at.add_vec3(work, BY_WORLD + TRANSFORM * parent + 9, by_position);

        let by_swings = at.read_mat3(&*work, BY_SWINGS + 9 * joint);
        if comptime!(full) {
            let through = by_swings.product(local.transpose());
            at.add_mat3(work, BY_SWINGS + 9 * parent, through);
        }
        if skeleton::has_rest(skeleton, joint) {
            let swing = Swing::read(&*work, SWINGS + SWING * joint, at);
            // Nothing came through other joints' swings unless the gradient is full.
            let by_local = above.transpose().product(by_world.add(by_swings));
            let by_direction = swing.gradient(skeleton::rest(skeleton, joint), by_local);
            let by_sum = swing.now.gradient(above.turn(by_direction));
            at.write_vec3(work, SUMS + 3 * joint, by_sum);
            if comptime!(full) {
                let by_above = swing.now.direction.outer(by_direction);
                at.add_mat3(work, BY_SWINGS + 9 * parent, by_above);
            }
        }
    }
}

/// From where bones point, and the heading, to positions.
#[cube]
fn bones_back(hierarchy: &[u32], work: &mut [f32], at: Frame) {
    at.clear(work, BY_POSITIONS, 3 * JOINTS);
    for joint in 1..JOINTS {
        let parent = skeleton::parent(hierarchy, joint);
        let by_direction = at.read_vec3(&*work, SUMS + 3 * parent);
        let bone = at.read_unit(&*work, BONES + 4 * joint);
        let by_bone = bone.gradient(by_direction);
        at.add_vec3(work, BY_POSITIONS + 3 * joint, by_bone);
        at.add_vec3(work, BY_POSITIONS + 3 * parent, by_bone.scale(-1.0f32));
    }
    let by_heading = at.read_mat3(&*work, BY_WORLD);
    let by_heading: Mat3 = by_heading.add(at.read_mat3(&*work, BY_SWINGS));
    let by_forward = Vec3::new(
        by_heading.x.z - by_heading.z.x,
        0.0f32,
        by_heading.x.x + by_heading.z.z,
    );
    let by_forward = at.read_unit(&*work, BONES).gradient(by_forward);
    let by_across = Vec3::new(0.0f32 - by_forward.z, 0.0f32, by_forward.x);
    let back = by_across.scale(-1.0f32);
    at.add_vec3(work, BY_POSITIONS + 3 * skeleton::LEFT_HIP, back);
    at.add_vec3(work, BY_POSITIONS + 3 * skeleton::LEFT_SHOULDER, back);
    at.add_vec3(work, BY_POSITIONS + 3 * skeleton::RIGHT_HIP, by_across);
    at.add_vec3(work, BY_POSITIONS + 3 * skeleton::RIGHT_SHOULDER, by_across);
}
