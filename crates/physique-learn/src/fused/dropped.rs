//! Dropout without masks in memory: what a number is multiplied by is drawn again going back.

use burn::tensor::Tensor;
use multiversion::multiversion;
use rayon::prelude::*;

use super::operation::{Forward, Operation, apply, input};
use crate::random::{Random, STEP, scramble};

/// Numbers that a thread takes in one go.
pub(super) const BLOCK: usize = 1 << 14;

/// Which numbers of a tensor are dropped: 16 bits of a random stream for each, by its place.
#[derive(Clone, Debug)]
pub(crate) struct DropMask {
    /// Numbers out of 65,536 that are dropped.
    dropped: u16,
    /// What others are multiplied by, so that means stay.
    kept: f32,
    state: u64,
}

/// Numbers of one draw.
const QUAD: usize = 4;

impl DropMask {
    /// The mask of a stream that has not been drawn from.
    pub(crate) fn new(dropped: u16, random: &Random) -> Self {
        Self {
            dropped,
            kept: 65_536.0 / (65_536.0 - f32::from(dropped)),
            state: random.state(),
        }
    }

    /// Multiplies numbers, the first of which is at a place of the tensor.
    #[inline(always)]
    pub(super) fn multiply(&self, first: usize, values: &mut [f32]) {
        let (mut quad, place) = (first / QUAD, first % QUAD);
        // Up to the next whole draw.
        let (head, values) = values.split_at_mut(((QUAD - place) % QUAD).min(values.len()));
        if !head.is_empty() {
            let drawn = self.draw(quad);
            for (value, drawn) in head.iter_mut().zip(&drawn[place..]) {
                *value *= self.factor(*drawn);
            }
            quad += 1;
        }
        let (quads, tail) = values.as_chunks_mut::<QUAD>();
        // In two loops, each of which is vectors.
        const TOGETHER: usize = 32;
        for quads in quads.chunks_mut(TOGETHER) {
            let mut drawn = [[0_u16; QUAD]; TOGETHER];
            for (index, drawn) in drawn.iter_mut().enumerate() {
                *drawn = self.draw(quad + index);
            }
            let values = quads.as_flattened_mut();
            for (value, drawn) in values.iter_mut().zip(drawn.as_flattened()) {
                *value *= self.factor(*drawn);
            }
            quad += quads.len();
        }
        let drawn = self.draw(quad);
        for (value, drawn) in tail.iter_mut().zip(drawn) {
            *value *= self.factor(drawn);
        }
    }

    #[inline(always)]
    fn draw(&self, quad: usize) -> [u16; QUAD] {
        let steps = (quad as u64).wrapping_add(1);
        let bits = scramble(self.state.wrapping_add(steps.wrapping_mul(STEP)));
        [
            bits as u16,
            (bits >> 16) as u16,
            (bits >> 32) as u16,
            (bits >> 48) as u16,
        ]
    }

    #[inline(always)]
    fn factor(&self, drawn: u16) -> f32 {
        if drawn < self.dropped { 0.0 } else { self.kept }
    }
}

/// A tensor's numbers, some dropped.
pub(crate) fn dropped<const D: usize>(values: Tensor<D>, mask: DropMask) -> Tensor<D> {
    apply(Dropped { mask }, vec![input(values)])
}

/// The first tensor and the second, some of whose numbers are dropped, added.
pub(crate) fn add_dropped<const D: usize>(
    values: Tensor<D>,
    other: Tensor<D>,
    mask: DropMask,
) -> Tensor<D> {
    apply(AddDropped { mask }, vec![input(values), input(other)])
}

#[derive(Debug)]
struct Dropped {
    mask: DropMask,
}

impl Dropped {
    fn of(&self, values: &[f32]) -> Vec<f32> {
        let mut output = values.to_vec();
        let blocks = output.par_chunks_mut(BLOCK).enumerate();
        blocks.for_each(|(index, block)| multiply(&self.mask, index * BLOCK, block));
        output
    }
}

impl Operation for Dropped {
    fn inputs(&self) -> usize {
        1
    }

    fn forward(&self, inputs: &[&[f32]]) -> Forward {
        Forward {
            output: self.of(inputs[0]),
            kept: Vec::new(),
        }
    }

    fn backward(&self, _: &[&[f32]], _: &[f32], by_output: &[f32]) -> Vec<Vec<f32>> {
        vec![self.of(by_output)]
    }

    fn reads_inputs(&self) -> bool {
        false
    }
}

#[derive(Debug)]
struct AddDropped {
    mask: DropMask,
}

impl Operation for AddDropped {
    fn inputs(&self) -> usize {
        2
    }

    fn forward(&self, inputs: &[&[f32]]) -> Forward {
        let mut output = inputs[1].to_vec();
        let blocks = output
            .par_chunks_mut(BLOCK)
            .zip(inputs[0].par_chunks(BLOCK));
        blocks.enumerate().for_each(|(index, (block, others))| {
            multiply(&self.mask, index * BLOCK, block);
            for (value, other) in block.iter_mut().zip(others) {
                *value += other;
            }
        });
        Forward {
            output,
            kept: Vec::new(),
        }
    }

    fn backward(&self, _: &[&[f32]], _: &[f32], by_output: &[f32]) -> Vec<Vec<f32>> {
        let mask = self.mask.clone();
        vec![by_output.to_vec(), Dropped { mask }.of(by_output)]
    }

    fn reads_inputs(&self) -> bool {
        false
    }
}

#[multiversion(targets = "simd")]
fn multiply(mask: &DropMask, first: usize, values: &mut [f32]) {
    mask.multiply(first, values);
}
