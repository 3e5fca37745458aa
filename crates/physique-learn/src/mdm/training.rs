//! A motion diffusion model as a task for the trainer.

use burn::tensor::{Device, Tensor};
use physique_motion::features::FeatureLayout;
use physique_motion::features::FeatureStatistics;
use serde::{Deserialize, Serialize};

use super::losses::{FrameMask, squared_error, velocity_error};
use super::{Condition, Mdm, MdmQuery};
use crate::Error;
use crate::diffusion::{Schedule, add_noise};
use crate::layers::Dropout;
use crate::motion_loss::{GroundLoss, SelfIntersectionLoss, SlidingLoss, WeightedLoss};
use crate::random::Random;
use crate::tensors::tensor;
use crate::trainer::{BatchCondition, Loss, MotionBatch, MotionSource, Part, Task};

/// Told apart from all other uses of a seed.
const PURPOSE: u64 = 0x006D_646D_6D64;

/// How a motion diffusion model is trained. The default is as published.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MdmTraining {
    /// Motions a step.
    pub batch: usize,
    /// Steps of diffusion.
    pub diffusion_steps: usize,
    /// Factor of the signal-to-noise ratio of every step, see [`Schedule::with_signal`].
    pub signal: f64,
    /// Share of motions that are learnt without their condition, for classifier-free guidance.
    pub unconditioned: f64,
    /// Weight of the squared error in the root's four columns, where that of all others is 1.
    pub root_weight: f64,
    /// Weight of the squared error of how joints' positions change from frame to frame, measured
    /// in deviations of their velocities.
    pub velocity_weight: f64,
    /// Weight of the self-intersection of the predicted motions: lambda_SI of SIA-MDM, 0.01 for
    /// HumanML3D and 0.0001 for KIT; see [`SelfIntersectionLoss`].
    pub self_intersection_weight: f64,
    /// Weight of feet in the ground or above it, see [`GroundLoss`].
    pub ground_weight: f64,
    /// Weight of sliding feet, see [`SlidingLoss`].
    pub sliding_weight: f64,
}

impl Default for MdmTraining {
    fn default() -> Self {
        Self {
            batch: 64,
            diffusion_steps: 1000,
            signal: 1.0,
            unconditioned: 0.1,
            root_weight: 1.0,
            velocity_weight: 0.0,
            self_intersection_weight: 0.0,
            ground_weight: 0.0,
            sliding_weight: 0.0,
        }
    }
}

impl MdmTraining {
    /// The schedule of diffusion.
    ///
    /// # Errors
    /// [`Error::Setting`] for steps or a signal that cannot be.
    pub fn schedule(&self) -> Result<Schedule, Error> {
        Schedule::cosine(self.diffusion_steps)?.with_signal(self.signal)
    }

    fn check(&self) -> Result<(), Error> {
        if self.batch == 0 {
            return Err(Error::setting("batch", "1 or more", self.batch));
        }
        if !(0.0..=1.0).contains(&self.unconditioned) {
            return Err(Error::setting(
                "unconditioned",
                "0 to 1",
                self.unconditioned,
            ));
        }
        for (what, found) in [
            ("root_weight", self.root_weight),
            ("velocity_weight", self.velocity_weight),
            ("self_intersection_weight", self.self_intersection_weight),
            ("ground_weight", self.ground_weight),
            ("sliding_weight", self.sliding_weight),
        ] {
            if !(found.is_finite() && found >= 0.0) {
                return Err(Error::setting(what, "a finite number from 0", found));
            }
        }
        Ok(())
    }

    /// Losses of the predicted motions that have a weight; bodies are the embedded one.
    fn motion_losses(&self, statistics: &FeatureStatistics) -> Result<Vec<WeightedLoss>, Error> {
        let mut losses = Vec::new();
        if self.self_intersection_weight > 0.0 {
            let loss = SelfIntersectionLoss::embedded(statistics)?;
            let weight = self.self_intersection_weight;
            losses.push(WeightedLoss::new("self_intersection", weight, loss)?);
        }
        if self.ground_weight > 0.0 {
            let loss = GroundLoss::new(statistics.clone());
            losses.push(WeightedLoss::new("ground", self.ground_weight, loss)?);
        }
        if self.sliding_weight > 0.0 {
            let loss = SlidingLoss::new(statistics.clone());
            losses.push(WeightedLoss::new("sliding", self.sliding_weight, loss)?);
        }
        Ok(losses)
    }
}

/// Trains a motion diffusion model on motions.
#[derive(Debug)]
pub struct MdmTask<S> {
    source: S,
    training: MdmTraining,
    schedule: Schedule,
    layout: FeatureLayout,
    /// Deviations of joints' positions over those of their velocities.
    velocity_factor: f64,
    motion_losses: Vec<WeightedLoss>,
}

/// Motions of a step with noise, and what there is to know of them.
struct Noised {
    clean: Tensor<3>,
    noisy: Tensor<3>,
    steps: Vec<usize>,
    conditioned: Vec<bool>,
}

