//! Posing and losses, through the crate's public face.

mod crude;
mod explain;
mod features;
mod fused;
mod golden;
mod invariance;
mod reference;
mod scene;
mod support;
