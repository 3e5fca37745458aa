//! `torch.nn.MultiheadAttention`.

use std::sync::Arc;

use burn::module::{Module, Param};
use burn::tensor::activation::softmax;
use burn::tensor::{Bool, Tensor};

use super::linear::linear_rows;
use super::{Dropout, Initialiser, Linear};
use crate::fused;

/// softmax(Q K^T / sqrt(d)) V by heads. Vaswani et al., "Attention Is All You Need", 2017,
/// section 3.2.
#[derive(Module, Debug)]
pub struct MultiHeadAttention {
    /// `[3 width][width]`: what makes queries, then keys, then values.
    in_proj_weight: Param<Tensor<2>>,
    /// `[3 width]`.
    in_proj_bias: Param<Tensor<1>>,
    out_proj: Linear,
    heads: usize,
}

impl MultiHeadAttention {
    /// A new layer, with PyTorch's distribution of parameters; `heads` must divide `width`.
    pub fn new(width: usize, heads: usize, initialiser: &mut Initialiser) -> Self {
        // Xavier's bound for all three together.
        let bound = (6.0 / (4 * width.max(1)) as f64).sqrt();
        Self {
            in_proj_weight: initialiser.uniform([3 * width, width], bound),
            in_proj_bias: initialiser.constant([3 * width], 0.0),
            out_proj: Linear::without_offset(width, width, initialiser),
            heads,
        }
    }

    /// Frames `[batch][frames][width]` look at each other; where `padding` `[batch][frames]` is
    /// true nobody looks.
    pub fn to_itself(
        &self,
        x: Tensor<3>,
        padding: Option<&Tensor<2, Bool>>,
        dropout: &Dropout,
    ) -> Tensor<3> {
        let projected = linear_rows(x, self.in_proj_weight.val(), self.in_proj_bias.val());
        if fused::is_supported(&projected.device()) {
            let hidden = padding.map(hidden_frames);
            let mixed = fused::attention(projected, self.heads, hidden, dropout.mask());
            return self.out_proj.forward(mixed);
        }
        let [queries, keys, values] = self.heads_of(projected);
        self.attend(queries, keys, values, padding, dropout)
    }

    /// Frames `[batch][frames][width]` look at a memory `[batch][tokens][width]`; where `padding`
    /// `[batch][tokens]` is true nobody looks.
    pub fn to_memory(
        &self,
        x: Tensor<3>,
        memory: Tensor<3>,
        padding: Option<&Tensor<2, Bool>>,
        dropout: &Dropout,
    ) -> Tensor<3> {
        let width = x.dims()[2];
        let project = |x: Tensor<3>, start: usize, length: usize| {
            let weight = self.in_proj_weight.val().narrow(0, start, length);
            let bias = self.in_proj_bias.val().narrow(0, start, length);
            linear_rows(x, weight, bias)
        };
        let [queries] = self.heads_of(project(x, 0, width));
        let [keys, values] = self.heads_of(project(memory, width, 2 * width));
        self.attend(queries, keys, values, padding, dropout)
    }

    /// `[batch][frames][N width]` to N times `[batch][heads][frames][width / heads]`.
    fn heads_of<const N: usize>(&self, projected: Tensor<3>) -> [Tensor<4>; N] {
        let [batch, frames, width] = projected.dims();
        let width = width / N;
        std::array::from_fn(|part| {
            let part = projected.clone().narrow(2, part * width, width);
            part.reshape([batch, frames, self.heads, width / self.heads])
                .swap_dims(1, 2)
        })
    }

    fn attend(
        &self,
        queries: Tensor<4>,
        keys: Tensor<4>,
        values: Tensor<4>,
        padding: Option<&Tensor<2, Bool>>,
        dropout: &Dropout,
    ) -> Tensor<3> {
        let [batch, heads, frames, width] = queries.dims();
        let tokens = keys.dims()[2];
        let mut scores = (queries * (width as f64).sqrt().recip()).matmul(keys.transpose());
        if let Some(padding) = padding {
            let hidden = padding.clone().reshape([batch, 1, 1, tokens]);
            let hidden = hidden.expand([batch, heads, frames, tokens]);
            scores = scores.mask_fill(hidden, f32::NEG_INFINITY);
        }
        let weights = dropout.apply(softmax(scores, 3));
        let mixed = weights.matmul(values).swap_dims(1, 2);
        self.out_proj
            .forward(mixed.reshape([batch, frames, heads * width]))
    }
}

/// Where nobody looks, as plain numbers.
fn hidden_frames(padding: &Tensor<2, Bool>) -> Arc<[bool]> {
    padding.to_data().iter::<bool>().collect()
}