impl<S: MotionSource> MdmTask<S> {
    /// A task for networks on a device that differentiates; `statistics` are those that the source's
    /// motions are normalised by.
    ///
    /// # Errors
    /// [`Error::Setting`] for settings that cannot be; [`Error::Input`] when source and statistics
    /// are of different features; those of [`SelfIntersectionLoss::embedded`].
    pub fn new(
        source: S,
        statistics: &FeatureStatistics,
        training: MdmTraining,
    ) -> Result<Self, Error> {
        training.check()?;
        let columns = statistics.mean().len();
        if source.columns() != columns {
            let expected = format!("{columns} columns, as of the statistics");
            return Err(Error::input("Motions", expected, source.columns()));
        }
        let layout = FeatureLayout::of(statistics.skeleton());
        let deviation = |column: usize| f64::from(statistics.deviation()[column]);
        Ok(Self {
            velocity_factor: deviation(layout.positions.start) / deviation(layout.velocities.start),
            schedule: training.schedule()?,
            layout,
            motion_losses: training.motion_losses(statistics)?,
            training,
            source,
        })
    }

    /// The task with one more loss of the predicted motions: a self-intersection of the user's own
    /// body, for instance. Its mean over the batch is added to the total and logged by its name.
    #[must_use]
    pub fn with_loss(mut self, loss: WeightedLoss) -> Self {
        self.motion_losses.push(loss);
        self
    }

    /// Draws a step of diffusion, noise, and whether the condition counts, for each motion: each
    /// from a stream of its own, by its number in the whole batch, which begins at `first`.
    fn noised(&self, batch: &MotionBatch, first: usize, path: [u64; 2], device: &Device) -> Noised {
        let (frames, columns) = (batch.frames, self.source.columns());
        let shape = [batch.lengths.len(), frames, columns];
        let (mut steps, mut conditioned) = (Vec::new(), Vec::new());
        let mut noise = vec![0.0; batch.features.len()];
        for (motion, noise) in noise.chunks_exact_mut(frames * columns).enumerate() {
            let motion = (first + motion) as u64;
            let mut random = Random::new(&[PURPOSE, path[0], path[1], motion]);
            steps.push(random.below(self.schedule.len()));
            conditioned.push(random.unit() >= self.training.unconditioned);
            random.fill_normal(noise);
        }
        let clean = tensor(batch.features.clone(), shape, device);
        let noise = tensor(noise, shape, device);
        Noised {
            noisy: add_noise(&self.schedule, clean.clone(), &steps, noise),
            clean,
            steps,
            conditioned,
        }
    }

    /// `[1][1][columns]`: what columns weigh; `None` where all weigh 1.
    fn column_weights(&self, device: &Device) -> Option<Tensor<3>> {
        let weight = self.training.root_weight;
        if weight == 1.0 {
            return None;
        }
        let columns = self.source.columns();
        let mut weights = vec![1.0; columns];
        weights[..=self.layout.root_height].fill(weight as f32);
        Some(tensor(weights, [1, 1, columns], device))
    }
}

impl<S: MotionSource> Task for MdmTask<S> {
    type Network = Mdm;

    fn loss(&self, network: &Mdm, seed: u64, step: u64) -> Result<Loss, Error> {
        self.part(network, seed, step, Part::WHOLE)
    }

    fn part(&self, network: &Mdm, seed: u64, step: u64, part: Part) -> Result<Loss, Error> {
        let device = network.device();
        let batch = self.source.batch(self.training.batch, seed, step)?;
        let columns = self.source.columns();
        batch.check(columns)?;
        let range = part.range(batch.lengths.len())?;
        let first = range.start;
        let batch = batch.only(range, columns);
        let condition = match &batch.condition {
            BatchCondition::Nothing => Condition::Nothing,
            BatchCondition::Text(embeddings) => Condition::text(embeddings, &device)?,
            BatchCondition::Actions(actions) => Condition::Actions(actions.clone()),
        };
        let noised = self.noised(&batch, first, [seed, step], &device);
        let query = MdmQuery {
            noisy: noised.noisy,
            steps: &noised.steps,
            condition: &condition,
            conditioned: Some(&noised.conditioned),
            lengths: Some(&batch.lengths),
        };
        let dropout = Dropout::training(network.config().dropout, seed, step);
        let dropout = dropout.of_part(first as u64);
        let predicted = network.forward(query, &dropout)?;

        let mask = FrameMask::new(&batch.lengths, batch.frames, &noised.clean);
        let weights = self.column_weights(&device);
        let error = squared_error(predicted.clone(), noised.clean.clone(), &mask, weights).mean();
        let mut parts = vec![("squared_error", error.clone())];
        let mut total = error;
        if self.training.velocity_weight > 0.0 {
            let (columns, factor) = (self.layout.positions.clone(), self.velocity_factor);
            let predicted = predicted.clone();
            let error = velocity_error(predicted, noised.clean, &mask, columns, factor)?.mean();
            total = total + error.clone() * self.training.velocity_weight;
            parts.push(("velocity_error", error));
        }
        for term in &self.motion_losses {
            let mean = term.mean(predicted.clone(), &batch.lengths);
            total = total + mean.clone() * term.weight();
            parts.push((term.name(), mean));
        }
        Ok(Loss { total, parts })
    }
}
