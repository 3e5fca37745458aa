//! The exact GELU, and dropout behind it.

use burn::tensor::Tensor;
use multiversion::multiversion;
use rayon::prelude::*;

use super::dropped::{BLOCK, DropMask};
use super::elementary::{erf, exp};
use super::operation::{Forward, Operation, apply, input};

/// x Phi(x), some of whose numbers are dropped; Hendrycks and Gimpel, "Gaussian Error Linear
/// Units", 2016.
pub(crate) fn dropped_gelu<const D: usize>(values: Tensor<D>, mask: Option<DropMask>) -> Tensor<D> {
    apply(DroppedGelu { mask }, vec![input(values)])
}

#[derive(Debug)]
struct DroppedGelu {
    mask: Option<DropMask>,
}

impl Operation for DroppedGelu {
    fn inputs(&self) -> usize {
        1
    }

    fn forward(&self, inputs: &[&[f32]]) -> Forward {
        let mut output = vec![0.0; inputs[0].len()];
        let blocks = output
            .par_chunks_mut(BLOCK)
            .zip(inputs[0].par_chunks(BLOCK));
        blocks.enumerate().for_each(|(index, (output, input))| {
            gelu(input, output, self.mask.as_ref(), index * BLOCK);
        });
        Forward {
            output,
            kept: Vec::new(),
        }
    }

    fn backward(&self, inputs: &[&[f32]], _: &[f32], by_output: &[f32]) -> Vec<Vec<f32>> {
        let mut by_input = by_output.to_vec();
        let blocks = by_input
            .par_chunks_mut(BLOCK)
            .zip(inputs[0].par_chunks(BLOCK));
        blocks.enumerate().for_each(|(index, (by_input, input))| {
            multiply_slope(input, by_input, self.mask.as_ref(), index * BLOCK);
        });
        vec![by_input]
    }
}

/// The normal distribution's share below x.
#[inline(always)]
fn below(x: f32) -> f32 {
    0.5 + 0.5 * erf(x * std::f32::consts::FRAC_1_SQRT_2)
}

#[multiversion(targets = "simd")]
fn gelu(input: &[f32], output: &mut [f32], mask: Option<&DropMask>, first: usize) {
    for (output, &x) in output.iter_mut().zip(input) {
        *output = x * below(x);
    }
    if let Some(mask) = mask {
        mask.multiply(first, output);
    }
}

#[multiversion(targets = "simd")]
fn multiply_slope(input: &[f32], by: &mut [f32], mask: Option<&DropMask>, first: usize) {
    // 1 / sqrt(2 pi)
    const PEAK: f32 = 0.398_942_3;
    for (by, &x) in by.iter_mut().zip(input) {
        *by *= below(x) + x * PEAK * exp(-0.5 * x * x);
    }
    if let Some(mask) = mask {
        mask.multiply(first, by);
    }
}
