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
        linear_rows(x, self.weight.val(), self.bias.val())
    }
}

/// x weight^T + bias, all rows of x in one product: Burn would make one for each motion.
pub(super) fn linear_rows<const D: usize>(
    x: Tensor<D>,
    weight: Tensor<2>,
    bias: Tensor<1>,
) -> Tensor<D> {
    let mut shape = x.dims();
    let rows = shape[..D - 1].iter().product();
    let x = x.reshape([rows, shape[D - 1]]);
    shape[D - 1] = weight.dims()[0];
    linear(x, weight.transpose(), Some(bias)).reshape(shape)
}
