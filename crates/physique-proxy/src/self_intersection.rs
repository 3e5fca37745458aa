//! The self-intersection loss of a sphere body, with its gradient, at full speed.

use std::fmt;

use physique_body::Joint;

use crate::engine::{Build, Engine, Given, Request};
use crate::feature_loss::JointFrame;
use crate::kernel::{ShapeSums, Swings, TileGradient};
use crate::plan::Plan;
use crate::shape_gradient::ShapeGradient;
use crate::{Backend, Error, Pairs, Penalty, PoseMatrices, SphereBody};

/// How the loss is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfIntersectionOptions {
    /// Cost of two spheres' overlap.
    pub penalty: Penalty,
    /// Depth that is free, in the body's unit.
    pub tolerance: f32,
    /// Vector instructions to use; the best that the processor has where `None`.
    pub backend: Option<Backend>,
}

impl Default for SelfIntersectionOptions {
    fn default() -> Self {
        Self {
            penalty: Penalty::Squared,
            tolerance: 0.0,
            backend: None,
        }
    }
}

/// The self-intersection loss of one sphere body: equation 7 of the paper, frame by frame,
/// `sum over pairs of max(0, r_i + r_j - |c_i - c_j| - tolerance)^2` of the posed centres.
///
/// Kinematics, skinning, the search for touching spheres and the whole way back run as one fused
/// kernel over tiles of 4 to 16 frames; see [`Backend`]. Only pairs whose distance can matter are
/// measured, and none that touches is missed. Memory beyond inputs and outputs: some 200 kB a thread,
/// whatever the number of frames. The result is the same, to the bit, for any number of threads of
/// one backend.
pub struct SelfIntersection {
    engine: Box<dyn Engine>,
    backend: Backend,
    body: SphereBody,
    pairs: Pairs,
    options: SelfIntersectionOptions,
}

impl SelfIntersection {
    /// Prepares the loss; one to two milliseconds for 192 spheres.
    ///
    /// # Errors
    /// As [`SelfIntersection::with_options`].
    pub fn new(body: &SphereBody, pairs: &Pairs) -> Result<Self, Error> {
        Self::with_options(body, pairs, &SelfIntersectionOptions::default())
    }

    /// Prepares the loss.
    ///
    /// # Errors
    /// As [`SphereBody::check`]; [`Error::PairCount`] for pairs of another number of spheres;
    /// [`Error::Tolerance`] unless the tolerance is finite; [`Error::Backend`] for one that this
    /// processor lacks.
    pub fn with_options(
        body: &SphereBody,
        pairs: &Pairs,
        options: &SelfIntersectionOptions,
    ) -> Result<Self, Error> {
        body.check()?;
        if pairs.sphere_count() != body.sphere_count() {
            return Err(Error::PairCount {
                expected: body.sphere_count(),
                found: pairs.sphere_count(),
            });
        }
        if !options.tolerance.is_finite() {
            return Err(Error::Tolerance {
                found: options.tolerance,
            });
        }
        let backend = options.backend.unwrap_or_else(Backend::best);
        let build = Build {
            plan: Plan::new(body, pairs, options.tolerance),
            penalty: options.penalty,
        };
        let engine = backend.dispatch(build).ok_or(Error::Backend { backend })?;
        Ok(Self {
            engine,
            backend,
            body: body.clone(),
            pairs: pairs.clone(),
            options: *options,
        })
    }

    /// The vector instructions in use.
    pub fn backend(&self) -> Backend {
        self.backend
    }

    /// The body that it is of.
    pub const fn body(&self) -> &SphereBody {
        &self.body
    }

    /// The spheres that it compares.
    pub const fn pairs(&self) -> &Pairs {
        &self.pairs
    }

    /// How it is measured.
    pub const fn options(&self) -> &SelfIntersectionOptions {
        &self.options
    }

    /// The loss of every frame, into `losses`.
    ///
    /// # Errors
    /// [`Error::Length`] unless there is one loss a frame; [`Error::NotFinite`] or
    /// [`Error::Overflow`] for rotations that are no numbers, or too large, after which the
    /// outputs mean nothing.
    pub fn losses(&self, poses: &[PoseMatrices], losses: &mut [f32]) -> Result<(), Error> {
        check_length("Losses", poses, losses.len())?;
        let request = Request {
            given: Given::Rotations,
            frames: poses.as_flattened().as_flattened(),
            losses,
            gradient: None,
        };
        refuse(poses, self.engine.evaluate(request, false).not_finite)
    }

