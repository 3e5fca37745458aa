//! Small networks from betas to spheres and to joints.
//!
//! Both are fully connected with rectifiers between layers, in the shapes and under the names of
//! the published ones, so that their parameters can be exchanged. Evaluating and training need
//! nothing but a matrix product.

mod betas;
mod gradient;
mod joints;
mod matrix;
pub(crate) mod network;
mod spheres;

pub use gradient::Gradient;
pub use joints::JointRegressor;
pub use network::{Activations, Network, NetworkLayout, Parameter};
pub use spheres::{RegressedSpheres, SphereRegressor};
