//! Physique scores human motion for what a body could really perform.
//!
//! This is the face: the floors below are re-exported as [`body`], [`motion`], [`geometry`],
//! [`physics`] and [`proxy`].
//!
//! ```
//! use physique::body::{Body, Joint, Sex, open_body};
//! use physique::motion::{FrameRate, Motion};
//! use glam::{Quat, Vec3};
//!
//! // One frame: the left forearm is folded back through the chest.
//! let mut rotations = vec![Quat::IDENTITY; Joint::COUNT];
//! rotations[Joint::LeftShoulder.index()] = Quat::from_rotation_z(-1.2);
//! rotations[Joint::LeftElbow.index()] = Quat::from_rotation_z(-1.6);
//! let motion = Motion::new(FrameRate::new(30.0)?, None, vec![Vec3::ZERO], rotations)?;
//!
//! let body = Body::mean(open_body()?, Sex::Neutral)?;
//! let score = physique::score(&motion, &body)?;
//! let found = score.self_intersection.expect("the native protocol measures it");
//! assert!(found.mean_cm3 > 50.0);
//! # Ok::<(), physique::Error>(())
//! ```

pub mod body_description;
pub mod condition;
pub mod defects;
pub mod error;
pub mod export;
pub mod floor;
mod frames;
pub mod group;
pub mod inspect;
pub mod load;
pub mod measures;
pub mod physics_score;
pub mod protocol;
pub mod repair;
pub mod report;
pub mod scan;
pub mod score;
pub mod self_intersection;
pub mod series;
pub mod sia;

pub use physique_body as body;
pub use physique_geometry as geometry;
pub use physique_motion as motion;
pub use physique_physics as physics;
pub use physique_proxy as proxy;

pub use body_description::BodyDescription;
pub use condition::Condition;
pub use error::Error;
pub use export::{ExportFormat, ExportOptions, export};
pub use floor::Floor;
pub use group::Group;
pub use inspect::{InspectReport, Inspector};
pub use protocol::{Protocol, PublishedScore};
pub use repair::{RepairOptions, Repaired, Repairer};
pub use report::{MotionReport, Report, ReportHead};
pub use scan::{ClipReport, ScanReport, Scanner};
pub use score::{MotionScore, ScoreOptions, Scorer, score};
pub use series::Series;
