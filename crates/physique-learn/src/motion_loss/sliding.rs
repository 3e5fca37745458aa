//! Resting feet that move.

use glam::DVec3;
use physique_motion::features::FeatureStatistics;

use super::joints::{FEET, Feet, FeetLoss, evaluate};
use super::{LossAndGradient, MotionLoss};
use crate::Error;

/// How fast feet slide that ought to stand: the mean over frames of
/// `sum over ankles and toes of contact * (sqrt(v^2 + e^2) - e)`, with the horizontal speed `v` to the
/// next frame, in m/s.
///
/// The loss that [`physique::physics::loss::Sliding`] is of sole points, on the joints that
/// features have. Which of them ought to stand, the features say by their contact columns.
#[derive(Clone, Debug)]
pub struct SlidingLoss {
    statistics: FeatureStatistics,
}

impl SlidingLoss {
    /// Speeds far below this cost by their square, those far above by their size; in m/s.
    pub const SOFTNESS: f64 = 0.1;

    /// A loss for features that are normalised by `statistics`.
    pub const fn new(statistics: FeatureStatistics) -> Self {
        Self { statistics }
    }
}

impl FeetLoss for SlidingLoss {
    fn of(&self, feet: &Feet, by_positions: &mut [[DVec3; FEET]]) -> f64 {
        let per_second = feet.frame_seconds.recip();
        let share = 1.0 / feet.positions.len() as f64;
        let mut sum = 0.0;
        let steps = feet.positions.windows(2).zip(&feet.contacts);
        for (frame, (positions, contacts)) in steps.enumerate() {
            for joint in 0..FEET {
                let step = positions[1][joint] - positions[0][joint];
                let velocity = DVec3::new(step.x, 0.0, step.z) * per_second;
                let soft = velocity.length_squared() + Self::SOFTNESS * Self::SOFTNESS;
                let speed = soft.sqrt();
                let weight = share * contacts[joint];
                sum += weight * (speed - Self::SOFTNESS);
                let by_step = velocity * (weight * per_second / speed);
                by_positions[frame + 1][joint] += by_step;
                by_positions[frame][joint] -= by_step;
            }
        }
        sum
    }
}

impl MotionLoss for SlidingLoss {
    fn evaluate(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<LossAndGradient, Error> {
        evaluate(self, &self.statistics, motions, frames, lengths)
    }
}
