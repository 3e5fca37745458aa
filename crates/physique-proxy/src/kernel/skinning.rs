//! Linear blend skinning of sphere centres, and back.

use physique_body::Joint;

use super::Workspace;
use super::vectors::splat;
use super::workspace::Transform;
use crate::lanes::{Lanes, Simd};
use crate::plan::{Blend, Plan};

/// Poses all spheres.
#[inline(always)]
pub(super) fn forward<S: Simd>(simd: S, plan: &Plan, work: &mut Workspace<S::Lanes>) {
    let (world, spheres) = (&work.world_from_joint, &mut work.spheres[..]);
    blend(simd, &plan.blends.one, world, spheres);
    blend(simd, &plan.blends.two, world, spheres);
    blend(simd, &plan.blends.three, world, spheres);
    blend(simd, &plan.blends.four, world, spheres);
}

/// `sum of weight * (rotation * arm + position)` over the joints that a sphere follows.
#[inline(always)]
fn blend<S: Simd, const JOINTS: usize>(
    simd: S,
    blends: &[Blend<JOINTS>],
    world_from_joint: &[Transform<S::Lanes>; Joint::COUNT],
    spheres: &mut [[S::Lanes; 4]],
) {
    for blend in blends {
        let mut sum = [simd.splat(0.0); 3];
        for joint in 0..JOINTS {
            let arm = &blend.arms[joint];
            let transform = &world_from_joint[usize::from(blend.joints[joint])];
            let [x, y, z] = splat(simd, arm.weighted);
            let weight = simd.splat(arm.weight);
            for row in 0..3 {
                let with_x = x.mul_add(transform[3 * row], sum[row]);
                let with_y = y.mul_add(transform[3 * row + 1], with_x);
                let with_z = z.mul_add(transform[3 * row + 2], with_y);
                sum[row] = weight.mul_add(transform[9 + row], with_z);
            }
        }
        let square = sum[0].mul_add(sum[0], sum[1].mul_add(sum[1], sum[2] * sum[2]));
        let half_square = square * simd.splat(0.5);
        spheres[usize::from(blend.sphere)] = [sum[0], sum[1], sum[2], half_square];
    }
}

/// Gathers the derivatives by the joints' transforms from those by the spheres, times `scale`: a
/// joint's twelve sums stay in registers while all spheres that follow it pass by.
#[inline(always)]
pub(super) fn backward<S: Simd>(
    simd: S,
    plan: &Plan,
    work: &mut Workspace<S::Lanes>,
    scale: S::Lanes,
) {
    let by_spheres = &work.by_spheres[..];
    for joint in 0..Joint::COUNT {
        let mut sum = [simd.splat(0.0); 12];
        for influence in &plan.followers[joint] {
            let by_sphere = by_spheres[usize::from(influence.sphere)];
            let arm = splat(simd, influence.arm.weighted);
            let weight = simd.splat(influence.arm.weight);
            for row in 0..3 {
                for column in 0..3 {
                    let place = 3 * row + column;
                    sum[place] = by_sphere[row].mul_add(arm[column], sum[place]);
                }
                sum[9 + row] = by_sphere[row].mul_add(weight, sum[9 + row]);
            }
        }
        for place in 0..12 {
            work.by_world[joint][place] = sum[place] * scale;
        }
    }
}
