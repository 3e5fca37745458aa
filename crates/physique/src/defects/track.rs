//! Where the joints are, and how far they go from frame to frame.

use glam::{Affine3A, Vec3};
use physique_body::{Body, Joint};
use physique_motion::Motion;

use crate::Error;

/// Positions of the 22 joints over a motion.
pub(super) struct JointTrack<'a> {
    motion: &'a Motion,
    /// `[frames][22]`, in metres.
    positions: Vec<[Vec3; Joint::COUNT]>,
}

/// From a frame to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    /// Distance in metres.
    pub(super) metres: f32,
    /// Turn of the joint in its parent, in radians.
    pub(super) radians: f32,
}

impl<'a> JointTrack<'a> {
    pub(super) fn new(motion: &'a Motion, body: &Body) -> Result<Self, Error> {
        let mut world_from_joint = Vec::new();
        let positions = (0..motion.frame_count()).map(|frame| {
            body.pose_joints(&motion.pose(frame), &mut world_from_joint)?;
            let joints: &[Affine3A] = &world_from_joint;
            Ok(Joint::ALL.map(|joint| Vec3::from(joints[joint.index()].translation)))
        });
        Ok(Self {
            motion,
            positions: positions.collect::<Result<_, Error>>()?,
        })
    }

    /// Number of steps: one less than frames.
    pub(super) fn steps(&self) -> usize {
        self.positions.len().saturating_sub(1)
    }

    pub(super) fn frame_s(&self) -> f64 {
        self.motion.frame_rate().frame_seconds()
    }

    /// The step of a joint from `frame` to the next.
    pub(super) fn step(&self, frame: usize, joint: Joint) -> Step {
        let turn = |frame: usize| self.motion.frame_rotations(frame)[joint.index()];
        let place = |frame: usize| self.positions[frame][joint.index()];
        let between = turn(frame).conjugate() * turn(frame + 1);
        Step {
            metres: place(frame).distance(place(frame + 1)),
            // By the sine: exact for the small turns, where the cosine is all 1.
            radians: 2.0 * between.xyz().length().min(1.0).asin(),
        }
    }
}
