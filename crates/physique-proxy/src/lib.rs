//! Spheres in place of a body: a *sphere proxy* is regressed from body shape and skinned to the 22
//! joints, and the *self-intersection loss* penalises spheres that pass through each other.
//!
//! After "Self-intersection-aware motion generation" (BMVC 2025, arXiv 2605.26744).

mod engine;
pub mod error;
mod kernel;
pub mod lanes;
pub mod pairs;
pub mod penalty;
mod plan;
pub mod pose_matrices;
pub mod reference;
pub mod self_intersection;
pub mod shape_gradient;
pub mod sphere_body;

pub use error::Error;
pub use lanes::Backend;
pub use pairs::Pairs;
pub use penalty::Penalty;
pub use pose_matrices::{PoseMatrices, pose_matrices};
pub use self_intersection::{SelfIntersection, SelfIntersectionOptions};
pub use shape_gradient::ShapeGradient;
pub use sphere_body::SphereBody;
