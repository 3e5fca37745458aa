//! `y = x W^T + b`, with PyTorch's layout of weights.

use super::product::with_rows_of;
use crate::Error;
use crate::weights::Weights;

/// A linear layer.
#[derive(Clone, Debug)]
pub(crate) struct Linear {
    /// `[outputs][inputs]`.
    weight: Vec<f32>,
    bias: Vec<f32>,
    inputs: usize,
}

impl Linear {
    /// Takes `NAME.weight` and `NAME.bias`.
    pub(crate) fn take(
        weights: &mut Weights,
        name: &str,
        inputs: usize,
        outputs: usize,
    ) -> Result<Self, Error> {
        Ok(Self {
            weight: weights.floats(&format!("{name}.weight"), &[outputs, inputs])?,
            bias: weights.floats(&format!("{name}.bias"), &[outputs])?,
            inputs,
        })
    }

    /// From its numbers: `[outputs][inputs]` and `[outputs]`.
    pub(crate) const fn new(weight: Vec<f32>, bias: Vec<f32>, inputs: usize) -> Self {
        Self {
            weight,
            bias,
            inputs,
        }
    }

    /// `[rows][inputs]` to `[rows][outputs]`.
    pub(crate) fn apply(&self, x: &[f32]) -> Vec<f32> {
        let mut y = with_rows_of(x, &self.weight, self.inputs);
        for row in y.chunks_exact_mut(self.bias.len().max(1)) {
            for (value, bias) in row.iter_mut().zip(&self.bias) {
                *value += bias;
            }
        }
        y
    }
}
