//! Training of the sphere regressor.

use std::path::Path;

use rayon::prelude::*;

use super::adam::Adam;
use super::blocks::SampleFile;
use super::options::FitOptions;
use super::sphere_losses::{LossWorkspace, SphereLosses};
use super::{FitObserver, Stage, checkpoint, initial};
use crate::Error;
use crate::random::Random;
use crate::regressor::{Activations, Gradient, SphereRegressor};

/// Streams of random numbers apart from those of shapes.
const INITIAL: u64 = 100;
const ORDER: u64 = 101;
const BLOCKS: u64 = 102;

/// A body to fit to: its betas and samples.
pub(crate) struct SphereBodySamples {
    pub(crate) betas: Vec<f32>,
    pub(crate) samples: SampleFile,
}

/// Fits the sphere regressor to the bodies; goes on from the checkpoint if there is one.
pub(crate) fn train_spheres(
    bodies: &[SphereBodySamples],
    options: &FitOptions,
    recipe: &str,
    checkpoint_path: &Path,
    observer: &dyn FitObserver,
) -> Result<SphereRegressor, Error> {
    let betas = bodies.first().map_or(0, |body| body.betas.len());
    let layout = SphereRegressor::layout(betas, options.width, options.spheres)?;
    let mut random = Random::new(&[options.seed, INITIAL]);
    let mut parameters = initial::parameters(&layout, &mut random);
    if let (Some(last), Some(middle)) = (layout.layers().last(), middle_body(bodies)) {
        let mut workspace = BatchBody::default();
        middle.samples.read(
            1,
            &mut random,
            &mut workspace.losses.points,
            &mut workspace.bytes,
        )?;
        let spheres = initial::spheres(&workspace.losses.points, options.spheres, &mut random);
        parameters[last.bias.clone()].copy_from_slice(&spheres);
    }
    let mut regressor = SphereRegressor::new(layout, parameters)?;
    let mut adam = Adam::new(regressor.network().parameters().len());
    let first = checkpoint::read(checkpoint_path, recipe, regressor.network_mut(), &mut adam)?;

    let mut step = Step::default();
    step.bodies
        .resize_with(options.batch.min(bodies.len()), BatchBody::default);
    for epoch in first.unwrap_or(0)..options.sphere_epochs {
        let mut order: Vec<usize> = (0..bodies.len()).collect();
        Random::new(&[options.seed, ORDER, epoch as u64]).shuffle(&mut order);
        let rate = learning_rate(options, epoch);
        let mut sum = SphereLosses::default();
        for batch in order.chunks(options.batch) {
            let losses = step.run(bodies, batch, epoch, &regressor, options)?;
            sum.signed_distance += losses.signed_distance;
            sum.emptiness += losses.emptiness;
            sum.overlap += losses.overlap;
            let gradient = &step.gradient.parameters;
            let network = regressor.network_mut();
            network.update(|parameters| adam.step(parameters, gradient, rate));
        }
        let count = bodies.len().max(1) as f64;
        let mean = SphereLosses {
            signed_distance: sum.signed_distance / count,
            emptiness: sum.emptiness / count,
            overlap: sum.overlap / count,
        };
        observer.epoch(Stage::Spheres, epoch + 1, mean.total(&options.losses));
        observer.sphere_losses(epoch + 1, &mean);
        let last = epoch + 1 == options.sphere_epochs;
        if last || observer.wants_checkpoint() {
            let network = regressor.network();
            checkpoint::write(checkpoint_path, recipe, epoch + 1, network, &adam)?;
        }
    }
    Ok(regressor)
}

/// Halved after each quarter of the passes: every 700 of 2,800 in the paper.
fn learning_rate(options: &FitOptions, epoch: usize) -> f32 {
    let quarter = options.sphere_epochs.div_ceil(4).max(1);
    options.sphere_rate * 0.5_f32.powi((epoch / quarter) as i32)
}

/// The body whose betas are nearest to 0.
fn middle_body(bodies: &[SphereBodySamples]) -> Option<&SphereBodySamples> {
    let square = |body: &&SphereBodySamples| body.betas.iter().map(|b| b * b).sum::<f32>();
    bodies.iter().min_by(|a, b| square(a).total_cmp(&square(b)))
}

/// Scratch space of one body of a batch.
#[derive(Default)]
struct BatchBody {
    losses: LossWorkspace,
    bytes: Vec<u8>,
    outputs: Vec<f32>,
    gradient: Vec<f32>,
}

/// Scratch space of a step.
#[derive(Default)]
struct Step {
    bodies: Vec<BatchBody>,
    inputs: Vec<f32>,
    activations: Activations,
    slopes: Vec<f32>,
    gradient: Gradient,
}

impl Step {
    /// Leaves the gradient of the batch's mean loss, and returns the sum of its bodies' losses.
    fn run(
        &mut self,
        bodies: &[SphereBodySamples],
        batch: &[usize],
        epoch: usize,
        regressor: &SphereRegressor,
        options: &FitOptions,
    ) -> Result<SphereLosses, Error> {
        let network = regressor.network();
        let count = batch.len();
        let betas = network.layout().input_count();
        self.inputs.clear();
        for beta in 0..betas {
            let row = batch.iter().map(|&body| bodies[body].betas[beta]);
            self.inputs.extend(row);
        }
        network.forward(&self.inputs, count, &mut self.activations);

        // Bodies are rows of their own for the losses, columns for the network.
        let outputs = self.activations.outputs();
        let width = network.layout().output_count();
        let losses: Vec<SphereLosses> = self.bodies[..count]
            .par_iter_mut()
            .zip(batch)
            .enumerate()
            .map(|(column, (space, &body))| {
                let mut random = Random::new(&[options.seed, BLOCKS, epoch as u64, body as u64]);
                let points = &mut space.losses.points;
                let samples = &bodies[body].samples;
                samples.read(options.thinning(), &mut random, points, &mut space.bytes)?;
                space.outputs.clear();
                space
                    .outputs
                    .extend(outputs.iter().skip(column).step_by(count));
                space.gradient.resize(width, 0.0);
                let (outputs, gradient) = (&space.outputs, &mut space.gradient);
                Ok(space.losses.evaluate(outputs, &options.losses, gradient))
            })
            .collect::<Result<_, Error>>()?;

        let share = (count as f32).recip();
        self.slopes.clear();
        for output in 0..width {
            let row = self.bodies[..count].iter();
            self.slopes
                .extend(row.map(|body| body.gradient[output] * share));
        }
        network.backward(&self.activations, &self.slopes, &mut self.gradient);

        let mut sum = SphereLosses::default();
        for losses in losses {
            sum.signed_distance += losses.signed_distance;
            sum.emptiness += losses.emptiness;
            sum.overlap += losses.overlap;
        }
        Ok(sum)
    }
}
