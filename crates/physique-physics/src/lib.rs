//! Mass, ground, feet, balance and smoothness of a human motion.
//!
//! Floor 3 of Physique: it knows bodies and motions, not files and not learning. Metres, seconds,
//! kilograms, radians; right-handed, **Y up**; places on the ground are `(x, z)`.
//!
//! * [`Physics`]: a body prepared once; [`Physics::measure`] gives [`PhysicsMeasures`] of a motion,
//!   in metres and seconds, with every frame.
//! * [`protocol`]: ten published sets of metrics, each by its own definition.
//! * [`loss`]: the same as losses with gradients to pose, root and shape.
//! * [`MassPoints`] and [`MassMoments`]: where the mass is, and exact sums over it.
//! * [`balance`], [`hull`], [`time_filter`]: zero moment point, base of support, derivatives of a
//!   stated bandwidth, usable alone.
//!
//! What is not known is not judged: frames in flight, without support, or too near to the ends of
//! a clip for derivatives are counted, never called stable or unstable.

mod contact;
mod ground;
mod interior;
mod judge;
mod mass_moments;
mod mass_points;
mod transforms;

pub mod balance;
pub mod error;
pub mod frame;
pub mod hull;
pub mod loss;
pub mod measures;
pub mod options;
pub mod physics;
pub mod protocol;
pub mod rig;
pub mod segment;
pub mod soles;
pub mod support;
pub mod time_filter;

pub use balance::{Centroid, GRAVITY, PressureModel};
pub use error::Error;
pub use frame::{FramePhysics, JointMotion};
pub use hull::SupportPolygon;
pub use mass_moments::MassMoments;
pub use mass_points::MassPoints;
pub use measures::{
    BalanceMeasures, FootMeasures, GroundMeasures, MeasuredBalance, PhysicsMeasures,
    SmoothnessMeasures,
};
pub use options::{GroundChoice, PhysicsOptions};
pub use physics::Physics;
pub use protocol::{Floor, Protocol, ProtocolMeasure};
pub use rig::Rig;
pub use segment::Segment;
pub use support::Support;
pub use time_filter::TimeFilter;
