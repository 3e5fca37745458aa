//! The fused kernel: a tile of as many frames as a register has lanes, forward and back in one go.
//!
//! ```text
//! poses ── transpose ─▶ rotations ── kinematics ─▶ joints ── skinning ─▶ spheres
//!                                                          boxes ─▶ pairs ─▶ loss
//! gradient ◀─ transpose ── kinematics ◀── skinning ◀── by spheres ◀──┘
//! ```
//!
//! Where joint positions are given instead of poses, [`swings`] stand between them and rotations.
//!
//! Every stage reads what the last one left in a [`Workspace`] that fits the second-level cache.
//!
//! Stages go by index where lanes are concerned: a closure, and an iterator that holds one, is inlined
//! only where the compiler pleases, and what is not is compiled for the least processor.
#![allow(clippy::needless_range_loop, clippy::manual_memcpy)]

mod bounds;
mod contacts;
mod input;
mod kinematics;
mod pairs;
mod prefetch;
mod shape;
mod skinning;
mod swings;
mod transpose;
mod vectors;
mod workspace;

use crate::Penalty;
use crate::lanes::{Kernel, Lanes, Simd};
use crate::plan::Plan;

pub(crate) use input::{Input, Joints, Rotations};
pub(crate) use shape::ShapeSums;
pub(crate) use swings::Swings;
pub(crate) use workspace::Workspace;

/// Most numbers of a frame.
const MOST_NUMBERS: usize = Rotations::NUMBERS;

/// One tile: exactly [`Simd::COUNT`] frames.
pub(crate) struct Tile<'a, L, I> {
    pub(crate) input: I,
    pub(crate) plan: &'a Plan,
    pub(crate) penalty: Penalty,
    pub(crate) workspace: &'a mut Workspace<L>,
    /// Rows of [`Input::NUMBERS`].
    pub(crate) frames: &'a [f32],
    pub(crate) losses: &'a mut [f32],
    pub(crate) gradient: Option<TileGradient<'a>>,
    /// Where the derivatives by the shape are added up; needs a gradient.
    pub(crate) shape: Option<&'a mut ShapeSums>,
}

/// Where a tile's gradient goes.
pub(crate) struct TileGradient<'a> {
    /// Upstream derivative by each frame's loss.
    pub(crate) weights: &'a [f32],
    /// As the frames.
    pub(crate) by_frames: &'a mut [f32],
}

impl<S: Simd, I: Input> Kernel<S> for Tile<'_, S::Lanes, I> {
    /// Whether all losses are finite.
    type Output = bool;

    #[inline(always)]
    fn run(self, simd: S) -> bool {
        let (plan, work) = (self.plan, self.workspace);
        let ahead = prefetch::Ahead::new(self.frames, self.gradient.as_ref());
        let not_finite = self.input.forward(simd, self.frames, work);
        ahead.part(0);
        kinematics::forward(simd, plan, work);
        ahead.part(1);
        skinning::forward(simd, plan, work);
        ahead.part(2);
        let too_far = bounds::bound(simd, plan, work);
        ahead.part(3);
        // Calls, not a choice of functions: through a pointer nothing is inlined.
        let penalty = self.penalty;
        let loss = match (&self.gradient, &self.shape) {
            (None, _) => pairs::pairs::<S, false, false>(simd, plan, work, penalty),
            (_, None) => pairs::pairs::<S, true, false>(simd, plan, work, penalty),
            (_, Some(_)) => pairs::pairs::<S, true, true>(simd, plan, work, penalty),
        };
        (loss + not_finite + too_far).store(self.losses);
        if let Some(gradient) = self.gradient {
            let slope = match self.penalty {
                Penalty::Squared => 2.0,
                Penalty::Linear => 1.0,
            };
            let scale = simd.load(gradient.weights) * simd.splat(slope);
            skinning::backward(simd, plan, work, scale);
            if let Some(shape) = self.shape {
                shape::add_skin(simd, plan, work, scale, shape);
                kinematics::backward(simd, plan, work);
                shape::add_joints(work, shape);
            } else {
                kinematics::backward(simd, plan, work);
            }
            self.input.backward(simd, work, gradient.by_frames);
        }
        self.losses[..S::COUNT].iter().all(|loss| loss.is_finite())
    }
}
