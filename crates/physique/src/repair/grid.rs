//! Where in time a change is sought: at knots some thirty times a second.
//!
//! A change that keeps velocities near those of the source has nothing to say between them, and
//! recordings at 120 frames a second cost no more than those at 30.

use physique_motion::{FrameRate, Motion};

use super::change::UNKNOWNS;
use crate::Error;

/// Knots are as far apart as whole frames can be without coming below this, in a second.
const KNOTS_A_SECOND: f64 = 24.0;

/// Every so many frames is a knot, the first among them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Grid {
    frames: usize,
    stride: usize,
}

impl Grid {
    pub(super) fn new(frames: usize, rate: FrameRate) -> Self {
        Self {
            frames,
            stride: ((rate.per_second() / KNOTS_A_SECOND) as usize).max(1),
        }
    }

    /// Frames from a knot to the next.
    pub(super) const fn stride(self) -> usize {
        self.stride
    }

    /// Frames of the knots.
    pub(super) fn knots(self) -> impl ExactSizeIterator<Item = usize> + Clone {
        (0..self.frames).step_by(self.stride)
    }

    /// The motion at the knots.
    pub(super) fn at_knots(self, motion: &Motion) -> Result<Motion, Error> {
        if self.stride == 1 {
            return Ok(motion.clone());
        }
        let rate = motion.frame_rate().per_second() / self.stride as f64;
        let root = motion.root_translation();
        let rotations = self
            .knots()
            .flat_map(|frame| motion.frame_rotations(frame).iter().copied());
        Ok(Motion::new(
            FrameRate::new(rate)?,
            motion.shape().cloned(),
            self.knots().map(|frame| root[frame]).collect(),
            rotations.collect(),
        )?)
    }

    /// From a change at the knots to one of every frame: a cubic through neighbouring knots
    /// (Catmull and Rom's), which has their values there and nothing where they have nothing.
    pub(super) fn at_frames(self, change: &[f64]) -> Vec<f64> {
        if self.stride == 1 {
            return change.to_vec();
        }
        let knots = self.knots().len();
        let mut frames = Vec::with_capacity(self.frames * UNKNOWNS);
        for frame in 0..self.frames {
            let (knot, into) = (frame / self.stride, frame % self.stride);
            let t = into as f64 / self.stride as f64;
            let weights = [
                t * (t * (2.0 - t) - 1.0) / 2.0,
                (t * t * (3.0 * t - 5.0) + 2.0) / 2.0,
                t * (t * (4.0 - 3.0 * t) + 1.0) / 2.0,
                t * t * (t - 1.0) / 2.0,
            ];
            let around = [knot.saturating_sub(1), knot, knot + 1, knot + 2];
            let around = around.map(|knot| &change[knot.min(knots - 1) * UNKNOWNS..][..UNKNOWNS]);
            for unknown in 0..UNKNOWNS {
                let terms = weights.iter().zip(around);
                frames.push(terms.map(|(weight, knot)| weight * knot[unknown]).sum());
            }
        }
        frames
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_keeps_its_values_at_the_knots_and_steady_ones_everywhere() {
        let rate = FrameRate::new(120.0).unwrap();
        for frames in [1, 4, 5, 6, 50] {
            let grid = Grid::new(frames, rate);
            let knots: Vec<_> = grid.knots().collect();
            let change: Vec<f64> = (0..knots.len() * UNKNOWNS)
                .map(|place| (place as f64).sin())
                .collect();
            let found = grid.at_frames(&change);
            assert_eq!(found.len(), frames * UNKNOWNS);
            for (knot, &frame) in knots.iter().enumerate() {
                let [found, expected] = [(&found, frame), (&change, knot)]
                    .map(|(values, place)| &values[place * UNKNOWNS..][..UNKNOWNS]);
                for (found, expected) in found.iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-12);
                }
            }
            let steady = grid.at_frames(&vec![0.3; change.len()]);
            assert!(steady.iter().all(|value| (value - 0.3).abs() < 1e-12));
            assert!(
                grid.at_frames(&vec![0.0; change.len()])
                    .iter()
                    .all(|&v| v == 0.0)
            );
        }
    }

    #[test]
    fn common_rates_have_25_to_33_knots_a_second() {
        for fps in [25.0, 30.0, 50.0, 60.0, 90.0, 100.0, 120.0] {
            let grid = Grid::new(1000, FrameRate::new(fps).unwrap());
            let knots = fps / grid.stride as f64;
            assert!((24.0..=34.0).contains(&knots), "{fps}: {knots}");
        }
    }
}
