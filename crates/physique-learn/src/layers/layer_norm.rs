//! `torch.nn.LayerNorm`.

use burn::module::{Module, Param};
use burn::tensor::{Tensor, module::layer_norm};

use super::Initialiser;
use crate::fused;

/// What PyTorch adds to the variance.
const EPSILON: f64 = 1e-5;

/// Each vector of the last dimension with mean 0 and variance 1, then scaled and shifted.
///
/// Ba, Kiros and Hinton, "Layer Normalization", 2016.
#[derive(Module, Debug)]
pub struct LayerNorm {
    /// `[width]`.
    weight: Param<Tensor<1>>,
    /// `[width]`.
    bias: Param<Tensor<1>>,
}

impl LayerNorm {
    /// A new layer, which neither scales nor shifts.
    pub fn new(width: usize, initialiser: &Initialiser) -> Self {
        Self {
            weight: initialiser.constant([width], 1.0),
            bias: initialiser.constant([width], 0.0),
        }
    }

    /// `[..][width]` to the same shape.
    pub fn forward<const D: usize>(&self, x: Tensor<D>) -> Tensor<D> {
        let (scale, offset) = (self.weight.val(), self.bias.val());
        if fused::is_supported(&x.device()) {
            return fused::layer_norm(x, scale, offset, EPSILON as f32);
        }
        layer_norm(x, scale, Some(offset), EPSILON)
    }
}
