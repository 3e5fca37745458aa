//! The published voxel metric of self-intersection, on the motion's own rotations.
//!
//! [`physique_geometry::sia`] defines the count and says where it misleads. The papers feed it
//! rotations of their own inverse kinematics, without twist or tilt of the pelvis; here the
//! motion's rotations are measured as they are.

use glam::Vec3;
use physique_body::{Body, Pose, PosedBody};
use physique_geometry::Triangles;
use physique_geometry::sia::{SiaCounter, SiaVolumes, UnitBall};
use physique_motion::Motion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Error;

/// Means over all frames, in the "cm3" of a body whose rest pose fills the unit ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SiaScore {
    /// Sum of the counts of 2 or more, times 216 cm3.
    pub self_intersection_cm3: f64,
    /// Sum of all counts, times 216 cm3.
    pub volume_cm3: f64,
    /// Self-intersection over volume, in per cent.
    pub self_intersection_percent: f64,
}

impl SiaScore {
    /// Means over frames; `None` without frames.
    pub(crate) fn summarise(frames: &[SiaVolumes]) -> Option<Self> {
        let count = frames.len() as f64;
        let mean = |of: fn(&SiaVolumes) -> f64| frames.iter().map(of).sum::<f64>() / count;
        (!frames.is_empty()).then(|| Self {
            self_intersection_cm3: mean(|frame| frame.self_intersection_cm3),
            volume_cm3: mean(|frame| frame.volume_cm3),
            self_intersection_percent: mean(|frame| frame.percent().unwrap_or(0.0)),
        })
    }
}

/// Counts frame after frame; one a thread.
pub(crate) struct SiaMeter<'a> {
    body: &'a Body,
    ball: UnitBall,
    posed: PosedBody,
    ball_positions: Vec<Vec3>,
    counter: SiaCounter,
}

impl<'a> SiaMeter<'a> {
    pub(crate) fn new(body: &'a Body, triangles: &Triangles) -> Result<Self, Error> {
        Ok(Self {
            body,
            ball: UnitBall::around(body.rest_vertices())?,
            posed: body.posed(),
            ball_positions: Vec::new(),
            counter: SiaCounter::new(triangles)?,
        })
    }

    pub(crate) fn measure(&mut self, motion: &Motion, frame: usize) -> Result<SiaVolumes, Error> {
        // As published: the path is left out, so that the posed body stays about the ball.
        let pose = Pose {
            root_translation: Vec3::ZERO,
            rotations: motion.frame_rotations(frame),
        };
        self.body.pose(&pose, &mut self.posed)?;
        self.ball_positions.clear();
        let in_ball = |&vertex: &Vec3| self.ball.ball_from_world(vertex);
        self.ball_positions
            .extend(self.posed.vertices().iter().map(in_ball));
        Ok(self.counter.count(&self.ball_positions)?)
    }
}
