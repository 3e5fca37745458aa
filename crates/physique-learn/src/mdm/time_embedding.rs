//! The step of diffusion as a vector.

use burn::module::Module;
use burn::tensor::activation::silu;
use burn::tensor::{Device, Tensor};

use crate::layers::{Initialiser, Linear, positions};

/// The row of the step in the table of positions, through two linear layers with SiLU between.
#[derive(Module, Debug)]
pub(super) struct TimeEmbedding {
    first: Linear,
    second: Linear,
    width: usize,
}

impl TimeEmbedding {
    pub(super) fn new(width: usize, initialiser: &mut Initialiser) -> Self {
        Self {
            first: Linear::new(width, width, initialiser),
            second: Linear::new(width, width, initialiser),
            width,
        }
    }

    /// `[batch][width]`.
    pub(super) fn forward(&self, steps: &[usize], device: &Device) -> Tensor<2> {
        let rows = positions::tensor(steps.iter().copied(), self.width, device);
        self.second.forward(silu(self.first.forward(rows)))
    }
}
