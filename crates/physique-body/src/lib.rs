//! The human body: from shape to mesh and joints, from pose to transforms and skinned vertices.
//!
//! Units are metres and radians; axes are right-handed with **Y up, the body facing +Z and its
//! left at +X**. This crate knows nothing about time; motions live in `physique-motion`.

pub mod joint;

pub use joint::Joint;
