//! Layer normalisation.

use burn::tensor::Tensor;
use multiversion::multiversion;
use rayon::prelude::*;

use super::operation::{Forward, Operation, apply, input};

/// Each row with mean 0 and variance 1, times `scale`, plus `offset`.
pub(crate) fn layer_norm<const D: usize>(
    values: Tensor<D>,
    scale: Tensor<1>,
    offset: Tensor<1>,
    epsilon: f32,
) -> Tensor<D> {
    let inputs = vec![input(values), input(scale), input(offset)];
    apply(LayerNormOperation { epsilon }, inputs)
}

#[derive(Debug)]
struct LayerNormOperation {
    /// Added to the variance.
    epsilon: f32,
}

/// Rows that a thread takes in one go.
const ROWS: usize = 64;

/// Sums are taken in so many parts, so that they are vectors, the same ones everywhere.
const PARTS: usize = 16;

impl Operation for LayerNormOperation {
    fn inputs(&self) -> usize {
        3
    }

    /// Keeps mean and inverse deviation of each row.
    fn forward(&self, inputs: &[&[f32]]) -> Forward {
        let [values, scale, offset] = [inputs[0], inputs[1], inputs[2]];
        let width = scale.len();
        let mut output = vec![0.0; values.len()];
        let mut kept = vec![0.0; values.len() / width * 2];
        let blocks = output
            .par_chunks_mut(ROWS * width)
            .zip(values.par_chunks(ROWS * width));
        let blocks = blocks.zip(kept.par_chunks_mut(ROWS * 2));
        blocks.for_each(|((output, values), kept)| {
            normalise(values, scale, offset, self.epsilon, output, kept);
        });
        Forward { output, kept }
    }

    fn backward(&self, inputs: &[&[f32]], kept: &[f32], by_output: &[f32]) -> Vec<Vec<f32>> {
        let [values, scale] = [inputs[0], inputs[1]];
        let width = scale.len();
        let mut by_values = vec![0.0; values.len()];
        let blocks = by_values
            .par_chunks_mut(ROWS * width)
            .zip(values.par_chunks(ROWS * width));
        let blocks = blocks.zip(by_output.par_chunks(ROWS * width));
        let blocks = blocks.zip(kept.par_chunks(ROWS * 2));
        let sums = blocks.map(|(((by_values, values), by_output), kept)| {
            let mut sums = vec![0.0; 2 * width];
            denormalise(values, scale, kept, by_output, by_values, &mut sums);
            sums
        });
        let sums: Vec<Vec<f32>> = sums.collect();
        let mut by_scale = vec![0.0; 2 * width];
        for block in sums {
            for (sum, part) in by_scale.iter_mut().zip(block) {
                *sum += part;
            }
        }
        let by_offset = by_scale.split_off(width);
        vec![by_values, by_scale, by_offset]
    }
}

/// The sum of f(index), in a fixed order.
#[inline(always)]
fn sum(count: usize, f: impl Fn(usize) -> f32) -> f32 {
    let mut parts = [0.0; PARTS];
    let whole = count / PARTS * PARTS;
    for start in (0..whole).step_by(PARTS) {
        for (part, sum) in parts.iter_mut().enumerate() {
            *sum += f(start + part);
        }
    }
    let rest: f32 = (whole..count).map(&f).sum();
    parts.iter().sum::<f32>() + rest
}

#[multiversion(targets = "simd")]
fn normalise(
    values: &[f32],
    scale: &[f32],
    offset: &[f32],
    epsilon: f32,
    output: &mut [f32],
    kept: &mut [f32],
) {
    let width = scale.len();
    let offset = &offset[..width];
    let rows = values
        .chunks_exact(width)
        .zip(output.chunks_exact_mut(width));
    for ((row, output), kept) in rows.zip(kept.as_chunks_mut::<2>().0) {
        let mean = sum(width, |index| row[index]) / width as f32;
        let square = |index: usize| (row[index] - mean) * (row[index] - mean);
        let inverse = (sum(width, square) / width as f32 + epsilon).sqrt().recip();
        for index in 0..width {
            output[index] = (row[index] - mean) * inverse * scale[index] + offset[index];
        }
        *kept = [mean, inverse];
    }
}

/// `sums` are those by the scale, then those by the offset.
#[multiversion(targets = "simd")]
fn denormalise(
    values: &[f32],
    scale: &[f32],
    kept: &[f32],
    by_output: &[f32],
    by_values: &mut [f32],
    sums: &mut [f32],
) {
    let width = scale.len();
    let (by_scale, by_offset) = sums.split_at_mut(width);
    let by_offset = &mut by_offset[..width];
    let rows = values
        .chunks_exact(width)
        .zip(by_output.chunks_exact(width));
    let rows = rows.zip(by_values.chunks_exact_mut(width));
    for (((row, by_output), by_row), &[mean, inverse]) in rows.zip(kept.as_chunks::<2>().0) {
        for index in 0..width {
            let normal = (row[index] - mean) * inverse;
            let by_normal = by_output[index] * scale[index];
            by_scale[index] += by_output[index] * normal;
            by_offset[index] += by_output[index];
            by_row[index] = by_normal;
        }
        let by_mean = sum(width, |index| by_row[index]) / width as f32;
        let along = sum(width, |index| by_row[index] * (row[index] - mean) * inverse);
        let along = along / width as f32;
        for index in 0..width {
            let normal = (row[index] - mean) * inverse;
            by_row[index] = inverse * (by_row[index] - by_mean - normal * along);
        }
    }
}
