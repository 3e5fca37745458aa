//! Layers as single operations on the processor, with their derivatives by hand.
//!
//! Burn differentiates layers by the elementary operations that they are made of: each reads and
//! writes all activations, which on a processor costs more than the arithmetic. An [`Operation`]
//! is one pass over plain numbers each way, in parallel rows. What layers compute from elementary
//! operations stays where it is: it serves other devices, and tests compare with it.
//!
//! Results do not depend on the number of threads: rows are cut in blocks of fixed size, whose sums
//! are added in order. They do not depend on vector instructions either, but for matrix products.

mod attention;
mod dropped;
mod elementary;
mod gelu;
mod layer_norm;
mod operation;
mod optimiser;
mod product;

pub(crate) use attention::attention;
pub(crate) use dropped::{DropMask, add_dropped, dropped};
pub(crate) use gelu::dropped_gelu;
pub(crate) use layer_norm::layer_norm;
pub(crate) use operation::is_supported;
pub(crate) use optimiser::{AdamWStep, adamw};

#[cfg(test)]
mod tests;
