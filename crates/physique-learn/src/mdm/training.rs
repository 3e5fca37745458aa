//! A motion diffusion model as a task for the trainer.

use burn::tensor::{Device, Tensor};
use physique_motion::features::FeatureLayout;
use physique_motion::features::FeatureStatistics;

use super::losses::{FrameMask, squared_error, velocity_error};
use super::rotation_losses::{foot_contact_error, joint_error, rotation_velocity_error};
use super::{Condition, Mdm, MdmQuery, MdmTraining, RotationSkeleton};
use crate::Error;
use crate::diffusion::{Schedule, add_noise};
use crate::layers::Dropout;
use crate::motion_loss::WeightedLoss;
use crate::random::Random;
use crate::tensors::tensor;
use crate::trainer::{BatchCondition, Loss, MotionBatch, MotionSource, Part, Task};

/// Told apart from all other uses of a seed.
const PURPOSE: u64 = 0x006D_646D_6D64;

/// Trains a motion diffusion model on motions.
#[derive(Debug)]
pub struct MdmTask<S> {
    source: S,
    training: MdmTraining,
    schedule: Schedule,
    motions: Representation,
    motion_losses: Vec<WeightedLoss>,
}

/// What the columns of motions are.
#[derive(Debug)]
enum Representation {
    Features {
        layout: FeatureLayout,
        /// Deviations of joints' positions over those of their velocities.
        velocity_factor: f64,
    },
    Rotations(RotationSkeleton),
}

/// The parts of a loss by name, and their weighted sum.
struct Sum {
    total: Tensor<1>,
    parts: Vec<(&'static str, Tensor<1>)>,
}

impl Sum {
    fn add(&mut self, name: &'static str, weight: f64, part: Tensor<1>) {
        self.total = self.total.clone() + part.clone() * weight;
        self.parts.push((name, part));
    }
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
    /// are of different features; those of the embedded body's self-intersection.
    pub fn new(
        source: S,
        statistics: &FeatureStatistics,
        training: MdmTraining,
    ) -> Result<Self, Error> {
        training.check()?;
        training.check_features()?;
        let columns = statistics.mean().len();
        if source.columns() != columns {
            let expected = format!("{columns} columns, as of the statistics");
            return Err(Error::input("Motions", expected, source.columns()));
        }
        let layout = FeatureLayout::of(statistics.skeleton());
        let deviation = |column: usize| f64::from(statistics.deviation()[column]);
        let velocity_factor =
            deviation(layout.positions.start) / deviation(layout.velocities.start);
        Ok(Self {
            schedule: training.schedule()?,
            motions: Representation::Features {
                layout,
                velocity_factor,
            },
            motion_losses: training.motion_losses(statistics)?,
            training,
            source,
        })
    }

    /// A task for motions that are rotations, not normalised, as MDM's models of actions have them.
    ///
    /// # Errors
    /// [`Error::Setting`] for settings that cannot be, or that are for features; [`Error::Input`]
    /// when source and skeleton are of different motions.
    pub fn of_rotations(
        source: S,
        skeleton: RotationSkeleton,
        training: MdmTraining,
    ) -> Result<Self, Error> {
        training.check()?;
        training.check_rotations()?;
        let columns = skeleton.columns();
        if source.columns() != columns {
            let expected = format!("{columns} columns, as of the skeleton");
            return Err(Error::input("Motions", expected, source.columns()));
        }
        Ok(Self {
            schedule: training.schedule()?,
            motions: Representation::Rotations(skeleton),
            motion_losses: Vec::new(),
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
        let Representation::Features { layout, .. } = &self.motions else {
            return None;
        };
        if weight == 1.0 {
            return None;
        }
        let columns = self.source.columns();
        let mut weights = vec![1.0; columns];
        weights[..=layout.root_height].fill(weight as f32);
        Some(tensor(weights, [1, 1, columns], device))
    }

    /// Everything that is made small, of predicted and clean motions.
    fn sum(&self, predicted: Tensor<3>, clean: Tensor<3>, lengths: &[usize]) -> Result<Sum, Error> {
        let frames = clean.dims()[1];
        let mask = FrameMask::new(lengths, frames, &clean);
        let weights = self.column_weights(&clean.device());
        let error = squared_error(predicted.clone(), clean.clone(), &mask, weights).mean();
        let mut sum = Sum {
            total: error.clone(),
            parts: vec![("squared_error", error)],
        };
        let weight = self.training.velocity_weight;
        match &self.motions {
            Representation::Features {
                layout,
                velocity_factor,
            } if weight > 0.0 => {
                let (predicted, columns) = (predicted.clone(), layout.positions.clone());
                let error = velocity_error(predicted, clean, &mask, columns, *velocity_factor)?;
                sum.add("velocity_error", weight, error.mean());
            }
            Representation::Features { .. } => {}
            Representation::Rotations(skeleton) => {
                self.add_rotation_losses(&mut sum, skeleton, [predicted.clone(), clean], &mask)?;
            }
        }
        for term in &self.motion_losses {
            let mean = term.mean(predicted.clone(), lengths);
            sum.add(term.name(), term.weight(), mean);
        }
        Ok(sum)
    }

    /// The published geometric losses, of predicted and clean motions.
    fn add_rotation_losses(
        &self,
        sum: &mut Sum,
        skeleton: &RotationSkeleton,
        motions: [Tensor<3>; 2],
        mask: &FrameMask,
    ) -> Result<(), Error> {
        let MdmTraining {
            velocity_weight,
            joint_weight,
            foot_contact_weight,
            ..
        } = self.training;
        if velocity_weight > 0.0 {
            let [predicted, clean] = motions.clone();
            let error = rotation_velocity_error(skeleton, predicted, clean, mask)?;
            sum.add("velocity_error", velocity_weight, error.mean());
        }
        if joint_weight == 0.0 && foot_contact_weight == 0.0 {
            return Ok(());
        }
        let [predicted, clean] = motions.map(|motions| skeleton.positions(motions));
        if joint_weight > 0.0 {
            let error = joint_error(predicted.clone(), clean.clone(), mask);
            sum.add("joint_error", joint_weight, error.mean());
        }
        if foot_contact_weight > 0.0 {
            let error = foot_contact_error(predicted, clean, mask)?;
            sum.add("foot_contact_error", foot_contact_weight, error.mean());
        }
        Ok(())
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
        let mut batch = batch.only(range, columns);
        let context = match network.config().context() {
            0 => None,
            frames => {
                let (context, rest) = batch.behind(frames, columns)?;
                batch = rest;
                Some(tensor(
                    context,
                    [batch.lengths.len(), frames, columns],
                    &device,
                ))
            }
        };
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
            context,
        };
        let dropout = Dropout::training(network.config().dropout, seed, step);
        let dropout = dropout.of_part(first as u64);
        let predicted = network.forward(query, &dropout)?;

        let Sum { total, parts } = self.sum(predicted, noised.clean, &batch.lengths)?;
        Ok(Loss { total, parts })
    }
}
