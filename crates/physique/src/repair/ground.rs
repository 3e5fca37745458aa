//! Skin in the ground, and bodies above it.

use glam::DVec3;

use super::figure::{Figure, Pose};
use super::wrench::{Wrenches, posed};

/// A skin point 1 m in the ground, in units of the stiffness.
const DEPTH: f64 = 8e4;
/// A body 1 m above the ground beyond the tolerance.
const HEIGHT: f64 = 4e5;
/// Height above ground that is free, in metres.
const TOLERANCE: f64 = 0.005;
/// How sharply the lowest point is picked, per metre.
const SHARPNESS: f64 = 200.0;
/// Points higher than this all through a stretch of the source cannot reach the ground, in metres,
const OUT_OF_REACH: f64 = 0.12;
/// nor those so far above the lowest.
const ABOVE_LOWEST: f64 = 0.06;
/// Frames of a stretch.
const STRETCH: usize = 16;

/// Which skin can touch the ground when.
pub(super) struct Ground {
    /// `[stretches]` numbers of skin points.
    near: Vec<Vec<usize>>,
    /// `[frames]` whether the source is carried by the ground, or should be.
    grounded: Vec<bool>,
}

impl Ground {
    pub(super) fn of(figure: &Figure, source: &[Pose], grounded: Vec<bool>) -> Self {
        let near = source.chunks(STRETCH).map(|poses| {
            let mut near = vec![false; figure.skin.len()];
            for pose in poses {
                let heights = figure.skin.iter();
                let heights: Vec<_> = heights
                    .map(|point| posed(point, &pose.world_from_rest).y)
                    .collect();
                let lowest = heights.iter().copied().fold(f64::MAX, f64::min);
                let reach = OUT_OF_REACH.max(lowest + ABOVE_LOWEST);
                for (near, height) in near.iter_mut().zip(&heights) {
                    *near |= *height < reach;
                }
            }
            let numbers = near.iter().enumerate();
            numbers
                .filter_map(|(point, &near)| near.then_some(point))
                .collect()
        });
        Self {
            near: near.collect(),
            grounded,
        }
    }

    /// The cost of a frame; pushes its forces.
    pub(super) fn cost(
        &self,
        figure: &Figure,
        frame: usize,
        pose: &Pose,
        weight: f64,
        wrenches: &mut Wrenches,
    ) -> f64 {
        let near = &self.near[frame / STRETCH];
        let world = &pose.world_from_rest;
        let heights: Vec<_> = near
            .iter()
            .map(|&point| posed(&figure.skin[point], world).y)
            .collect();
        let mut cost = 0.0;
        let mut push = |place: usize, force: f64| {
            let point = &figure.skin[near[place]];
            wrenches.push_skin(point, world, DVec3::Y * force);
        };
        for (place, &height) in heights.iter().enumerate() {
            if height < 0.0 {
                cost += 0.5 * weight * DEPTH * height * height;
                push(place, weight * DEPTH * height);
            }
        }
        if !self.grounded.get(frame).copied().unwrap_or(true) {
            return cost;
        }
        // Shifted by the lowest: no exponential overflows.
        let least = heights.iter().copied().fold(f64::MAX, f64::min);
        let exponential = |height: f64| (-SHARPNESS * (height - least)).exp();
        let total: f64 = heights.iter().map(|&h| exponential(h)).sum();
        let lowest = heights.iter().map(|&h| h * exponential(h)).sum::<f64>() / total;
        let excess = lowest - TOLERANCE;
        if excess > 0.0 {
            cost += 0.5 * weight * HEIGHT * excess * excess;
            for (place, &height) in heights.iter().enumerate() {
                let share = exponential(height) / total;
                if share > 1e-9 {
                    let along = share * (1.0 - SHARPNESS * (height - lowest));
                    push(place, weight * HEIGHT * excess * along);
                }
            }
        }
        cost
    }
}
