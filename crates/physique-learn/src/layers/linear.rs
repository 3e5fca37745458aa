//! `torch.nn.Linear`.

use burn::module::{Module, Param};
use burn::tensor::{Tensor, module::linear};

use super::Initialiser;

/// y = x weight^T + bias.
#[derive(Module, Debug)]
pub struct Linear {
    /// `[outputs][inputs]`.
    weight: Param<Tensor<2>>,
    /// `[outputs]`.
    bias: Param<Tensor<1>>,
}

impl Linear {
    /// A new layer, with PyTorch's distribution of parameters.
    pub fn new(inputs: usize, outputs: usize, initialiser: &mut Initialiser) -> Self {
        let bound = (inputs.max(1) as f64).sqrt().recip();
        Self {
            weight: initialiser.uniform([outputs, inputs], bound),
            bias: initialiser.uniform([outputs], bound),
        }
    }

    /// A new layer whose bias is 0.
    pub(super) fn without_offset(
        inputs: usize,
        outputs: usize,
        initialiser: &mut Initialiser,
    ) -> Self {
        Self {
            bias: initialiser.constant([outputs], 0.0),
            ..Self::new(inputs, outputs, initialiser)
        }
    }

    /// `[..][inputs]` to `[..][outputs]`.
    pub fn forward<const D: usize>(&self, x: Tensor<D>) -> Tensor<D> {
        linear(x, self.weight.val().transpose(), Some(self.bias.val()))
    }
}
