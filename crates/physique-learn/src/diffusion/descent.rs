//! Guidance by losses: predictions are moved against gradients while sampling.

use burn::tensor::Tensor;

use super::BatchEdit;
use crate::Error;
use crate::motion_loss::{MotionLoss, WeightedLoss};
use crate::tensors::{numbers, tensor};

/// Times that all losses are descended in a step.
const ROUNDS: usize = 3;

/// Most that a number changes in a round, in deviations.
const MOST: f32 = 0.5;

/// Times that a step is halved before it is given up.
const HALVINGS: usize = 3;

/// Share of what the slope promises that a step must keep (Armijo, 1966).
const KEPT: f64 = 0.1;

/// Standard deviation of the smoothing of gradients over time, in frames.
const SMOOTHING: f32 = 2.0;

/// Predictions of clean motions, `[batch][frames][columns]`, moved towards less of each loss.
///
/// A loss L with gradient g moves a motion by `strength * weight * L / (g . Sg) * Sg`: for weight 1
/// Polyak's step, which would end a loss that is even; losses of any unit and size are treated
/// alike, and one that is 0 moves nothing. Losses that cannot end, such as that of feet that rightly
/// move, would be overshot: a step that does not lower its loss is halved, at last given up. S smooths
/// over time, so that motions stay as smooth as they were, and leaves alone what is kept by an edit.
/// Each motion is moved by itself.
///
/// # Errors
/// Those of the losses.
pub(crate) fn descend(
    clean: Tensor<3>,
    lengths: &[usize],
    guides: &[WeightedLoss],
    strength: f64,
    edit: Option<&BatchEdit>,
) -> Result<Tensor<3>, Error> {
    let shape = clean.dims();
    let device = clean.device();
    let made = edit.map(|edit| numbers(edit.made())).transpose()?;
    let mut motions = numbers(clean)?;
    let guides = guides.iter().filter(|guide| guide.weight() > 0.0);
    let guides: Vec<_> = guides.collect();
    for _ in 0..ROUNDS {
        for guide in &guides {
            let descent = Descent {
                loss: guide.loss().as_ref(),
                share: strength * guide.weight(),
                shape,
                lengths,
                made: made.as_deref(),
            };
            descent.step(&mut motions)?;
        }
    }
    Ok(tensor(motions, shape, &device))
}

/// What a step down a loss needs to know.
struct Descent<'a> {
    loss: &'a dyn MotionLoss,
    /// Of Polyak's step.
    share: f64,
    shape: [usize; 3],
    lengths: &'a [usize],
    /// 1 for numbers that may move, 0 for others; all may, where there is none.
    made: Option<&'a [f32]>,
}

impl Descent<'_> {
    fn step(&self, motions: &mut [f32]) -> Result<(), Error> {
        let [_, frames, columns] = self.shape;
        let found = self.loss.evaluate(motions, frames, self.lengths)?;
        let mut gradient = found.gradient;
        self.hold(&mut gradient);
        let mut way = smoothed(&gradient, self.lengths, self.shape);
        self.hold(&mut way);
        let size = frames * columns;
        let by_motion = gradient.chunks_exact(size).zip(way.chunks_exact(size));
        let mut steps: Vec<Step> = by_motion
            .zip(&found.losses)
            .map(|((gradient, way), &loss)| Step::new(gradient, way, loss, self.share))
            .collect();
        for _ in 0..=HALVINGS {
            let mut tried = motions.to_vec();
            let ways = way.chunks_exact(size).zip(&steps);
            for (motion, (way, step)) in tried.chunks_exact_mut(size).zip(ways) {
                step.take(motion, way);
            }
            let losses = self.loss.evaluate(&tried, frames, self.lengths)?.losses;
            let pairs = motions.chunks_exact_mut(size).zip(tried.chunks_exact(size));
            for ((motion, tried), (step, loss)) in pairs.zip(steps.iter_mut().zip(losses)) {
                if step.is_kept(loss) {
                    motion.copy_from_slice(tried);
                    *step = Step::NONE;
                }
                step.length *= 0.5;
            }
            if steps.iter().all(|step| step.length <= 0.0) {
                break;
            }
        }
        Ok(())
    }

    /// Takes out what an edit keeps.
    fn hold(&self, numbers: &mut [f32]) {
        for (number, made) in numbers.iter_mut().zip(self.made.into_iter().flatten()) {
            *number *= made;
        }
    }
}

/// A step of one motion.
#[derive(Clone, Copy)]
struct Step {
    /// Of the way; 0 where there is nothing to do, or no longer.
    length: f32,
    slope: f64,
    loss: f64,
}

