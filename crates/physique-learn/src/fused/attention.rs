//! What happens between the two linear layers of self-attention.

use std::sync::Arc;

use burn::tensor::{Shape, Tensor};
use multiversion::multiversion;
use rayon::prelude::*;

use super::dropped::DropMask;
use super::elementary::exp;
use super::operation::{Forward, Operation, apply, input};
use super::product::{Matrix, product};

/// dropout(softmax(Q K^T / sqrt(width))) V by heads, `[batch][frames][width]`, of queries, keys and
/// values side by side, `[batch][frames][3 width]`. Nobody looks where `hidden`,
/// `[batch][frames]`, is true.
///
/// Weights of attention, a square of frames for each head, are never in memory all at once: going
/// back computes them again, which costs less than to write and to read them.
pub(crate) fn attention(
    projected: Tensor<3>,
    heads: usize,
    hidden: Option<Arc<[bool]>>,
    mask: Option<DropMask>,
) -> Tensor<3> {
    let [_, frames, width] = projected.dims();
    let operation = Attention {
        heads,
        frames,
        width: width / 3,
        hidden,
        mask,
    };
    apply(operation, vec![input(projected)])
}

#[derive(Debug)]
struct Attention {
    heads: usize,
    frames: usize,
    /// Of all heads together.
    width: usize,
    hidden: Option<Arc<[bool]>>,
    mask: Option<DropMask>,
}

/// One thread's squares of frames.
#[derive(Clone)]
struct Scratch {
    /// Softmax of scores.
    weights: Vec<f32>,
    /// The same with dropout.
    dropped: Vec<f32>,
    /// Derivatives by the weights.
    by_weights: Vec<f32>,
}

impl Attention {
    fn scratch(&self, squares: usize) -> Scratch {
        let square = |present: bool| vec![0.0; usize::from(present) * self.frames * self.frames];
        Scratch {
            weights: square(true),
            dropped: square(self.mask.is_some()),
            by_weights: square(squares > 1),
        }
    }

    /// Queries, keys and values of a head: columns of one motion's rows.
    fn parts<'a>(&self, rows: &'a [f32], head: usize) -> [Matrix<'a>; 3] {
        let start = head * self.width / self.heads;
        [0, 1, 2].map(|part| Matrix::rows(&rows[part * self.width + start..], 3 * self.width))
    }

    /// Weights of attention of a head, and where there is dropout, those with it.
    fn weigh(&self, motion: usize, head: usize, rows: &[f32], scratch: &mut Scratch) {
        let (frames, width) = (self.frames, self.width / self.heads);
        let [queries, keys, _] = self.parts(rows, head);
        let factor = (width as f64).sqrt().recip() as f32;
        let weights = &mut scratch.weights;
        product(
            [frames, width, frames],
            factor,
            queries,
            keys.transposed(),
            weights,
            frames,
        );
        let hidden = self.hidden.as_ref();
        let hidden = hidden.map(|hidden| &hidden[motion * frames..][..frames]);
        softmax(weights, frames, hidden);
        if let Some(mask) = &self.mask {
            scratch.dropped.copy_from_slice(weights);
            let first = (motion * self.heads + head) * weights.len();
            multiply(mask, first, &mut scratch.dropped);
        }
    }
}

impl Scratch {
    fn used(&self) -> &[f32] {
        if self.dropped.is_empty() {
            &self.weights
        } else {
            &self.dropped
        }
    }
}

impl Operation for Attention {
    fn inputs(&self) -> usize {
        1
    }

    fn shape(&self, projected: Shape) -> Shape {
        Shape::new([projected[0], self.frames, self.width])
    }

    fn forward(&self, inputs: &[&[f32]]) -> Forward {
        let (frames, width) = (self.frames, self.width);
        let mut output = vec![0.0; inputs[0].len() / 3];
        let motions = output
            .par_chunks_mut(frames * width)
            .zip(inputs[0].par_chunks(3 * frames * width));
        motions.enumerate().for_each_init(
            || self.scratch(1),
            |scratch, (motion, (output, rows))| {
                let part = width / self.heads;
                for head in 0..self.heads {
                    self.weigh(motion, head, rows, scratch);
                    let [_, _, values] = self.parts(rows, head);
                    let weights = Matrix::rows(scratch.used(), frames);
                    let output = &mut output[head * part..];
                    product([frames, frames, part], 1.0, weights, values, output, width);
                }
            },
        );
        Forward {
            output,
            kept: Vec::new(),
        }
    }

