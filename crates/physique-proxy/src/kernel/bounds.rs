//! Boxes around quads and groups, and the half squared lengths that the pair tests need.

use super::Workspace;
use super::workspace::Bounds;
use crate::lanes::{Lanes, Simd};
use crate::plan::Plan;

/// Returns 0 in lanes whose spheres are all finite, else NaN.
#[inline(always)]
pub(super) fn bound<S: Simd>(simd: S, plan: &Plan, work: &mut Workspace<S::Lanes>) -> S::Lanes {
    let (half, zero) = (simd.splat(0.5), simd.splat(0.0));
    let (low, high) = (simd.splat(f32::MIN), simd.splat(f32::MAX));
    let nothing = [[high; 3], [low; 3]];
    let mut poison = zero;
    for (group, group_bounds) in plan.groups.iter().zip(&mut work.group_bounds) {
        let mut around_group = nothing;
        for quad in usize::from(group.start)..usize::from(group.end) {
            let places = &plan.quads[quad];
            let places = usize::from(places.start)..usize::from(places.end);
            let mut around = nothing;
            let spheres = work.spheres[places.clone()].iter_mut();
            for (sphere, &reach) in spheres.zip(&plan.reach[places]) {
                let [x, y, z, half_square] = sphere;
                let square = x.mul_add(*x, y.mul_add(*y, *z * *z));
                *half_square = square * half;
                poison = square.mul_add(zero, poison);
                let reach = simd.splat(reach);
                for (axis, centre) in [*x, *y, *z].into_iter().enumerate() {
                    around[0][axis] = around[0][axis].min(centre - reach);
                    around[1][axis] = around[1][axis].max(centre + reach);
                }
            }
            work.quad_bounds[quad] = around;
            around_group = union::<S>(around_group, around);
        }
        *group_bounds = around_group;
    }
    poison
}

#[inline(always)]
fn union<S: Simd>(mut a: Bounds<S::Lanes>, b: Bounds<S::Lanes>) -> Bounds<S::Lanes> {
    for axis in 0..3 {
        a[0][axis] = a[0][axis].min(b[0][axis]);
        a[1][axis] = a[1][axis].max(b[1][axis]);
    }
    a
}

/// Whether two boxes overlap in any frame.
#[inline(always)]
pub(super) fn overlap<L: Lanes>(a: &Bounds<L>, b: &Bounds<L>) -> bool {
    let axis = |axis: usize| a[0][axis].less(b[1][axis]) & b[0][axis].less(a[1][axis]);
    L::any(axis(0) & axis(1) & axis(2))
}
