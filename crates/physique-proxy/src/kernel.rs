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

mod bounds;
mod contacts;
mod kinematics;
mod pairs;
mod prefetch;
mod shape;
mod skinning;
mod swings;
mod transpose;
mod workspace;

use physique_body::Joint;

use crate::Penalty;
use crate::lanes::{Kernel, Lanes, Simd};
use crate::plan::Plan;

pub(crate) use shape::ShapeSums;
pub(crate) use swings::Swings;
pub(crate) use workspace::Workspace;

/// What a frame is given by.
#[derive(Clone, Copy)]
pub(crate) enum Given<'a> {
    /// Local rotations, [`crate::PoseMatrices`].
    Rotations,
    /// Joint positions, [`crate::feature_loss::JointFrame`], and how they become rotations.
    Joints(&'a Swings),
}

const ROTATION_NUMBERS: usize = 9 * Joint::COUNT;
const JOINT_NUMBERS: usize = 3 * Joint::COUNT;
/// Most numbers of a frame.
const MOST_NUMBERS: usize = ROTATION_NUMBERS;

impl Given<'_> {
    /// Numbers of a frame.
    #[inline(always)]
    pub(crate) const fn numbers(self) -> usize {
        match self {
            Self::Rotations => ROTATION_NUMBERS,
            Self::Joints(_) => JOINT_NUMBERS,
        }
    }
}

/// One tile: exactly [`Simd::COUNT`] frames. `JOINTS` says whether joints are given: a constant, so
/// that a kernel for rotations holds no code for joints; with it, it would take twice the time.
pub(crate) struct Tile<'a, L, const JOINTS: bool> {
    pub(crate) plan: &'a Plan,
    pub(crate) penalty: Penalty,
    pub(crate) workspace: &'a mut Workspace<L>,
    pub(crate) given: Given<'a>,
    /// Rows of [`Given::numbers`].
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

impl<S: Simd, const JOINTS: bool> Kernel<S> for Tile<'_, S::Lanes, JOINTS> {
    /// Whether all losses are finite.
    type Output = bool;

    #[inline(always)]
    fn run(self, simd: S) -> bool {
        let (plan, work) = (self.plan, self.workspace);
        let ahead = prefetch::Ahead::new(self.frames, self.gradient.as_ref());
        let swings = match self.given {
            Given::Joints(swings) if JOINTS => Some(swings),
            _ => None,
        };
        let not_finite = if JOINTS && let Some(swings) = swings {
            let joints = work.joints.as_flattened_mut();
            let not_finite = transpose::load::<S, JOINT_NUMBERS>(simd, self.frames, joints);
            not_finite + swings::forward(simd, swings, work)
        } else {
            let local = work.local.as_flattened_mut();
            transpose::load::<S, ROTATION_NUMBERS>(simd, self.frames, local)
        };
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
            if JOINTS && let Some(swings) = swings {
                swings::backward(simd, swings, work);
                let joints = work.joints.as_flattened();
                transpose::store::<S, JOINT_NUMBERS>(simd, joints, gradient.by_frames);
            } else {
                let local = work.local.as_flattened();
                transpose::store::<S, ROTATION_NUMBERS>(simd, local, gradient.by_frames);
            }
        }
        self.losses[..S::COUNT].iter().all(|loss| loss.is_finite())
    }
}