    fn backward(&self, inputs: &[&[f32]], _: &[f32], by_output: &[f32]) -> Vec<Vec<f32>> {
        let (frames, width) = (self.frames, self.width);
        let mut by_input = vec![0.0; inputs[0].len()];
        let motions = by_input
            .par_chunks_mut(3 * frames * width)
            .zip(inputs[0].par_chunks(3 * frames * width));
        let motions = motions.zip(by_output.par_chunks(frames * width));
        motions.enumerate().for_each_init(
            || self.scratch(2),
            |scratch, (motion, ((by_rows, rows), by_output))| {
                for head in 0..self.heads {
                    self.weigh(motion, head, rows, scratch);
                    self.back(motion, head, [rows, by_output], scratch, by_rows);
                }
            },
        );
        vec![by_input]
    }
}

impl Attention {
    /// Derivatives of a head, when its weights are known.
    fn back(
        &self,
        motion: usize,
        head: usize,
        [rows, by_output]: [&[f32]; 2],
        scratch: &mut Scratch,
        by_rows: &mut [f32],
    ) {
        let (frames, width) = (self.frames, self.width / self.heads);
        let start = head * width;
        let row = 3 * self.width;
        let [queries, keys, values] = self.parts(rows, head);
        let by_output = Matrix::rows(&by_output[start..], self.width);
        let used = Matrix::rows(scratch.used(), frames).transposed();
        let by_values = &mut by_rows[2 * self.width + start..];
        product(
            [frames, frames, width],
            1.0,
            used,
            by_output,
            by_values,
            row,
        );

        let by = &mut scratch.by_weights;
        product(
            [frames, width, frames],
            1.0,
            by_output,
            values.transposed(),
            by,
            frames,
        );
        if let Some(mask) = &self.mask {
            multiply(mask, (motion * self.heads + head) * by.len(), by);
        }
        softmax_back(&scratch.weights, by, frames);

        let factor = (width as f64).sqrt().recip() as f32;
        let by = Matrix::rows(by, frames);
        let by_queries = &mut by_rows[start..];
        product([frames, frames, width], factor, by, keys, by_queries, row);
        let by_keys = &mut by_rows[self.width + start..];
        product(
            [frames, frames, width],
            factor,
            by.transposed(),
            queries,
            by_keys,
            row,
        );
    }
}

#[multiversion(targets = "simd")]
fn multiply(mask: &DropMask, first: usize, values: &mut [f32]) {
    mask.multiply(first, values);
}

/// Each row's exponentials over their sum; 0 where hidden.
#[multiversion(targets = "simd")]
fn softmax(rows: &mut [f32], width: usize, hidden: Option<&[bool]>) {
    for row in rows.chunks_exact_mut(width) {
        if let Some(hidden) = hidden {
            for (score, &hidden) in row.iter_mut().zip(hidden) {
                *score = if hidden { f32::NEG_INFINITY } else { *score };
            }
        }
        let most = fold(row, f32::NEG_INFINITY, |most, score| {
            if score > most { score } else { most }
        });
        for score in row.iter_mut() {
            *score = exp(*score - most);
        }
        if let Some(hidden) = hidden {
            for (weight, &hidden) in row.iter_mut().zip(hidden) {
                *weight = if hidden { 0.0 } else { *weight };
            }
        }
        let inverse = fold(row, 0.0, |sum, weight| sum + weight).recip();
        for weight in row {
            *weight *= inverse;
        }
    }
}

/// From derivatives by the weights to those by the scores.
#[multiversion(targets = "simd")]
fn softmax_back(weights: &[f32], by: &mut [f32], width: usize) {
    let rows = weights.chunks_exact(width).zip(by.chunks_exact_mut(width));
    for (weights, by) in rows {
        for (by, weight) in by.iter_mut().zip(weights) {
            *by *= weight;
        }
        let along = fold(by, 0.0, |sum, by| sum + by);
        for (by, weight) in by.iter_mut().zip(weights) {
            *by -= weight * along;
        }
    }
}

/// Numbers taken together in 16 parts, so that they are vectors, the same ones everywhere.
#[inline(always)]
fn fold(numbers: &[f32], start: f32, join: impl Fn(f32, f32) -> f32) -> f32 {
    let mut parts = [start; 16];
    let (whole, rest) = numbers.as_chunks::<16>();
    for numbers in whole {
        for (part, number) in parts.iter_mut().zip(numbers) {
            *part = join(*part, *number);
        }
    }
    let whole = parts.into_iter().fold(start, &join);
    rest.iter()
        .fold(whole, |whole, number| join(whole, *number))
}