impl Step {
    const NONE: Self = Self {
        length: 0.0,
        slope: 0.0,
        loss: 0.0,
    };

    fn new(gradient: &[f32], way: &[f32], loss: f32, share: f64) -> Self {
        let loss = f64::from(loss);
        let slope = sum(gradient.iter().zip(way).map(|(by, way)| by * way));
        if loss <= 0.0 || slope <= 0.0 {
            return Self::NONE;
        }
        let most = way.iter().fold(0.0, |most: f32, way| most.max(way.abs()));
        Self {
            length: ((share * loss / slope) as f32).min(MOST / most),
            slope,
            loss,
        }
    }

    fn take(&self, motion: &mut [f32], way: &[f32]) {
        if self.length > 0.0 {
            for (number, way) in motion.iter_mut().zip(way) {
                *number -= self.length * way;
            }
        }
    }

    /// Whether the loss behind the step is low enough for it.
    fn is_kept(&self, loss: f32) -> bool {
        let promised = f64::from(self.length) * self.slope;
        self.length > 0.0 && f64::from(loss) <= self.loss - KEPT * promised
    }
}

fn sum(numbers: impl Iterator<Item = f32>) -> f64 {
    numbers.map(f64::from).sum()
}

/// Each column under a Gaussian over the motion's own frames: a symmetric, positive product, so
/// that what descends still does.
fn smoothed(gradient: &[f32], lengths: &[usize], [_, frames, columns]: [usize; 3]) -> Vec<f32> {
    let reach = (3.0 * SMOOTHING) as usize;
    let bell = |far: usize| (-0.5 * (far as f32 / SMOOTHING).powi(2)).exp();
    let bell: Vec<f32> = (0..=reach).map(bell).collect();
    let mut smoothed = vec![0.0; gradient.len()];
    for (motion, &length) in lengths.iter().enumerate() {
        let row = |frame: usize| (motion * frames + frame) * columns;
        for frame in 0..length {
            let to = &mut smoothed[row(frame)..][..columns];
            for other in frame.saturating_sub(reach)..(frame + reach + 1).min(length) {
                let weight = bell[frame.abs_diff(other)];
                for (to, from) in to.iter_mut().zip(&gradient[row(other)..][..columns]) {
                    *to += weight * from;
                }
            }
        }
    }
    smoothed
}

#[cfg(test)]
mod tests {
    use burn::tensor::{Device, Tensor};

    use super::descend;
    use crate::Error;
    use crate::motion_loss::{LossAndGradient, MotionLoss, WeightedLoss};
    use crate::tensors::numbers;

    /// How far numbers are from 1, and 5 more that nothing can be done about.
    #[derive(Debug)]
    struct NeverEnds;

    impl MotionLoss for NeverEnds {
        fn evaluate(
            &self,
            motions: &[f32],
            frames: usize,
            lengths: &[usize],
        ) -> Result<LossAndGradient, Error> {
            let far = |number: &f32| ((number - 1.0).powi(2) + 0.01).sqrt();
            let motions_apart = motions.chunks_exact(motions.len() / lengths.len());
            assert!(motions_apart.len() == lengths.len() && frames > 0);
            let loss = |motion: &[f32]| 5.0 + motion.iter().map(far).sum::<f32>();
            Ok(LossAndGradient {
                losses: motions_apart.map(loss).collect(),
                gradient: motions
                    .iter()
                    .map(|number| (number - 1.0) / far(number))
                    .collect(),
            })
        }
    }

    /// Polyak's step would go past the best and end higher than it began.
    #[test]
    fn losses_that_cannot_end_are_not_overshot() {
        let starts = [0.9, 4.0];
        let made = |weight: f64| {
            let clean = starts.map(|start| [[start; 2]; 3]);
            let clean = Tensor::<3>::from_data(clean, &Device::flex());
            let guide = WeightedLoss::new("never ends", weight, NeverEnds).expect("a weight");
            let made = descend(clean, &[3, 3], &[guide], 1.0, None).expect("finite");
            numbers(made).expect("finite")
        };
        for weight in [0.01, 1.0, 100.0] {
            let made = made(weight);
            let found = NeverEnds.evaluate(&made, 3, &[3, 3]).expect("finite");
            for (start, loss) in starts.into_iter().zip(found.losses) {
                let before = 5.0 + 6.0 * ((start - 1.0_f32).powi(2) + 0.01).sqrt();
                assert!(loss < before, "weight {weight}, {start}: {before} {loss}");
            }
        }
        assert_eq!(made(0.0), [[0.9; 6], [4.0; 6]].concat());
    }
}
