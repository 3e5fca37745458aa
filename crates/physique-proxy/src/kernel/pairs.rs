//! From 16,000 pairs of spheres to those that touch: a pipeline of filters.
//!
//! Each filter writes every candidate to the end of its list and moves the end only past survivors:
//! no branch that a processor could guess wrong. Survivors of the last filter touch, or nearly so,
//! in at least one frame of the tile; they are measured in [`super::contacts`].

use super::bounds::overlap;
use super::{Workspace, contacts};
use crate::Penalty;
use crate::lanes::{Lanes, Simd};
use crate::plan::{Plan, QUAD};

/// The loss; with `GRADIENT`, also its derivatives by the spheres, but for a factor.
#[inline(always)]
pub(super) fn pairs<S: Simd, const GRADIENT: bool>(
    simd: S,
    plan: &Plan,
    work: &mut Workspace<S::Lanes>,
    penalty: Penalty,
) -> S::Lanes {
    if GRADIENT {
        work.by_spheres.fill([simd.splat(0.0); 3]);
    }
    let group_pairs = filter_groups(plan, work);
    let quad_pairs = filter_quads(plan, work, group_pairs);
    let mut loss = simd.splat(0.0);
    let mut found = 0;
    for place in 0..quad_pairs {
        found += filter_spheres(simd, plan, work, place, found);
        if found > Workspace::<S::Lanes>::CONTACTS || place + 1 == quad_pairs {
            loss = contacts::measure::<S, GRADIENT>(simd, plan, work, penalty, found, loss);
            found = 0;
        }
    }
    loss
}

/// Numbers of the group pairs whose boxes overlap; returns how many.
#[inline(always)]
fn filter_groups<L: Lanes>(plan: &Plan, work: &mut Workspace<L>) -> usize {
    let mut count = 0;
    for (number, pair) in plan.group_pairs.iter().enumerate() {
        let [a, b] = pair.groups.map(usize::from);
        work.group_pairs[count] = number as u32;
        count += usize::from(overlap(&work.group_bounds[a], &work.group_bounds[b]));
    }
    count
}

/// Numbers of the quad pairs whose boxes overlap; returns how many.
#[inline(always)]
fn filter_quads<L: Lanes>(plan: &Plan, work: &mut Workspace<L>, group_pairs: usize) -> usize {
    let mut count = 0;
    for &group_pair in &work.group_pairs[..group_pairs] {
        let range = &plan.group_pairs[group_pair as usize].quad_pairs;
        let numbers = range.clone();
        let range = range.start as usize..range.end as usize;
        for (number, quads) in numbers.zip(&plan.quad_pairs[range]) {
            let [a, b] = quads.map(usize::from);
            work.quad_pairs[count] = number;
            count += usize::from(overlap(&work.quad_bounds[a], &work.quad_bounds[b]));
        }
    }
    count
}

/// Compares 4 x 4 spheres, and appends those that may touch after `found` others; returns how many.
#[inline(always)]
fn filter_spheres<S: Simd>(
    simd: S,
    plan: &Plan,
    work: &mut Workspace<S::Lanes>,
    place: usize,
    found: usize,
) -> usize {
    let number = work.quad_pairs[place] as usize;
    let thresholds = &plan.thresholds[number];
    let [first, second] = plan.quad_pairs[number].map(|quad| plan.quads[usize::from(quad)].start);
    let rows = &work.spheres[usize::from(first)..][..QUAD];
    let columns = &work.spheres[usize::from(second)..][..QUAD];
    let contacts = &mut work.contacts[found..][..QUAD * QUAD];
    let mut count = 0;
    for (row, &[x, y, z, half_square]) in rows.iter().enumerate() {
        for (column, other) in columns.iter().enumerate() {
            // Half the squared distance: |a|^2 / 2 + |b|^2 / 2 - a . b.
            let half = half_square + other[3];
            let half = x.neg_mul_add(other[0], half);
            let half = y.neg_mul_add(other[1], half);
            let half = z.neg_mul_add(other[2], half);
            let threshold = simd.splat(thresholds[row * QUAD + column]);
            // At most 15 before the last one.
            contacts[count % (QUAD * QUAD)] = [first + row as u16, second + column as u16];
            count += usize::from(S::Lanes::any(half.less(threshold)));
        }
    }
    count
}
