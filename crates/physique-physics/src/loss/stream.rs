//! A motion through a window of posed frames: forward, and back again.

use std::collections::VecDeque;

use glam::{DMat3, DMat4, DVec3};
use physique_motion::FrameRate;

use super::shaped::RestGradient;
use super::{FrameLoss, LossBody, ShapedBody};
use crate::Error;
use crate::rig::{PoseGradient, outer};

/// A motion as slices.
#[derive(Clone, Copy, Debug)]
pub struct MotionSlices<'a> {
    /// Frames a second.
    pub frame_rate: FrameRate,
    /// `[frames][joints]` local rotation matrices, flat; 22 joints, or up to the model's.
    pub rotations: &'a [DMat3],
    /// `[frames]` root translations, in metres.
    pub root: &'a [DVec3],
    /// Change of the betas against those that the [`LossBody`] was prepared with.
    pub betas: &'a [f64],
}

/// Derivatives of a loss to everything in [`MotionSlices`].
///
/// Those of the rotations are to the nine entries of each matrix, as if they were free: chain them
/// to any parametrisation, or use [`MotionGradient::rotation_vectors`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionGradient {
    /// `[frames][joints]`, flat.
    pub rotations: Vec<DMat3>,
    /// `[frames]`.
    pub root: Vec<DVec3>,
    /// `[betas]` of the model.
    pub betas: Vec<f64>,
}

impl MotionGradient {
    /// Derivatives to small turns `R -> exp(w) R` of each rotation, in its parent's axes.
    pub fn rotation_vectors(&self, rotations: &[DMat3]) -> Vec<DVec3> {
        let turned = |(gradient, rotation): (&DMat3, &DMat3)| {
            // d(exp(w) R) = [w] R: the derivative is the antisymmetric part of G R^T.
            let torque = *gradient * rotation.transpose();
            DVec3::new(
                torque.y_axis.z - torque.z_axis.y,
                torque.z_axis.x - torque.x_axis.z,
                torque.x_axis.y - torque.y_axis.x,
            )
        };
        self.rotations.iter().zip(rotations).map(turned).collect()
    }
}

/// Evaluates a loss; fills `gradient` where one is given.
///
/// The loss is the mean over all frames that have a term. Its gradient costs about as much again.
///
/// # Errors
/// [`Error::NoFrames`] for a motion without frames; [`Error::Length`] for slices that disagree.
pub fn evaluate(
    body: &LossBody,
    motion: &MotionSlices<'_>,
    loss: &dyn FrameLoss,
    gradient: Option<&mut MotionGradient>,
) -> Result<f64, Error> {
    let frames = motion.root.len();
    let joints = check(body, motion)?;
    let shaped = body.shaped(motion.betas);
    let (first, terms) = if loss.at_ends() {
        (0, frames)
    } else {
        (loss.reach(), frames.saturating_sub(2 * loss.reach()))
    };
    let mut stream = Stream {
        shaped: &shaped,
        motion: *motion,
        joints,
        window: VecDeque::new(),
        begin: 0,
        spare: Vec::new(),
        rest: gradient.is_some().then(|| RestGradient::new(&shaped)),
        pose: PoseGradient::default(),
    };
    let mut output = MotionGradient::default();
    let mut total = 0.0;
    for frame in first..first + terms {
        stream.advance(frame, loss.reach(), &mut output);
        let mut window = Window {
            shaped: &shaped,
            frame_rate: motion.frame_rate,
            frame,
            middle: frame - stream.begin,
            frames: stream.window.make_contiguous(),
            rest: stream.rest.as_mut(),
        };
        total += loss.term(&mut window, 1.0 / terms as f64);
    }
    let betas = stream.finish(&mut output);
    if let Some(gradient) = gradient {
        output.betas = betas;
        output.rotations.resize(motion.rotations.len(), DMat3::ZERO);
        output.root.resize(frames, DVec3::ZERO);
        *gradient = output;
    }
    Ok(if terms == 0 {
        0.0
    } else {
        total / terms as f64
    })
}

pub(super) fn check(body: &LossBody, motion: &MotionSlices<'_>) -> Result<usize, Error> {
    let frames = motion.root.len();
    if frames == 0 {
        return Err(Error::NoFrames);
    }
    let joints = motion.rotations.len() / frames;
    let most = body.rig.joint_count();
    if joints * frames != motion.rotations.len() || joints == 0 || joints > most {
        return Err(Error::Length {
            what: "the rotations",
            expected: frames * joints.clamp(1, most),
            found: motion.rotations.len(),
        });
    }
    if motion.betas.len() > body.beta_count() {
        return Err(Error::Length {
            what: "the betas",
            expected: body.beta_count(),
            found: motion.betas.len(),
        });
    }
    Ok(joints)
}

