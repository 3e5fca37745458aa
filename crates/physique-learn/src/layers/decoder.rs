//! `torch.nn.TransformerDecoder`.

use burn::module::Module;
use burn::tensor::{Bool, Tensor};

use super::{Dropout, Initialiser, LayerNorm, LayerSizes, Linear, MultiHeadAttention};

/// What frames look at besides each other.
#[derive(Clone, Debug)]
pub struct Memory {
    /// `[batch][tokens][width]`.
    pub tokens: Tensor<3>,
    /// `[batch][tokens]`: true where nobody looks.
    pub padding: Option<Tensor<2, Bool>>,
}

/// Attention among frames, attention to a memory, two linear layers with the exact GELU between
/// them; each added to its input, then normalised.
#[derive(Module, Debug)]
pub struct DecoderLayer {
    self_attn: MultiHeadAttention,
    multihead_attn: MultiHeadAttention,
    linear1: Linear,
    linear2: Linear,
    norm1: LayerNorm,
    norm2: LayerNorm,
    norm3: LayerNorm,
}

impl DecoderLayer {
    /// A new layer.
    pub fn new(sizes: LayerSizes, initialiser: &mut Initialiser) -> Self {
        let LayerSizes {
            width,
            heads,
            feed_forward,
        } = sizes;
        Self {
            self_attn: MultiHeadAttention::new(width, heads, initialiser),
            multihead_attn: MultiHeadAttention::new(width, heads, initialiser),
            linear1: Linear::new(width, feed_forward, initialiser),
            linear2: Linear::new(feed_forward, width, initialiser),
            norm1: LayerNorm::new(width, initialiser),
            norm2: LayerNorm::new(width, initialiser),
            norm3: LayerNorm::new(width, initialiser),
        }
    }

    /// `[batch][frames][width]` to the same shape; where a `padding` is true nobody looks.
    pub fn forward(
        &self,
        x: Tensor<3>,
        memory: &Memory,
        padding: Option<&Tensor<2, Bool>>,
        dropout: &Dropout,
    ) -> Tensor<3> {
        let among = self.self_attn.to_itself(x.clone(), padding, dropout);
        let x = self.norm1.forward(dropout.add(x, among));
        let (tokens, hidden) = (memory.tokens.clone(), memory.padding.as_ref());
        let looked_up = self
            .multihead_attn
            .to_memory(x.clone(), tokens, hidden, dropout);
        let x = self.norm2.forward(dropout.add(x, looked_up));
        let inner = dropout.gelu(self.linear1.forward(x.clone()));
        self.norm3
            .forward(dropout.add(x, self.linear2.forward(inner)))
    }
}

/// Layers one after the other.
#[derive(Module, Debug)]
pub struct TransformerDecoder {
    layers: Vec<DecoderLayer>,
}

impl TransformerDecoder {
    /// New layers, each with parameters of its own.
    pub fn new(layers: usize, sizes: LayerSizes, initialiser: &mut Initialiser) -> Self {
        let layers = (0..layers).map(|_| DecoderLayer::new(sizes, initialiser));
        Self {
            layers: layers.collect(),
        }
    }

    /// `[batch][frames][width]` to the same shape; where a `padding` is true nobody looks.
    pub fn forward(
        &self,
        x: Tensor<3>,
        memory: &Memory,
        padding: Option<&Tensor<2, Bool>>,
        dropout: &Dropout,
    ) -> Tensor<3> {
        let layers = self.layers.iter();
        layers.fold(x, |x, layer| layer.forward(x, memory, padding, dropout))
    }
}
