//! Posing and losses, through the crate's public face.

mod golden;
mod reference;
mod support;
