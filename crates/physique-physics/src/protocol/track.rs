//! What most protocols look at: joints and the lowest skin of every frame, above the floor.

use glam::{DVec2, DVec3};
use physique_body::{Joint, Pose, PosedBody};
use physique_motion::Motion;

use super::Floor;
use crate::balance::on_ground;
use crate::{Error, Physics};

/// Joints and lowest skin, heights counted from the floor.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) frames_per_second: f64,
    /// Height of the floor in the motion's world, in metres.
    pub(super) floor: f64,
    /// `[frames][22]`.
    pub(super) joints: Vec<[DVec3; Joint::COUNT]>,
    /// `[frames]` height of the lowest skin.
    pub(super) lowest_skin: Vec<f64>,
}

impl Track {
    pub(super) fn new(physics: &Physics, motion: &Motion, floor: Floor) -> Result<Self, Error> {
        let mut posed = physics.body().posed();
        let mut joints = Vec::with_capacity(motion.frame_count());
        let mut lowest_skin = Vec::with_capacity(motion.frame_count());
        for frame in 0..motion.frame_count() {
            pose(physics, motion, frame, &mut posed)?;
            joints.push(Joint::ALL.map(|joint| posed.joint(joint).as_dvec3()));
            let heights = posed.vertices().iter().map(|vertex| vertex.y);
            lowest_skin.push(f64::from(heights.fold(f32::MAX, f32::min)));
        }
        let lowest = lowest_skin.iter().copied().fold(f64::MAX, f64::min);
        let floor = match floor {
            Floor::AsGiven => 0.0,
            Floor::Lowest => lowest,
            Floor::HumosSink => lowest + 0.02,
        };
        for joints in &mut joints {
            joints.iter_mut().for_each(|joint| joint.y -= floor);
        }
        lowest_skin.iter_mut().for_each(|height| *height -= floor);
        Ok(Self {
            frames_per_second: motion.frame_rate().per_second(),
            floor,
            joints,
            lowest_skin,
        })
    }

    pub(super) fn height(&self, frame: usize, joint: Joint) -> f64 {
        self.joints[frame][joint.index()].y
    }

    /// Displacement of a joint to the next frame.
    pub(super) fn step(&self, frame: usize, joint: Joint) -> DVec3 {
        self.joints[frame + 1][joint.index()] - self.joints[frame][joint.index()]
    }

    /// Horizontal part of [`Track::step`].
    pub(super) fn step_on_ground(&self, frame: usize, joint: Joint) -> DVec2 {
        on_ground(self.step(frame, joint))
    }

    /// Frames that have a next one.
    pub(super) fn pairs(&self) -> std::ops::Range<usize> {
        0..self.joints.len() - 1
    }

    /// Whether a joint is below a height in a frame and the next.
    pub(super) fn stays_below(&self, frame: usize, joint: Joint, height: f64) -> bool {
        self.height(frame, joint) < height && self.height(frame + 1, joint) < height
    }
}

/// Poses a frame of a motion.
pub(super) fn pose(
    physics: &Physics,
    motion: &Motion,
    frame: usize,
    posed: &mut PosedBody,
) -> Result<(), Error> {
    let pose = Pose {
        root_translation: motion.root_translation()[frame],
        rotations: motion.frame_rotations(frame),
    };
    Ok(physics.body().pose(&pose, posed)?)
}
