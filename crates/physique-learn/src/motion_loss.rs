//! Losses that are computed with their gradients outside of Burn, as one operation in its graph.
//!
//! [`MotionLoss`] is such a loss, [`SelfIntersectionLoss`] the one of the paper, and [`losses`]
//! the operation.

mod operation;
mod self_intersection;

use std::fmt::Debug;

use crate::Error;

pub use operation::losses;
pub use self_intersection::SelfIntersectionLoss;

/// A loss of motions and its gradient.
pub trait MotionLoss: Debug + Send + Sync {
    /// The loss of each motion of a batch, and the gradient of their sum.
    ///
    /// `motions` are normalised features `[batch][frames][columns]`, of which each motion has
    /// `lengths` frames; the gradient of what lies behind is 0.
    ///
    /// # Errors
    /// Depends on the loss: numbers that are none, above all.
    fn evaluate(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<LossAndGradient, Error>;
}

/// What a [`MotionLoss`] finds.
#[derive(Clone, Debug, PartialEq)]
pub struct LossAndGradient {
    /// `[batch]`.
    pub losses: Vec<f32>,
    /// As the motions.
    pub gradient: Vec<f32>,
}
