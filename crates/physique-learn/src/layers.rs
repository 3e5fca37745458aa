//! Layers with PyTorch's parameter names and shapes, so that published checkpoints fit as they are.
//!
//! Every layer is made with random parameters by an [`Initialiser`], whose numbers depend on its
//! seed only, and takes a [`Dropout`] where it drops anything while it is trained.

mod attention;
mod convolution;
mod decoder;
mod dropout;
mod embedding;
mod encoder;
mod gru;
mod initialiser;
mod layer_norm;
mod linear;
pub mod positions;

pub use attention::MultiHeadAttention;
pub use convolution::Convolution;
pub use decoder::{DecoderLayer, Memory, TransformerDecoder};
pub use dropout::Dropout;
pub use embedding::Embedding;
pub use encoder::{EncoderLayer, LayerSizes, NormPlace, TransformerEncoder};
pub use gru::{BidirectionalGru, Gru};
pub use initialiser::Initialiser;
pub use layer_norm::LayerNorm;
pub use linear::Linear;
