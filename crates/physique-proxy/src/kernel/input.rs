//! What frames are given by: where the kernel's way there begins, and its way back ends.

use physique_body::Joint;

use super::{Swings, Workspace, swings, transpose};
use crate::lanes::Simd;

/// One way to give frames. Each has a type, not a value, of its own, so that the kernel for one holds
/// no code for the other: with both in it, it takes twice the time.
pub(crate) trait Input: Copy {
    /// Numbers of a frame.
    const NUMBERS: usize;

    /// From a tile's frames to `work.local`. Returns 0 in lanes of finite frames, else NaN.
    fn forward<S: Simd>(self, simd: S, frames: &[f32], work: &mut Workspace<S::Lanes>) -> S::Lanes;

    /// From the derivatives in `work.local` to those by the frames.
    fn backward<S: Simd>(self, simd: S, work: &mut Workspace<S::Lanes>, by_frames: &mut [f32]);
}

/// Local rotations, [`crate::PoseMatrices`].
#[derive(Clone, Copy)]
pub(crate) struct Rotations;

/// Joint positions, [`crate::feature_loss::JointFrame`], and how they become rotations.
#[derive(Clone, Copy)]
pub(crate) struct Joints<'a>(pub(crate) &'a Swings);

impl Input for Rotations {
    const NUMBERS: usize = 9 * Joint::COUNT;

    #[inline(always)]
    fn forward<S: Simd>(self, simd: S, frames: &[f32], work: &mut Workspace<S::Lanes>) -> S::Lanes {
        let local = work.local.as_flattened_mut();
        transpose::load::<S, { Self::NUMBERS }>(simd, frames, local)
    }

    #[inline(always)]
    fn backward<S: Simd>(self, simd: S, work: &mut Workspace<S::Lanes>, by_frames: &mut [f32]) {
        let local = work.local.as_flattened();
        transpose::store::<S, { Self::NUMBERS }>(simd, local, by_frames);
    }
}

impl Input for Joints<'_> {
    const NUMBERS: usize = 3 * Joint::COUNT;

    #[inline(always)]
    fn forward<S: Simd>(self, simd: S, frames: &[f32], work: &mut Workspace<S::Lanes>) -> S::Lanes {
        let joints = work.joints.as_flattened_mut();
        let not_finite = transpose::load::<S, { 3 * Joint::COUNT }>(simd, frames, joints);
        not_finite + swings::forward(simd, self.0, work)
    }

    #[inline(always)]
    fn backward<S: Simd>(self, simd: S, work: &mut Workspace<S::Lanes>, by_frames: &mut [f32]) {
        swings::backward(simd, self.0, work);
        let joints = work.joints.as_flattened();
        transpose::store::<S, { 3 * Joint::COUNT }>(simd, joints, by_frames);
    }
}
