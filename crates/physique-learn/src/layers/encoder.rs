//! `torch.nn.TransformerEncoder`.

use burn::module::Module;
use burn::tensor::{Bool, Tensor};

use super::{Dropout, Initialiser, LayerNorm, Linear, MultiHeadAttention};

/// Sizes of a transformer layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerSizes {
    /// Numbers a frame.
    pub width: usize,
    /// Heads of attention; must divide the width.
    pub heads: usize,
    /// Width between the two linear layers.
    pub feed_forward: usize,
}

/// Where a transformer layer normalises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NormPlace {
    /// After what a block adds, as Vaswani et al. and MDM do.
    #[default]
    Post,
    /// Before each block: trains faster.
    Pre,
}

/// Attention, then two linear layers with the exact GELU between them; each added to its input.
#[derive(Module, Debug)]
pub struct EncoderLayer {
    self_attn: MultiHeadAttention,
    linear1: Linear,
    linear2: Linear,
    norm1: LayerNorm,
    norm2: LayerNorm,
}

impl EncoderLayer {
    /// A new layer.
    pub fn new(sizes: LayerSizes, initialiser: &mut Initialiser) -> Self {
        let LayerSizes {
            width,
            heads,
            feed_forward,
        } = sizes;
        Self {
            self_attn: MultiHeadAttention::new(width, heads, initialiser),
            linear1: Linear::new(width, feed_forward, initialiser),
            linear2: Linear::new(feed_forward, width, initialiser),
            norm1: LayerNorm::new(width, initialiser),
            norm2: LayerNorm::new(width, initialiser),
        }
    }

    /// `[batch][frames][width]` to the same shape; where `padding` is true nobody looks.
    pub fn forward(
        &self,
        x: Tensor<3>,
        place: NormPlace,
        padding: Option<&Tensor<2, Bool>>,
        dropout: &Dropout,
    ) -> Tensor<3> {
        let attend = |x| self.self_attn.to_itself(x, padding, dropout);
        let feed = |x| self.linear2.forward(dropout.gelu(self.linear1.forward(x)));
        match place {
            NormPlace::Post => {
                let x = self.norm1.forward(dropout.add(x.clone(), attend(x)));
                self.norm2.forward(dropout.add(x.clone(), feed(x)))
            }
            NormPlace::Pre => {
                let x = dropout.add(x.clone(), attend(self.norm1.forward(x)));
                dropout.add(x.clone(), feed(self.norm2.forward(x)))
            }
        }
    }
}

/// Layers one after the other.
#[derive(Module, Debug)]
pub struct TransformerEncoder {
    layers: Vec<EncoderLayer>,
}

impl TransformerEncoder {
    /// New layers. Unlike in PyTorch, which copies the first, each has parameters of its own.
    pub fn new(layers: usize, sizes: LayerSizes, initialiser: &mut Initialiser) -> Self {
        let layers = (0..layers).map(|_| EncoderLayer::new(sizes, initialiser));
        Self {
            layers: layers.collect(),
        }
    }

    /// `[batch][frames][width]` to the same shape; where `padding` is true nobody looks.
    pub fn forward(
        &self,
        x: Tensor<3>,
        place: NormPlace,
        padding: Option<&Tensor<2, Bool>>,
        dropout: &Dropout,
    ) -> Tensor<3> {
        let layers = self.layers.iter();
        layers.fold(x, |x, layer| layer.forward(x, place, padding, dropout))
    }
}
