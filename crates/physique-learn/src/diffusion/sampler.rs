//! From noise to motion, step by step.

use burn::tensor::Tensor;

use super::{NoiseStreams, Schedule};
use crate::Error;

/// How a step is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Draws from the posterior, as MDM does (Ho et al. 2020, algorithm 2).
    Ancestral,
    /// Song, Meng and Ermon, "Denoising Diffusion Implicit Models", 2021, equation 12.
    Ddim {
        /// Share of the ancestral noise: 0 makes sampling a function of its start.
        eta: f64,
    },
}

/// Walks a schedule from its last step to its first.
#[derive(Clone, Debug)]
pub struct Sampler {
    schedule: Schedule,
    method: Method,
}

impl Sampler {
    /// A sampler of a schedule.
    pub const fn new(schedule: Schedule, method: Method) -> Self {
        Self { schedule, method }
    }

    /// The schedule that is walked.
    pub const fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// From pure noise to clean motions.
    ///
    /// `denoise` is given noisy motions and the step as the network counts it, and predicts the
    /// clean ones.
    ///
    /// # Errors
    /// Those of `denoise`.
    pub fn sample(
        &self,
        noise: &NoiseStreams,
        mut denoise: impl FnMut(Tensor<3>, usize) -> Result<Tensor<3>, Error>,
    ) -> Result<Tensor<3>, Error> {
        let mut noisy = noise.start();
        for step in (0..self.schedule.len()).rev() {
            let clean = denoise(noisy.clone(), self.schedule.network_step(step))?;
            noisy = self.step(step, noisy, clean, || noise.at(step));
        }
        Ok(noisy)
    }

    /// One step down, from x_t and the prediction of x_0; `noise` is asked where the step needs any.
    ///
    /// # Panics
    /// When there is no such step.
    pub fn step(
        &self,
        step: usize,
        noisy: Tensor<3>,
        clean: Tensor<3>,
        noise: impl FnOnce() -> Tensor<3>,
    ) -> Tensor<3> {
        match self.method {
            Method::Ancestral => {
                let posterior = self.schedule.posterior(step);
                let mean = clean * posterior.from_clean + noisy * posterior.from_noisy;
                if step == 0 {
                    return mean;
                }
                mean + noise() * (0.5 * posterior.log_variance).exp()
            }
            Method::Ddim { eta } => {
                let kept = self.schedule.kept()[step];
                let before = self.schedule.kept_before(step);
                let spread = ((1.0 - before) / (1.0 - kept) * (1.0 - kept / before)).sqrt();
                let sigma = eta * spread;
                // The noise that is in x_t, if the prediction is right.
                let found =
                    (noisy * (1.0 / kept).sqrt() - clean.clone()) / (1.0 / kept - 1.0).sqrt();
                let towards = (1.0 - before - sigma * sigma).max(0.0).sqrt();
                let mean = clean * before.sqrt() + found * towards;
                if step == 0 || sigma == 0.0 {
                    return mean;
                }
                mean + noise() * sigma
            }
        }
    }
}
