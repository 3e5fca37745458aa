//! Joint transforms of a stretch of a motion, and their derivatives.

use std::ops::Range;

use glam::{DMat3, DMat4};
use physique_motion::Motion;

use crate::{Rig, TimeFilter};

/// `[frames][joints]` transforms of the frames `first..`, flat.
#[derive(Clone, Debug, Default)]
pub(crate) struct Transforms {
    first: usize,
    joints: usize,
    world_from_rest: Vec<DMat4>,
}

impl Transforms {
    /// Poses the frames of a range.
    pub(crate) fn of(rig: &Rig, motion: &Motion, frames: Range<usize>) -> Self {
        let mut frame_transforms = Vec::with_capacity(rig.joint_count());
        let mut world_from_rest = Vec::with_capacity(frames.len() * rig.joint_count());
        for frame in frames.clone() {
            let rotations = motion.frame_rotations(frame).iter();
            rig.pose(
                rotations.map(|q| DMat3::from_quat(q.as_dquat().normalize())),
                motion.root_translation()[frame].as_dvec3(),
                &mut frame_transforms,
            );
            world_from_rest.extend_from_slice(&frame_transforms);
        }
        Self {
            first: frames.start,
            joints: rig.joint_count(),
            world_from_rest,
        }
    }

    /// `[joints]` transforms of a frame of the motion.
    pub(crate) fn frame(&self, frame: usize) -> &[DMat4] {
        let begin = (frame - self.first) * self.joints;
        &self.world_from_rest[begin..begin + self.joints]
    }

    /// `[joints]` derivatives of this order at a frame that the filter covers.
    pub(crate) fn derivative(
        &self,
        filter: &TimeFilter,
        order: usize,
        frame: usize,
        derivative: &mut Vec<DMat4>,
    ) {
        derivative.clear();
        derivative.resize(self.joints, DMat4::ZERO);
        for (offset, &tap) in filter.taps(order).iter().enumerate() {
            let transforms = self.frame(frame + offset - filter.reach());
            for (sum, transform) in derivative.iter_mut().zip(transforms) {
                *sum += *transform * tap;
            }
        }
    }

    /// `[joints]` transforms between frames, each number linearly between its neighbours'.
    pub(crate) fn interpolated(&self, position: f64, transforms: &mut Vec<DMat4>) {
        let before = position.floor();
        let part = position - before;
        let before = before as usize;
        transforms.clear();
        transforms.extend_from_slice(self.frame(before));
        if part > 0.0 {
            for (transform, next) in transforms.iter_mut().zip(self.frame(before + 1)) {
                *transform += (*next - *transform) * part;
            }
        }
    }
}
