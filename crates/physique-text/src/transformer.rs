//! The transformer that all encoders share (Vaswani et al., 2017).
//!
//! Captions of a batch lie one after the other, `[tokens of all captions][width]`, without padding:
//! linear layers see them all at once, attention each by itself.

mod activation;
mod attention;
mod layer;
mod layer_norm;
mod linear;
mod product;

pub(crate) use activation::Activation;
pub(crate) use attention::{Attention, Sight};
pub(crate) use layer::{Layer, NormPlace};
pub(crate) use layer_norm::LayerNorm;
pub(crate) use linear::Linear;
