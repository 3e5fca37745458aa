//! The same spheres in a world: bodies against the ground, against things, and against each other.
//!
//! A moving body is an [`Actor`]: poses, and root translations as SMPL's `trans`. Losses are sums of
//! [`Penalty`](crate::Penalty) over spheres that reach deeper than a tolerance, frame by frame, with
//! the gradient to poses and translations; slices in, slices out.
//!
//! * [`obstacle_loss`]: a body and any number of [`Obstacle`]s: [`Plane`], [`HeightField`],
//!   [`Capsule`] (and so static spheres), or your own signed distance.
//! * [`body_loss`]: two bodies and their spheres against each other.
//!
//! Everything is computed in `f64`, frames side by side on all threads, each frame by itself: the
//! same bits for any number of threads. Cost: some 10 microseconds a frame and body, and 10
//! nanoseconds a sphere and obstacle.

mod actor;
mod bodies;
mod height_field;
mod obstacle;
mod obstacles;

pub use actor::{Actor, ActorGradient, SceneOptions};
pub use bodies::body_loss;
pub use height_field::HeightField;
pub use obstacle::{Capsule, Obstacle, Plane};
pub use obstacles::obstacle_loss;
