//! Training of the joint regressor.

use std::path::Path;

use super::adam::Adam;
use super::options::FitOptions;
use super::{FitObserver, Stage, checkpoint, initial};
use crate::Error;
use crate::random::Random;
use crate::regressor::{Activations, Gradient, JointRegressor};

const INITIAL: u64 = 110;
const ORDER: u64 = 111;

/// A body to fit to: its betas and its 22 normalised rest joints, flat.
pub(crate) struct BodyJoints {
    pub(crate) betas: Vec<f32>,
    pub(crate) joints: Vec<f32>,
}

/// Fits the joint regressor to the bodies by mean squared error; goes on from the checkpoint if
/// there is one.
pub(crate) fn train_joints(
    bodies: &[BodyJoints],
    options: &FitOptions,
    recipe: &str,
    checkpoint_path: &Path,
    observer: &dyn FitObserver,
) -> Result<JointRegressor, Error> {
    let betas = bodies.first().map_or(0, |body| body.betas.len());
    let layout = JointRegressor::layout(betas, options.width)?;
    let outputs = layout.output_count();
    let mut random = Random::new(&[options.seed, INITIAL]);
    let parameters = initial::parameters(&layout, &mut random);
    let mut regressor = JointRegressor::new(layout, parameters)?;
    let mut adam = Adam::new(regressor.network().parameters().len());
    let first = checkpoint::read(checkpoint_path, recipe, regressor.network_mut(), &mut adam)?;

    let mut activations = Activations::default();
    let mut gradient = Gradient::default();
    let (mut inputs, mut slopes) = (Vec::new(), Vec::new());
    for epoch in first.unwrap_or(0)..options.joint_epochs {
        let mut order: Vec<usize> = (0..bodies.len()).collect();
        Random::new(&[options.seed, ORDER, epoch as u64]).shuffle(&mut order);
        let third = options.joint_epochs.div_ceil(3).max(1);
        let rate = options.joint_rate * 0.1_f32.powi((epoch / third) as i32);
        let mut sum = 0.0;
        for batch in order.chunks(options.batch) {
            inputs.clear();
            for beta in 0..betas {
                inputs.extend(batch.iter().map(|&body| bodies[body].betas[beta]));
            }
            let network = regressor.network_mut();
            network.forward(&inputs, batch.len(), &mut activations);
            slopes.clear();
            let share = 2.0 / (outputs * batch.len()) as f32;
            let rows = activations.outputs().chunks(batch.len());
            for (output, row) in rows.enumerate() {
                for (value, &body) in row.iter().zip(batch) {
                    let error = value - bodies[body].joints[output];
                    sum += f64::from(error * error);
                    slopes.push(error * share);
                }
            }
            network.backward(&activations, &slopes, &mut gradient);
            network.update(|parameters| adam.step(parameters, &gradient.parameters, rate));
        }
        let mean = sum / (outputs * bodies.len()).max(1) as f64;
        observer.epoch(Stage::Joints, epoch + 1, mean);
        if epoch + 1 == options.joint_epochs || observer.wants_checkpoint() {
            let network = regressor.network();
            checkpoint::write(checkpoint_path, recipe, epoch + 1, network, &adam)?;
        }
    }
    Ok(regressor)
}
