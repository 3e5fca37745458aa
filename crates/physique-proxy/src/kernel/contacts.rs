//! Spheres that touch: depth, cost, and which way they push each other.

use super::pairs::places;
use crate::Penalty;
use crate::lanes::{Answers, Lanes, Simd};
use crate::plan::{Plan, QUAD};

/// Derivatives of the loss, of half the loss for the squared penalty.
pub(super) struct Slopes<'a, L> {
    /// By the centres.
    pub(super) by_spheres: &'a mut [[L; 3]],
    /// By the radii.
    pub(super) by_reaches: &'a mut [L],
}

/// Measures contacts and returns the sum of their costs. With `GRADIENT` and `SHAPE`, adds to the
/// slopes.
#[inline(always)]
pub(super) fn measure<S: Simd, const GRADIENT: bool, const SHAPE: bool>(
    simd: S,
    plan: &Plan,
    spheres: &[[S::Lanes; 4]],
    touching: &[(u32, Answers)],
    penalty: Penalty,
    slopes: Slopes<'_, S::Lanes>,
) -> S::Lanes {
    let Slopes {
        by_spheres,
        by_reaches,
    } = slopes;
    let (zero, one) = (simd.splat(0.0), simd.splat(1.0));
    // Centres that coincide push nowhere.
    let least = simd.splat(f32::MIN_POSITIVE);
    let mut loss = zero;
    for &(number, mut answers) in touching {
        let [rows, columns] = places(plan.quad_starts[number as usize]);
        while let Some(place) = answers.pop() {
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
            if SHAPE {
                by_reaches[i] = by_reaches[i] + slope;
                by_reaches[j] = by_reaches[j] + slope;
            }
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
