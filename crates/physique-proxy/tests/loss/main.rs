//! Posing and losses, through the crate's public face.

mod explain;
mod features;
mod fused;
mod golden;
mod hostile;
mod invariance;
mod real;
mod reference;
mod scene;
mod support;
