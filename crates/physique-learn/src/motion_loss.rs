//! Losses that are computed with their gradients outside of Burn, as one operation in its graph.
//!
//! | what | where |
//! |---|---|
//! | a loss with its gradient | [`MotionLoss`] |
//! | as an operation, and weighed | [`losses`], [`WeightedLoss`] |
//! | bodies that pass through themselves | [`SelfIntersectionLoss`] |
//! | the same on graphics processors | `GpuSelfIntersection`, by the features `wgpu` and `cuda` |
//! | feet in the ground or above it | [`GroundLoss`] |
//! | feet that slide | [`SlidingLoss`] |

#[cfg(feature = "cubecl")]
mod gpu;
mod ground;
mod joints;
mod operation;
mod self_intersection;
mod sliding;
mod weighted;

use std::fmt::Debug;

use crate::Error;

#[cfg(feature = "cubecl")]
pub use gpu::GpuSelfIntersection;
pub use ground::GroundLoss;
pub use operation::losses;
pub use self_intersection::{SelfIntersectionLoss, SelfIntersectionSettings, SpherePairs};
pub use sliding::SlidingLoss;
pub use weighted::WeightedLoss;

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

    /// The same as kernels of a graphics processor. Where there are none, motions are brought to the
    /// processor, and the gradient back.
    #[cfg(feature = "cubecl")]
    fn on_gpu(&self) -> Option<&GpuSelfIntersection> {
        None
    }
}

/// What a [`MotionLoss`] finds.
#[derive(Clone, Debug, PartialEq)]
pub struct LossAndGradient {
    /// `[batch]`.
    pub losses: Vec<f32>,
    /// As the motions.
    pub gradient: Vec<f32>,
}

/// Whether motions are `[lengths][frames][columns]` and none is longer than that or empty.
fn check(motions: &[f32], frames: usize, lengths: &[usize], columns: usize) -> Result<(), Error> {
    let fits = motions.len() == lengths.len() * frames * columns;
    if fits && lengths.iter().all(|length| (1..=frames).contains(length)) {
        return Ok(());
    }
    let expected = format!("{} of 1 to {frames} x {columns} numbers", lengths.len());
    let found = format!("{} numbers, lengths {lengths:?}", motions.len());
    Err(Error::input("Motions", expected, found))
}
