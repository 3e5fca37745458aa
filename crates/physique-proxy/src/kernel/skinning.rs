//! Linear blend skinning of sphere centres, joint by joint: a joint's transform, or its derivative,
//! stays in registers while all spheres that follow the joint pass by.

use super::Workspace;
use super::workspace::Transform;
use crate::lanes::{Lanes, Simd};
use crate::plan::{Influence, Plan};

#[inline(always)]
pub(super) fn forward<S: Simd>(simd: S, plan: &Plan, work: &mut Workspace<S::Lanes>) {
    let zero = simd.splat(0.0);
    for (followers, transform) in plan.followers.iter().zip(&work.world_from_joint) {
        for influence in &plan.influences[followers.first.clone()] {
            let [x, y, z] = moved(simd, transform, influence, [zero; 3]);
            work.spheres[influence.sphere as usize] = [x, y, z, zero];
        }
    }
    for (followers, transform) in plan.followers.iter().zip(&work.world_from_joint) {
        for influence in &plan.influences[followers.others.clone()] {
            let [x, y, z, _] = work.spheres[influence.sphere as usize];
            let [x, y, z] = moved(simd, transform, influence, [x, y, z]);
            work.spheres[influence.sphere as usize] = [x, y, z, zero];
        }
    }
}

/// `sum + weight * (rotation * arm + position)`.
#[inline(always)]
fn moved<S: Simd>(
    simd: S,
    transform: &Transform<S::Lanes>,
    influence: &Influence,
    sum: [S::Lanes; 3],
) -> [S::Lanes; 3] {
    let [x, y, z] = influence.weighted.map(|number| simd.splat(number));
    let weight = simd.splat(influence.weight);
    let row = |row: usize| {
        let sum = weight.mul_add(transform[9 + row], sum[row]);
        let sum = x.mul_add(transform[3 * row], sum);
        let sum = y.mul_add(transform[3 * row + 1], sum);
        z.mul_add(transform[3 * row + 2], sum)
    };
    [row(0), row(1), row(2)]
}

/// Gathers the derivatives by the joints' transforms from those by the spheres, times `scale`.
#[inline(always)]
pub(super) fn backward<S: Simd>(
    simd: S,
    plan: &Plan,
    work: &mut Workspace<S::Lanes>,
    scale: S::Lanes,
) {
    for (followers, by_world) in plan.followers.iter().zip(&mut work.by_world) {
        let mut sum = [simd.splat(0.0); 12];
        for influence in &plan.influences[followers.first.start..followers.others.end] {
            let by_sphere = work.by_spheres[influence.sphere as usize];
            let arm = influence.weighted.map(|number| simd.splat(number));
            let weight = simd.splat(influence.weight);
            for (row, by_sphere) in by_sphere.into_iter().enumerate() {
                for (column, arm) in arm.into_iter().enumerate() {
                    sum[3 * row + column] = by_sphere.mul_add(arm, sum[3 * row + column]);
                }
                sum[9 + row] = by_sphere.mul_add(weight, sum[9 + row]);
            }
        }
        *by_world = sum.map(|sum| sum * scale);
    }
}
