//! Boxes around quads and groups, frame by frame.

use super::Workspace;
use super::workspace::Bounds;
use crate::lanes::{Lanes, Simd};
use crate::plan::{Plan, QUAD};

/// Bounds all quads and groups.
///
/// Returns 0 in lanes whose spheres are all finite, else NaN.
#[inline(always)]
pub(super) fn bound<S: Simd>(simd: S, plan: &Plan, work: &mut Workspace<S::Lanes>) -> S::Lanes {
    let spheres = &work.spheres[..];
    let zero = simd.splat(0.0);
    let mut poison = zero;
    let quad_bounds = &mut work.quad_bounds[..plan.members.len()];
    for quad in 0..plan.members.len() {
        let members = plan.members[quad];
        let mut around = ball(simd, plan, spheres, members[0]);
        poison = spheres[usize::from(members[0])][3].mul_add(zero, poison);
        for member in 1..QUAD {
            let place = members[member];
            union(&mut around, &ball(simd, plan, spheres, place));
            poison = spheres[usize::from(place)][3].mul_add(zero, poison);
        }
        quad_bounds[quad] = around;
    }
    let group_bounds = &mut work.group_bounds[..plan.groups.len()];
    for group in 0..plan.groups.len() {
        let quads = usize::from(plan.groups[group].start)..usize::from(plan.groups[group].end);
        let mut around = quad_bounds[quads.start];
        for quad in quads.start + 1..quads.end {
            union(&mut around, &quad_bounds[quad]);
        }
        group_bounds[group] = around;
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
