//! `torch.nn.Conv1d`.

use burn::module::{Module, Param};
use burn::tensor::Tensor;
use burn::tensor::module::conv1d;
use burn::tensor::ops::ConvOptions;

use super::Initialiser;

/// A convolution over time.
#[derive(Module, Debug)]
pub struct Convolution {
    /// `[outputs][inputs][taps]`.
    weight: Param<Tensor<3>>,
    /// `[outputs]`.
    bias: Param<Tensor<1>>,
    stride: usize,
    padding: usize,
}

impl Convolution {
    /// A new layer, with PyTorch's distribution of parameters.
    pub fn new(
        [outputs, inputs, taps]: [usize; 3],
        stride: usize,
        padding: usize,
        initialiser: &mut Initialiser,
    ) -> Self {
        let bound = ((inputs * taps).max(1) as f64).sqrt().recip();
        Self {
            weight: initialiser.uniform([outputs, inputs, taps], bound),
            bias: initialiser.uniform([outputs], bound),
            stride,
            padding,
        }
    }

    /// `[batch][inputs][frames]` to `[batch][outputs][frames / stride]`, about.
    pub fn forward(&self, x: Tensor<3>) -> Tensor<3> {
        let options = ConvOptions::new([self.stride], [self.padding], [1], 1);
        conv1d(x, self.weight.val(), Some(self.bias.val()), options)
    }
}
