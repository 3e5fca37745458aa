//! Feet in the ground, and resting feet above it.

use glam::DVec3;
use physique_motion::features::FeatureStatistics;

use super::joints::{FEET, Feet, FeetLoss, evaluate};
use super::{LossAndGradient, MotionLoss};
use crate::Error;

/// How deep ankles and toes are in the ground, and how high resting feet are above it: the mean over
/// frames of `sum over joints of (depth^2 + contact * excess^2)`, in cm2.
///
/// The ground is at 0, where features have their lowest joint. A foot is as high as its toes; what
/// rests may be [`GroundLoss::REST`] above the ground, because soles are below joints.
#[derive(Clone, Debug)]
pub struct GroundLoss {
    statistics: FeatureStatistics,
}

impl GroundLoss {
    /// Height of resting toes that is free, in metres.
    pub const REST: f64 = 0.05;

    /// A loss for features that are normalised by `statistics`.
    pub const fn new(statistics: FeatureStatistics) -> Self {
        Self { statistics }
    }
}

/// Squared centimetres in a squared metre.
const CM2: f64 = 1e4;

impl FeetLoss for GroundLoss {
    fn of(&self, feet: &Feet, by_positions: &mut [[DVec3; FEET]]) -> f64 {
        let share = CM2 / feet.positions.len() as f64;
        let mut sum = 0.0;
        let frames = feet.positions.iter().zip(&feet.contacts);
        for ((positions, contacts), by_frame) in frames.zip(by_positions) {
            for joint in 0..FEET {
                let height = positions[joint].y;
                // Ankles of standing feet may be high: on tiptoe.
                let is_toe = joint % 2 == 1;
                let contact = if is_toe { contacts[joint] } else { 0.0 };
                let (depth, excess) = (height.min(0.0), (height - Self::REST).max(0.0));
                sum += share * (depth * depth + contact * excess * excess);
                by_frame[joint].y += 2.0 * share * (depth + contact * excess);
            }
        }
        sum
    }
}

impl MotionLoss for GroundLoss {
    fn evaluate(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<LossAndGradient, Error> {
        evaluate(self, &self.statistics, motions, frames, lengths)
    }
}
