//! Steps of the optimiser, in place.

use burn::tensor::Tensor;
use multiversion::multiversion;
use rayon::prelude::*;

use super::dropped::BLOCK;
use super::operation::{Change, changed};

/// A step of AdamW with its factors worked out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AdamWStep {
    pub(crate) beta1: f32,
    pub(crate) beta2: f32,
    /// Root of the second moment's bias.
    pub(crate) second_bias: f32,
    pub(crate) epsilon: f32,
    /// Rate over the first moment's bias.
    pub(crate) rate: f32,
    /// Share of a parameter that stays.
    pub(crate) kept: f32,
}

/// Parameter and both moments after a step.
pub(crate) fn adamw(
    parameter: Tensor<1>,
    gradient: Tensor<1>,
    moments: [Tensor<1>; 2],
    step: AdamWStep,
) -> (Tensor<1>, [Tensor<1>; 2]) {
    let [first, second] = moments;
    let [parameter, _, first, second] = changed([parameter, gradient, first, second], step);
    (parameter, [first, second])
}

impl Change for AdamWStep {
    fn apply(&self, [parameter, gradient, first, second]: [&mut [f32]; 4]) {
        let blocks = parameter
            .par_chunks_mut(BLOCK)
            .zip(gradient.par_chunks(BLOCK))
            .zip(first.par_chunks_mut(BLOCK))
            .zip(second.par_chunks_mut(BLOCK));
        blocks.for_each(|(((parameter, gradient), first), second)| {
            step_block(self, parameter, gradient, first, second);
        });
    }
}

#[multiversion(targets = "simd")]
fn step_block(
    step: &AdamWStep,
    parameter: &mut [f32],
    gradient: &[f32],
    first: &mut [f32],
    second: &mut [f32],
) {
    let moments = first.iter_mut().zip(second);
    for ((parameter, gradient), (first, second)) in parameter.iter_mut().zip(gradient).zip(moments)
    {
        *first += (gradient - *first) * (1.0 - step.beta1);
        *second = *second * step.beta2 + gradient * gradient * (1.0 - step.beta2);
        let size = second.sqrt() / step.second_bias + step.epsilon;
        *parameter = *parameter * step.kept - *first / size * step.rate;
    }
}
