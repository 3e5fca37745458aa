//! Training: from data to a network.
//!
//! Everything that happens in a step depends on the seed and the step's number only, so a run that
//! was killed goes on from its newest checkpoint as if nothing had been: the same losses, bit for
//! bit on one thread. What is trained, and how its loss is found, is a [`Task`].
//!
//! | what | where |
//! |---|---|
//! | how to train | [`TrainerConfig`] |
//! | what to train | [`Task`] |
//! | the loop | [`Trainer`] |
//! | the optimiser | [`AdamW`] |
//! | where motions come from | [`MotionSource`] |
//! | several devices | [`Trainer::on_devices`], [`Part`] |

mod adamw;
mod batch;
mod config;
mod events;
mod gradient;
mod log;
mod parallel;
mod run;
mod state;

pub use adamw::{AdamW, AdamWConfig};
pub use batch::{BatchCondition, MotionBatch, MotionSource};
pub use config::{RateSchedule, TrainerConfig};
pub use parallel::Part;
pub use run::{Loss, StepReport, Task, Trainer};
pub(crate) use state::read_network;
pub use state::steps_in;