    /// The loss of every frame, and the gradient of `sum over frames of weight * loss` by the
    /// entries of the rotation matrices, into `losses` and `by_poses`.
    ///
    /// `weights` are the derivatives of what is trained by each frame's loss: `1 / frames` each
    /// for a mean, 0 for padding.
    ///
    /// # Errors
    /// As [`SelfIntersection::losses`].
    pub fn gradient(
        &self,
        poses: &[PoseMatrices],
        weights: &[f32],
        losses: &mut [f32],
        by_poses: &mut [PoseMatrices],
    ) -> Result<(), Error> {
        self.evaluate(poses, weights, losses, by_poses, false)?;
        Ok(())
    }

    /// As [`SelfIntersection::gradient`]; returns the gradient by the shape as well, from which a
    /// proxy's regressors have the one by the betas. Costs about twice as much.
    ///
    /// # Errors
    /// As [`SelfIntersection::losses`].
    pub fn shape_gradient(
        &self,
        poses: &[PoseMatrices],
        weights: &[f32],
        losses: &mut [f32],
        by_poses: &mut [PoseMatrices],
    ) -> Result<ShapeGradient, Error> {
        let sums = self.evaluate(poses, weights, losses, by_poses, true)?;
        Ok(ShapeGradient::new(&self.engine.plan().order, sums.as_ref()))
    }

    /// The loss of every frame of joints, and where `gradient` is given, as many weights and the
    /// gradient of their sum by the joints.
    ///
    /// # Errors
    /// As [`SelfIntersection::losses`].
    pub(crate) fn of_joints(
        &self,
        swings: &Swings,
        joints: &[JointFrame],
        losses: &mut [f32],
        gradient: Option<(&[f32], &mut [JointFrame])>,
    ) -> Result<(), Error> {
        check_length("Losses", joints, losses.len())?;
        if let Some((weights, by_joints)) = &gradient {
            check_length("Weights", joints, weights.len())?;
            check_length("Gradient", joints, by_joints.len())?;
        }
        let gradient = gradient.map(|(weights, by_joints)| TileGradient {
            weights,
            by_frames: by_joints.as_flattened_mut().as_flattened_mut(),
        });
        let request = Request {
            given: Given::Joints(swings),
            frames: joints.as_flattened().as_flattened(),
            losses,
            gradient,
        };
        refuse(joints, self.engine.evaluate(request, false).not_finite)
    }

    /// Losses and gradient; with `shape`, also the sums of the gradient by the shape.
    fn evaluate(
        &self,
        poses: &[PoseMatrices],
        weights: &[f32],
        losses: &mut [f32],
        by_poses: &mut [PoseMatrices],
        shape: bool,
    ) -> Result<Option<ShapeSums>, Error> {
        check_length("Losses", poses, losses.len())?;
        check_length("Weights", poses, weights.len())?;
        check_length("Gradient", poses, by_poses.len())?;
        let by_frames = by_poses.as_flattened_mut().as_flattened_mut();
        let request = Request {
            given: Given::Rotations,
            frames: poses.as_flattened().as_flattened(),
            losses,
            gradient: Some(TileGradient { weights, by_frames }),
        };
        let outcome = self.engine.evaluate(request, shape);
        refuse(poses, outcome.not_finite)?;
        Ok(outcome.shape)
    }
}

impl fmt::Debug for SelfIntersection {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("SelfIntersection")
            .field("backend", &self.backend)
            .field("options", &self.options)
            .finish_non_exhaustive()
    }
}

/// One element a frame.
pub(crate) fn check_length<T>(what: &'static str, frames: &[T], found: usize) -> Result<(), Error> {
    if found == frames.len() {
        return Ok(());
    }
    Err(Error::Length {
        what,
        expected: frames.len(),
        found,
    })
}

/// Names the frame whose loss is not finite, and the joint where that began.
pub(crate) fn refuse<const N: usize>(
    frames: &[[[f32; N]; Joint::COUNT]],
    frame: Option<usize>,
) -> Result<(), Error> {
    let Some(frame) = frame else {
        return Ok(());
    };
    let finite = |numbers: &[f32; N]| numbers.iter().all(|number| number.is_finite());
    let joint = frames[frame].iter().position(|numbers| !finite(numbers));
    Err(match joint.and_then(Joint::from_index) {
        Some(joint) => Error::NotFinite { frame, joint },
        None => Error::Overflow { frame },
    })
}
