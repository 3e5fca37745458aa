//! Posing and losses, through the crate's public face.

mod crude;
mod fused;
mod golden;
mod invariance;
mod reference;
mod support;
