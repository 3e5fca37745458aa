//! Boxes around quads and groups, frame by frame.

use super::Workspace;
use super::workspace::Bounds;
use crate::lanes::{Lanes, Simd};
use crate::plan::Plan;

/// Bounds all quads and groups.
///
/// Returns 0 in lanes whose spheres are all finite, else NaN.
#[inline(always)]
pub(super) fn bound<S: Simd>(simd: S, plan: &Plan, work: &mut Workspace<S::Lanes>) -> S::Lanes {
    let spheres = &work.spheres[..];
    let zero = simd.splat(0.0);
    let mut poison = zero;
    for (members, quad_bounds) in plan.members.iter().zip(&mut work.quad_bounds) {
        let mut around = ball(simd, plan, spheres, members[0]);
        for &place in &members[1..] {
            union(&mut around, &ball(simd, plan, spheres, place));
        }
        for &place in members {
            poison = spheres[usize::from(place)][3].mul_add(zero, poison);
        }
        *quad_bounds = around;
    }
    for (group, group_bounds) in plan.groups.iter().zip(&mut work.group_bounds) {
        let mut around = work.quad_bounds[usize::from(group.start)];
        for quad in &work.quad_bounds[usize::from(group.start) + 1..usize::from(group.end)] {
            union(&mut around, quad);
        }
        *group_bounds = around;
    }
    poison
}

#[inline(always)]
fn ball<S: Simd>(simd: S, plan: &Plan, spheres: &[[S::Lanes; 4]], place: u16) -> Bounds<S::Lanes> {
    let [x, y, z, _] = spheres[usize::from(place)];
    let reach = simd.splat(plan.reach[usize::from(place)]);
    [
        [x - reach, y - reach, z - reach],
        [x + reach, y + reach, z + reach],
    ]
}

/// Grows a box around another.
#[inline(always)]
fn union<L: Lanes>(around: &mut Bounds<L>, other: &Bounds<L>) {
    for axis in 0..3 {
        around[0][axis] = around[0][axis].min(other[0][axis]);
        around[1][axis] = around[1][axis].max(other[1][axis]);
    }
}

/// Whether two boxes overlap in any frame.
#[inline(always)]
pub(super) fn overlap<L: Lanes>(a: &Bounds<L>, b: &Bounds<L>) -> bool {
    let axis = |axis: usize| a[0][axis].below(b[1][axis]) & b[0][axis].below(a[1][axis]);
    L::any(axis(0) & axis(1) & axis(2))
}
