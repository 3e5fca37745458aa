//! From 16,000 pairs of spheres to those that touch: a pipeline of filters.
//!
//! Each filter writes every candidate to the end of its list and moves the end only past survivors:
//! no branch that a processor could guess wrong. Survivors of the last filter touch, or nearly so,
//! in at least one frame of the tile; they are measured in [`super::contacts`].

use super::bounds::overlap;
use super::contacts::{self, Slopes};
use super::workspace::{Bounds, Workspace};
use crate::Penalty;
use crate::lanes::{Lanes, Simd};
use crate::plan::{Plan, QUAD};

/// The loss; with `GRADIENT`, also its derivatives by the spheres, and with `SHAPE` those by the
/// radii, but for a factor.
#[inline(always)]
pub(super) fn pairs<S: Simd, const GRADIENT: bool, const SHAPE: bool>(
    simd: S,
    plan: &Plan,
    work: &mut Workspace<S::Lanes>,
    penalty: Penalty,
) -> S::Lanes {
    if GRADIENT {
        work.by_spheres.fill([simd.splat(0.0); 3]);
    }
    if SHAPE {
        work.by_reaches.fill(simd.splat(0.0));
    }
    let group_pairs = filter_groups(plan, &work.group_bounds, &mut work.group_pairs);
    let quad_pairs = filter_quads(plan, &work.quad_bounds, group_pairs, &mut work.quad_pairs);
    let touching = filter_spheres(simd, plan, &work.spheres, quad_pairs, &mut work.touching);
    let slopes = Slopes {
        by_spheres: &mut work.by_spheres,
        by_reaches: &mut work.by_reaches,
    };
    contacts::measure::<S, GRADIENT, SHAPE>(simd, plan, &work.spheres, touching, penalty, slopes)
}

/// Sixteen answers: bit `4 * row + column` for the spheres of two quads.
pub(super) type Answers = u16;

/// Numbers of the group pairs whose boxes overlap.
#[inline(always)]
fn filter_groups<'a, L: Lanes>(
    plan: &Plan,
    bounds: &[Bounds<L>],
    survivors: &'a mut [u32],
) -> &'a [u32] {
    let mut count = 0;
    for (number, pair) in plan.group_pairs.iter().enumerate() {
        let [a, b] = pair.groups.map(usize::from);
        survivors[count] = number as u32;
        count += usize::from(overlap(&bounds[a], &bounds[b]));
    }
    &survivors[..count]
}

/// Numbers of the quad pairs whose boxes overlap.
#[inline(always)]
fn filter_quads<'a, L: Lanes>(
    plan: &Plan,
    bounds: &[Bounds<L>],
    group_pairs: &[u32],
    survivors: &'a mut [u32],
) -> &'a [u32] {
    let mut count = 0;
    for &group_pair in group_pairs {
        let numbers = plan.group_pairs[group_pair as usize].quad_pairs.clone();
        let quad_pairs = &plan.quad_pairs[numbers.start as usize..numbers.end as usize];
        for (number, quads) in numbers.zip(quad_pairs) {
            let [a, b] = quads.map(usize::from);
            survivors[count] = number;
            count += usize::from(overlap(&bounds[a], &bounds[b]));
        }
    }
    &survivors[..count]
}

/// Quad pairs with spheres that may touch, and which: 4 x 4 at once.
#[inline(always)]
fn filter_spheres<'a, S: Simd>(
    simd: S,
    plan: &Plan,
    spheres: &[[S::Lanes; 4]],
    quad_pairs: &[u32],
    survivors: &'a mut [(u32, Answers)],
) -> &'a [(u32, Answers)] {
    let mut count = 0;
    for &number in quad_pairs {
        let thresholds = &plan.thresholds[number as usize];
        let [rows, columns] = plan.quad_starts[number as usize].map(usize::from);
        let rows = &spheres[rows..][..QUAD];
        let columns = &spheres[columns..][..QUAD];
        let mut answers = 0;
        for (row, &[x, y, z, half_square]) in rows.iter().enumerate() {
            for (column, other) in columns.iter().enumerate() {
                // Half the squared distance: |a|^2 / 2 + |b|^2 / 2 - a . b.
                let half = half_square + other[3];
                let half = x.neg_mul_add(other[0], half);
                let half = y.neg_mul_add(other[1], half);
                let half = z.neg_mul_add(other[2], half);
                let place = row * QUAD + column;
                let near = half.any_less(simd.splat(thresholds[place]));
                answers |= Answers::from(near) << place;
            }
        }
        survivors[count] = (number, answers);
        count += usize::from(answers != 0);
    }
    &survivors[..count]
}
