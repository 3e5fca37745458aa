//! The human body: from shape to mesh and joints, from pose to transforms and skinned vertices.
//!
//! Units are metres, radians and kilograms; axes are right-handed with **Y up, the body facing
//! +Z and its left at +X**. This crate knows nothing about time; motions live in
//! `physique-motion`.
//!
//! ```
//! use physique_body::{Attributes, Body, Joint, Pose, Sex, open_body};
//!
//! let person = Attributes { sex: Sex::Female, stature: Some(1.8), mass: Some(80.0), age: None };
//! let body = Body::from_attributes(open_body()?, &person)?;
//! assert!((body.stature() - 1.8).abs() < 1e-4);
//!
//! let mut posed = body.posed();
//! body.pose(&Pose::REST, &mut posed)?;
//! assert!(posed.joint(Joint::LeftWrist).x > 0.5);
//! # Ok::<(), physique_body::Error>(())
//! ```

pub mod attributes;
pub mod blend_weights;
pub mod body;
pub mod compact;
pub mod error;
pub mod joint;
pub mod joint_regressor;
pub mod model;
pub mod open_body;
pub mod pose;
pub mod read;
mod skinning;
pub mod smpl;
pub mod surface;

pub use attributes::{AttributeMap, Attributes, Sex};
pub use blend_weights::BlendWeights;
pub use body::{BODY_DENSITY, Body, PosedBody};
pub use error::Error;
pub use joint::Joint;
pub use joint_regressor::JointRegressor;
pub use model::{BodyArrays, BodyModel};
pub use open_body::{open_body, open_body_low};
pub use pose::Pose;
pub use read::{BodyOptions, parse_body, read_body};
pub use smpl::JointSet;
pub use surface::Surface;
