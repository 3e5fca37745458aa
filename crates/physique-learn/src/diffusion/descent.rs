//! Guidance by losses: predictions are moved against gradients while sampling.

use burn::tensor::Tensor;

use super::BatchEdit;
use crate::Error;
use crate::motion_loss::WeightedLoss;
use crate::tensors::{numbers, tensor};

/// Times that all losses are descended in a step.
const ROUNDS: usize = 3;

/// Most that a number changes in a round, in deviations.
const MOST: f32 = 0.5;

/// Standard deviation of the smoothing of gradients over time, in frames.
const SMOOTHING: f32 = 2.0;

/// Predictions of clean motions, `[batch][frames][columns]`, moved towards less of each loss.
///
/// A loss L with gradient g moves a motion by `strength * weight * L / (g . Sg) * Sg`: for weight 1
/// Polyak's step, which would end a loss that is even; losses of any unit and size are treated
/// alike, and one that is 0 moves nothing. S smooths over time, so that motions stay as smooth as
/// they were, and leaves alone what is kept by an edit. Each motion is moved by itself.
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
    let [_, frames, columns] = shape;
    let device = clean.device();
    let made = edit.map(|edit| numbers(edit.made())).transpose()?;
    let mut motions = numbers(clean)?;
    let guides = guides.iter().filter(|guide| guide.weight() > 0.0);
    let guides: Vec<_> = guides.collect();
    for _ in 0..ROUNDS {
        for guide in &guides {
            let found = guide.loss().evaluate(&motions, frames, lengths)?;
            let mut gradient = found.gradient;
            if let Some(made) = &made {
                multiply(&mut gradient, made);
            }
            let mut way = smoothed(&gradient, lengths, shape);
            if let Some(made) = &made {
                multiply(&mut way, made);
            }
            let size = frames * columns;
            let by_motion = gradient.chunks_exact(size).zip(way.chunks_exact(size));
            let moved = motions.chunks_exact_mut(size).zip(&found.losses);
            for ((motion, &loss), (gradient, way)) in moved.zip(by_motion) {
                let slope = sum(gradient.iter().zip(way).map(|(by, way)| by * way));
                let most = way.iter().fold(0.0, |most: f32, way| most.max(way.abs()));
                if loss <= 0.0 || slope <= 0.0 {
                    continue;
                }
                let step = strength * guide.weight() * f64::from(loss) / slope;
                let step = (step as f32).min(MOST / most);
                for (number, way) in motion.iter_mut().zip(way) {
                    *number -= step * way;
                }
            }
        }
    }
    Ok(tensor(motions, shape, &device))
}

fn multiply(numbers: &mut [f32], factors: &[f32]) {
    for (number, factor) in numbers.iter_mut().zip(factors) {
        *number *= factor;
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
