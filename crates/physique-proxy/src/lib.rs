//! Spheres in place of a body: a *sphere proxy* is regressed from body shape and skinned to the 22
//! joints, and the *self-intersection loss* penalises spheres that pass through each other.
//!
//! After "Self-intersection-aware motion generation" (BMVC 2025, arXiv 2605.26744).
//!
//! | what | where |
//! |---|---|
//! | the spheres of one body | [`SphereBody`] |
//! | which of them must not intersect | [`Pairs`] |
//! | the loss and its gradient by poses and shape, fused and vectorised | [`SelfIntersection`] |
//! | the same on HumanML3D's and KIT's features | [`FeatureLoss`] |
//! | the mesh-based loss that it stands in for | [`MeshLoss`] |
//! | what it saw, in words | [`explain`](explain()) |
//! | bodies against ground, things and each other | [`scene`] |
//! | all of it slowly, from the equations, in `f64` | [`reference`](mod@reference) |
//!
//! Poses are rotation matrices in the layout of a PyTorch tensor `(frames, 22, 3, 3)`; see
//! [`PoseMatrices`].
//!
//! ```
//! use glam::Quat;
//! use physique_body::{Body, Joint, Sex, open_body};
//! use physique_proxy::{Pairs, SelfIntersection, SphereBody, explain, pose_matrices};
//!
//! // A rough body: one sphere at each joint. Fitted proxies have 192.
//! let person = Body::mean(open_body()?, Sex::Neutral)?;
//! let rest_joints = Joint::ALL.map(|joint| person.rest_joint(joint));
//! let follow = |joint: Joint| [(joint.index() as u8, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)];
//! let body = SphereBody {
//!     rest_joints,
//!     centres: rest_joints.to_vec(),
//!     radii: vec![0.08; Joint::COUNT],
//!     blend_weights: Joint::ALL.map(follow).to_vec(),
//! };
//! // Neighbours along the skeleton always touch: they do not count.
//! let far = |i: usize, j: usize| Joint::ALL[i].tree_distance(Joint::ALL[j]) > 2;
//! let pairs = Pairs::all(Joint::COUNT)?.filtered(far);
//!
//! // Two frames: at rest, and with the left forearm folded back through the chest.
//! let mut folded = [Quat::IDENTITY; Joint::COUNT];
//! folded[Joint::LeftShoulder.index()] = Quat::from_rotation_z(-1.2);
//! folded[Joint::LeftElbow.index()] = Quat::from_rotation_z(-1.6);
//! let poses = [pose_matrices(&[]), pose_matrices(&folded)];
//!
//! let loss = SelfIntersection::new(&body, &pairs)?;
//! let (mut losses, mut by_poses) = ([0.0; 2], [[[0.0; 9]; 22]; 2]);
//! loss.gradient(&poses, &[0.5, 0.5], &mut losses, &mut by_poses)?;
//! assert!(losses[0] == 0.0 && losses[1] > 0.0);
//! assert!(by_poses[1][Joint::LeftElbow.index()].iter().any(|by| *by != 0.0));
//!
//! let found = explain(&body, &pairs, &poses[1]);
//! assert!(found[0].to_string().starts_with("left hand in "), "{}", found[0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod chain;
mod engine;
pub mod error;
pub mod evaluate;
pub mod explain;
pub mod feature_loss;
pub mod files;
pub mod fit;
mod kernel;
mod lanes;
pub mod mesh_loss;
pub mod open_proxy;
pub mod pair_statistics;
pub mod pairs;
pub mod penalty;
mod plan;
pub mod pose_matrices;
mod random;
pub mod reference;
pub mod regressor;
pub mod scene;
pub mod self_intersection;
pub mod shape_gradient;
pub mod sphere_body;
pub mod sphere_proxy;

pub use error::Error;
pub use explain::{PartOverlap, explain};
pub use feature_loss::{FeatureBatch, FeatureGradient, FeatureLoss, JointFrame};
pub use lanes::Backend;
pub use mesh_loss::{MeshLoss, MeshLossOptions};
pub use open_proxy::{open_proxy, open_proxy_with};
pub use pair_statistics::PairStatistics;
pub use pairs::Pairs;
pub use penalty::Penalty;
pub use pose_matrices::{PoseMatrices, pose_matrices};
pub use regressor::{JointRegressor, RegressedSpheres, SphereRegressor};
pub use self_intersection::{SelfIntersection, SelfIntersectionOptions};
pub use shape_gradient::ShapeGradient;
pub use sphere_body::SphereBody;
pub use sphere_proxy::{PairChoice, SphereProxy};
