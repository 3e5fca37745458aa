//! From 16,000 pairs of spheres to those that touch: a pipeline of filters.
//!
//! Each filter writes every candidate to the end of its list and moves the end only past survivors:
//! no branch that a processor could guess wrong. Survivors of the last filter touch, or nearly so,
//! in at least one frame of the tile; they are measured in [`super::contacts`].

use super::bounds::overlap;
use super::contacts::{self, Slopes};
use super::workspace::{Bounds, Workspace};
use crate::Penalty;
use crate::lanes::{Answers, Lanes, Simd};
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

#[inline(always)]
pub(super) fn places([a, b]: [u16; 2]) -> [usize; 2] {
    [a.into(), b.into()]
}

/// Numbers of the group pairs whose boxes overlap.
#[inline(always)]
fn filter_groups<'a, L: Lanes>(
    plan: &Plan,
    bounds: &[Bounds<L>],
    survivors: &'a mut [u32],
) -> &'a [u32] {
    let mut count = 0;
    for number in 0..plan.group_pairs.len() {
        let [a, b] = places(plan.group_pairs[number].groups);
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
        let numbers = &plan.group_pairs[group_pair as usize].quad_pairs;
        for number in numbers.start..numbers.end {
            let [a, b] = places(plan.quad_pairs[number as usize]);
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
        let [rows, columns] = places(plan.quad_starts[number as usize]);
        let rows = &spheres[rows..][..QUAD];
        let columns = &spheres[columns..][..QUAD];
        let answers = S::Lanes::gather([
            near(simd, &rows[0], columns, &thresholds[0]),
            near(simd, &rows[1], columns, &thresholds[1]),
            near(simd, &rows[2], columns, &thresholds[2]),
            near(simd, &rows[3], columns, &thresholds[3]),
        ]);
        survivors[count] = (number, answers);
        count += usize::from(answers.any());
    }
    &survivors[..count]
}

/// Which of a quad's spheres one sphere may touch.
#[inline(always)]
fn near<S: Simd>(
    simd: S,
    [x, y, z, half_square]: &[S::Lanes; 4],
    others: &[[S::Lanes; 4]],
    thresholds: &[f32; QUAD],
) -> <S::Lanes as Lanes>::Row {
    let mut beyond = [*x; QUAD];
    for place in 0..QUAD {
        let other = &others[place];
        // Half the squared distance: |a|^2 / 2 + |b|^2 / 2 - a . b.
        let half = *half_square + other[3];
        let half = x.neg_mul_add(other[0], half);
        let half = y.neg_mul_add(other[1], half);
        let half = z.neg_mul_add(other[2], half);
        beyond[place] = half - simd.splat(thresholds[place]);
    }
    S::Lanes::any_negative(beyond)
}
