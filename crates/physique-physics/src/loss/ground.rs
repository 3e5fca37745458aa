//! The skin against the ground.

use glam::DVec3;

use super::{FrameLoss, Window};

/// Squared depth of the skin in the ground: `mean over frames of the mean over skin points of
/// max(0, -height)^2`, in m2, times 10^4 so that a whole body 1 cm deep costs 1.
///
/// Every point in the ground feels it, not only the deepest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Penetration {
    /// Height of the ground, in metres.
    pub ground: f64,
}

/// Squared centimetres in a squared metre.
const CM2: f64 = 1e4;

impl FrameLoss for Penetration {
    fn reach(&self) -> usize {
        0
    }

    fn term(&self, window: &mut Window<'_>, scale: f64) -> f64 {
        let count = window.shaped.skin.len();
        let share = CM2 / count as f64;
        let mut sum = 0.0;
        for point in 0..count {
            let depth = self.ground - window.skin_point(0, point).y;
            if depth > 0.0 {
                sum += share * depth * depth;
                let slope = -2.0 * share * depth * scale;
                window.add_skin_gradient(0, point, DVec3::Y * slope);
            }
        }
        sum
    }
}

/// Squared height of the lowest skin above ground beyond a tolerance, in cm2, in frames that ought
/// to be grounded.
///
/// The lowest skin is a soft minimum, `sum h exp(-sharpness h) / sum exp(-sharpness h)`: several low
/// points feel the gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floating<'a> {
    /// Height of the ground, in metres.
    pub ground: f64,
    /// Height that is free, in metres.
    pub tolerance: f64,
    /// How sharply the lowest point is picked, per metre.
    pub sharpness: f64,
    /// `[frames]` 1 where the source motion is on the ground, 0 where it flies; missing frames
    /// count as grounded.
    pub grounded: &'a [f64],
}

impl Default for Floating<'_> {
    fn default() -> Self {
        Self {
            ground: 0.0,
            tolerance: 0.005,
            sharpness: 200.0,
            grounded: &[],
        }
    }
}

impl FrameLoss for Floating<'_> {
    fn reach(&self) -> usize {
        0
    }

    fn term(&self, window: &mut Window<'_>, scale: f64) -> f64 {
        let weight = self.grounded.get(window.frame).copied().unwrap_or(1.0);
        if weight == 0.0 {
            return 0.0;
        }
        let heights: Vec<_> = (0..window.shaped.skin.len())
            .map(|point| window.skin_point(0, point).y - self.ground)
            .collect();
        // Shifted by the lowest: no exponential overflows.
        let least = heights.iter().copied().fold(f64::MAX, f64::min);
        let exponential = |height: f64| (-self.sharpness * (height - least)).exp();
        let total: f64 = heights.iter().map(|&h| exponential(h)).sum();
        let lowest = heights.iter().map(|&h| h * exponential(h)).sum::<f64>() / total;
        let excess = lowest - self.tolerance;
        if excess <= 0.0 {
            return 0.0;
        }
        let slope = 2.0 * CM2 * weight * excess * scale;
        for (point, &height) in heights.iter().enumerate() {
            let share = exponential(height) / total;
            if share > 1e-12 {
                let along = share * (1.0 - self.sharpness * (height - lowest));
                window.add_skin_gradient(0, point, DVec3::Y * (slope * along));
            }
        }
        CM2 * weight * excess * excess
    }
}
