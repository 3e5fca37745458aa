//! The fused kernel: a tile of as many frames as a register has lanes, forward and back in one go.
//!
//! ```text
//! poses ── transpose ─▶ rotations ── kinematics ─▶ joints ── skinning ─▶ spheres
//!                                                             boxes ─▶ pairs ─▶ loss
//! gradient ◀─ transpose ── kinematics ◀── skinning ◀── gradient by spheres ◀──┘
//! ```
//!
//! Every stage reads what the last one left in a [`Workspace`] that fits the second-level cache.

mod bounds;
mod contacts;
mod kinematics;
mod pairs;
mod skinning;
mod transpose;
mod workspace;

use crate::lanes::{Kernel, Lanes, Simd};
use crate::plan::Plan;
use crate::{Penalty, PoseMatrices};

pub(crate) use workspace::Workspace;

/// One tile: exactly [`Simd::COUNT`] frames.
pub(crate) struct Tile<'a, L> {
    pub(crate) plan: &'a Plan,
    pub(crate) workspace: &'a mut Workspace<L>,
    pub(crate) penalty: Penalty,
    pub(crate) poses: &'a [PoseMatrices],
    pub(crate) losses: &'a mut [f32],
    pub(crate) gradient: Option<TileGradient<'a>>,
}

/// Where a tile's gradient goes.
pub(crate) struct TileGradient<'a> {
    /// Upstream derivative by each frame's loss.
    pub(crate) weights: &'a [f32],
    pub(crate) by_poses: &'a mut [PoseMatrices],
}

impl<S: Simd> Kernel<S> for Tile<'_, S::Lanes> {
    /// Whether all numbers are finite.
    type Output = bool;

    #[inline(always)]
    fn run(self, simd: S) -> bool {
        let (plan, work) = (self.plan, self.workspace);
        transpose::load(simd, self.poses, &mut work.local);
        kinematics::forward(simd, plan, work);
        skinning::forward(simd, plan, work);
        let poison = bounds::bound(simd, plan, work);
        let loss = match self.gradient {
            None => pairs::pairs::<S, false>(simd, plan, work, self.penalty),
            Some(_) => pairs::pairs::<S, true>(simd, plan, work, self.penalty),
        };
        (loss + poison).store(self.losses);
        if let Some(gradient) = self.gradient {
            let slope = match self.penalty {
                Penalty::Squared => 2.0,
                Penalty::Linear => 1.0,
            };
            let scale = simd.load(gradient.weights) * simd.splat(slope);
            skinning::backward(simd, plan, work, scale);
            kinematics::backward(simd, plan, work);
            transpose::store(simd, &work.local, gradient.by_poses);
        }
        self.losses[..S::COUNT].iter().all(|loss| loss.is_finite())
    }
}
