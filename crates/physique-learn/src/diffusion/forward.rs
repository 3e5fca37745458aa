//! From clean to noisy.

use burn::tensor::Tensor;

use super::Schedule;
use crate::tensors::tensor;

/// x_t of clean motions x_0 and noise, `[batch][frames][columns]`, for the step of each motion.
///
/// # Panics
/// When a motion has no step, or one that the schedule does not have.
pub fn add_noise(
    schedule: &Schedule,
    clean: Tensor<3>,
    steps: &[usize],
    noise: Tensor<3>,
) -> Tensor<3> {
    let device = clean.device();
    let factor = |of: fn(f64) -> f64| {
        let factors = steps.iter().map(|&step| of(schedule.kept()[step]) as f32);
        tensor(factors.collect(), [steps.len(), 1, 1], &device)
    };
    clean * factor(f64::sqrt) + noise * factor(|kept| (1.0 - kept).sqrt())
}
