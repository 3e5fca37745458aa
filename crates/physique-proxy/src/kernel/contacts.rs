//! Spheres that touch: depth, cost, and which way they push each other.

use super::pairs::Answers;
use crate::Penalty;
use crate::lanes::{Lanes, Simd};
use crate::plan::{Plan, QUAD};

/// Measures contacts and returns the sum of their costs.
///
/// With `GRADIENT`, adds the derivatives by the spheres, of half the loss for the squared penalty.
#[inline(always)]
pub(super) fn measure<S: Simd, const GRADIENT: bool>(
    simd: S,
    plan: &Plan,
    spheres: &[[S::Lanes; 4]],
    touching: &[(u32, Answers)],
    penalty: Penalty,
    by_spheres: &mut [[S::Lanes; 3]],
) -> S::Lanes {
    let (zero, one) = (simd.splat(0.0), simd.splat(1.0));
    // Centres that coincide push nowhere.
    let least = simd.splat(f32::MIN_POSITIVE);
    let mut loss = zero;
    for &(number, mut answers) in touching {
        let [rows, columns] = plan.quad_starts[number as usize].map(usize::from);
        while answers != 0 {
            let place = answers.trailing_zeros() as usize;
            answers &= answers - 1;
            let (i, j) = (rows + place / QUAD, columns + place % QUAD);
            let ([ax, ay, az, _], [bx, by, bz, _]) = (spheres[i], spheres[j]);
            let (x, y, z) = (ax - bx, ay - by, az - bz);
            let square = x.mul_add(x, y.mul_add(y, z * z)).max(least);
            let inverse_distance = square.inverse_sqrt();
            let reach = simd.splat(plan.reach[i] + plan.reach[j]);
            let depth = square.neg_mul_add(inverse_distance, reach).max(zero);
            let slope = match penalty {
                Penalty::Squared => {
                    loss = depth.mul_add(depth, loss);
                    depth
                }
                Penalty::Linear => {
                    loss = loss + depth;
                    one.where_positive(depth)
                }
            };
            if GRADIENT {
                let push = slope * inverse_distance;
                let by = &mut by_spheres[i];
                *by = [
                    push.neg_mul_add(x, by[0]),
                    push.neg_mul_add(y, by[1]),
                    push.neg_mul_add(z, by[2]),
                ];
                let by = &mut by_spheres[j];
                *by = [
                    push.mul_add(x, by[0]),
                    push.mul_add(y, by[1]),
                    push.mul_add(z, by[2]),
                ];
            }
        }
    }
    loss
}