/// A posed frame and the gradient to its transforms.
#[derive(Clone, Debug, Default)]
pub(crate) struct WindowFrame {
    transforms: Vec<DMat4>,
    gradient: Vec<DMat4>,
}

struct Stream<'a> {
    shaped: &'a ShapedBody<'a>,
    motion: MotionSlices<'a>,
    joints: usize,
    window: VecDeque<WindowFrame>,
    /// Frame number of the window's first.
    begin: usize,
    spare: Vec<WindowFrame>,
    rest: Option<RestGradient>,
    pose: PoseGradient,
}

impl<'a> Stream<'a> {
    fn rotations(&self, frame: usize) -> &'a [DMat3] {
        &self.motion.rotations[frame * self.joints..(frame + 1) * self.joints]
    }

    /// Moves the window on to the frames within reach of `frame`.
    fn advance(&mut self, frame: usize, reach: usize, output: &mut MotionGradient) {
        while self.begin + reach < frame {
            self.retire(output);
        }
        let end = (frame + reach + 1).min(self.motion.root.len());
        for next in self.begin + self.window.len()..end {
            let mut posed = self.spare.pop().unwrap_or_default();
            let rotations = self.rotations(next).iter().copied();
            let root = self.motion.root[next];
            self.shaped.rig.pose(rotations, root, &mut posed.transforms);
            posed.gradient.clear();
            posed.gradient.resize(posed.transforms.len(), DMat4::ZERO);
            self.window.push_back(posed);
        }
    }

    /// Takes the first frame out of the window and carries its gradient back to the pose.
    fn retire(&mut self, output: &mut MotionGradient) {
        let Some(mut posed) = self.window.pop_front() else {
            self.begin += 1;
            return;
        };
        let frame = self.begin;
        self.begin += 1;
        if let Some(mut rest) = self.rest.take() {
            self.shaped.rig.pose_backward(
                self.rotations(frame),
                &posed.transforms,
                &mut posed.gradient,
                &mut self.pose,
                &mut rest.joints,
            );
            self.rest = Some(rest);
            output.rotations.extend_from_slice(&self.pose.rotations);
            output.root.push(self.pose.root);
        }
        self.spare.push(posed);
    }

    /// Carries back what is left; returns the derivatives to the betas.
    fn finish(mut self, output: &mut MotionGradient) -> Vec<f64> {
        while !self.window.is_empty() {
            self.retire(output);
        }
        let rest = self.rest.as_ref();
        rest.map_or_else(Vec::new, |rest| rest.betas(self.shaped))
    }
}

/// The frames around one frame, with their gradients.
pub struct Window<'a> {
    pub(crate) shaped: &'a ShapedBody<'a>,
    pub(crate) frame_rate: FrameRate,
    /// Number of the frame in the middle.
    pub(crate) frame: usize,
    middle: usize,
    frames: &'a mut [WindowFrame],
    rest: Option<&'a mut RestGradient>,
}

impl Window<'_> {
    fn index(&self, offset: isize) -> usize {
        self.middle.saturating_add_signed(offset)
    }

    /// Transforms of the frame at an offset from the middle.
    pub(crate) fn transforms(&self, offset: isize) -> &[DMat4] {
        &self.frames[self.index(offset)].transforms
    }

    /// A skin point in the world.
    pub(crate) fn skin_point(&self, offset: isize, point: usize) -> DVec3 {
        self.shaped.posed_skin(point, self.transforms(offset))
    }

    /// Adds the gradient of a skin point in the world.
    pub(crate) fn add_skin_gradient(&mut self, offset: isize, point: usize, gradient: DVec3) {
        let index = self.index(offset);
        let rest = self.shaped.skin[point];
        let Some(rest_gradient) = &mut self.rest else {
            return;
        };
        let frame = &mut self.frames[index];
        for &(joint, weight) in &self.shaped.body.skin[point].weights {
            let weighted = gradient * weight;
            add_outer(&mut frame.gradient[joint], weighted, rest);
            let linear = DMat3::from_mat4(frame.transforms[joint]);
            rest_gradient.skin[point] += linear.transpose() * weighted;
        }
    }

    /// Where gradients to the transforms at an offset and to the moments go; `None` where no
    /// gradient is wanted.
    pub(crate) fn gradients(&mut self, offset: isize) -> Option<(&mut [DMat4], &mut RestGradient)> {
        let index = self.index(offset);
        let rest = self.rest.as_deref_mut()?;
        Some((&mut self.frames[index].gradient, rest))
    }
}

/// Adds the gradient of `transform * (rest, 1)` to the gradient of the transform.
fn add_outer(transform: &mut DMat4, gradient: DVec3, rest: DVec3) {
    let linear = outer(gradient, rest);
    transform.x_axis += linear.x_axis.extend(0.0);
    transform.y_axis += linear.y_axis.extend(0.0);
    transform.z_axis += linear.z_axis.extend(0.0);
    transform.w_axis += gradient.extend(0.0);
}
