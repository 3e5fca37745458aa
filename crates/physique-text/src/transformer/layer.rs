//! One layer: attention and a feed-forward block, each added to what goes in.

use super::{Activation, Attention, LayerNorm, Linear};

/// Where the normalisation stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NormPlace {
    /// `norm(x + block(x))`: BERT.
    After,
    /// `x + block(norm(x))`: CLIP.
    Before,
}

/// A layer of a transformer.
#[derive(Clone, Debug)]
pub(crate) struct Layer {
    pub(crate) attention: Attention,
    pub(crate) attention_norm: LayerNorm,
    pub(crate) widen: Linear,
    pub(crate) activation: Activation,
    pub(crate) narrow: Linear,
    pub(crate) feed_forward_norm: LayerNorm,
    pub(crate) norm_place: NormPlace,
}

impl Layer {
    /// Changes `[tokens of all captions][width]` in place.
    pub(crate) fn apply(&self, x: &mut [f32], lengths: &[usize], width: usize) {
        self.block(x, &self.attention_norm, |x| {
            self.attention.apply(x, lengths, width)
        });
        self.block(x, &self.feed_forward_norm, |x| {
            let mut wide = self.widen.apply(x);
            self.activation.apply(&mut wide);
            self.narrow.apply(&wide)
        });
    }

    fn block(&self, x: &mut [f32], norm: &LayerNorm, block: impl Fn(&[f32]) -> Vec<f32>) {
        let change = match self.norm_place {
            NormPlace::After => block(x),
            NormPlace::Before => {
                let mut normal = x.to_vec();
                norm.apply(&mut normal);
                block(&normal)
            }
        };
        for (x, change) in x.iter_mut().zip(change) {
            *x += change;
        }
        if self.norm_place == NormPlace::After {
            norm.apply(x);
        }
    }
}
