//! One motion on one body: every measure.

use physique_body::Body;
use physique_geometry::ScanOptions;
use physique_motion::Motion;
use physique_physics::{Physics, PhysicsOptions};
use schemars::JsonSchema;
use serde::Serialize;

use crate::Error;
use crate::frames::measure_frames;
use crate::physics_score::PhysicsScore;
use crate::self_intersection::{FrameIntersections, FrameMeter, SelfIntersection, Surface};
use crate::sia::{SiaMeter, SiaScore};

/// Which definition of the measures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Protocol {
    /// Physique's own: volumes exact along lines, intersections told apart from creases.
    #[default]
    Native,
    /// The voxel metric of the self-intersection-aware papers: see [`physique_geometry::sia`].
    Sia,
}

/// How to score.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScoreOptions {
    /// Which definition of the measures.
    pub protocol: Protocol,
    /// Distance between the lines of the scan in metres; the `sia` protocol has its own grid.
    pub spacing_m: f32,
}

impl Default for ScoreOptions {
    fn default() -> Self {
        Self {
            protocol: Protocol::Native,
            spacing_m: ScanOptions::default().spacing,
        }
    }
}

/// Every measure of one motion; those of other protocols are `None`.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MotionScore {
    /// Number of frames.
    pub frames: usize,
    /// Frames a second.
    pub frame_rate_fps: f64,
    /// Length in seconds.
    pub duration_s: f64,
    /// How much the body passes through itself.
    pub self_intersection: Option<SelfIntersection>,
    /// Ground, feet, balance and smoothness.
    pub physics: Option<PhysicsScore>,
    /// The published voxel metric.
    pub sia: Option<SiaScore>,
}

/// Scores a motion on a body with the default options: 1 cm lines, all threads.
///
/// # Errors
/// [`Error::NoFrames`] for an empty motion; [`Error::Geometry`] for a body whose surface is not
/// closed. Never a good score for something that was not measured.
pub fn score(motion: &Motion, body: &Body) -> Result<MotionScore, Error> {
    Scorer::new(body.clone(), ScoreOptions::default())?.score(motion)
}

/// Scores many motions on one body: what they share is prepared once.
#[derive(Clone, Debug)]
pub struct Scorer {
    body: Body,
    options: ScoreOptions,
    surface: Surface,
    /// For the native protocol only.
    physics: Option<Physics>,
}

impl Scorer {
    /// Prepares the body's surface.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a surface that is not closed or a spacing that is not a length.
    pub fn new(body: Body, options: ScoreOptions) -> Result<Self, Error> {
        let surface = Surface::new(&body)?;
        let physics = match options.protocol {
            Protocol::Native => Some(Physics::new(&body)?),
            Protocol::Sia => None,
        };
        let scorer = Self {
            body,
            options,
            surface,
            physics,
        };
        scorer.meter()?;
        Ok(scorer)
    }

    /// The body that is scored.
    pub const fn body(&self) -> &Body {
        &self.body
    }

    /// How it is scored.
    pub const fn options(&self) -> &ScoreOptions {
        &self.options
    }

    /// Scores a motion, frames in parallel. The result does not depend on the number of threads.
    ///
    /// # Errors
    /// As [`score`].
    pub fn score(&self, motion: &Motion) -> Result<MotionScore, Error> {
        self.score_with_progress(motion, |_| ())
    }

    /// As [`Scorer::score`]; `progress` is called with the number of frames done since the last
    /// call, from any thread.
    ///
    /// # Errors
    /// As [`score`].
    pub fn score_with_progress(
        &self,
        motion: &Motion,
        progress: impl Fn(usize) + Sync,
    ) -> Result<MotionScore, Error> {
        let mut score = MotionScore {
            frames: motion.frame_count(),
            frame_rate_fps: motion.frame_rate().per_second(),
            duration_s: motion.seconds(),
            self_intersection: None,
            physics: None,
            sia: None,
        };
        match self.options.protocol {
            Protocol::Native => {
                let frames = self.self_intersections(motion, progress)?;
                let measured = SelfIntersection::summarise(
                    &frames,
                    motion.frame_rate().frame_seconds(),
                    f64::from(self.options.spacing_m),
                    self.body.volume() * 1e6,
                );
                score.self_intersection = Some(measured.ok_or(Error::NoFrames)?);
                if let Some(physics) = &self.physics {
                    let found = physics.measure(motion, &PhysicsOptions::default())?;
                    score.physics = Some(PhysicsScore::from(&found));
                }
            }
            Protocol::Sia => {
                let frames = measure_frames(
                    motion.frame_count(),
                    || SiaMeter::new(&self.body, &self.surface.triangles),
                    |meter, frame| meter.measure(motion, frame),
                    progress,
                )?;
                score.sia = Some(SiaScore::summarise(&frames).ok_or(Error::NoFrames)?);
            }
        }
        Ok(score)
    }

    /// Self-intersection of every frame, in order, by the native definition.
    ///
    /// # Errors
    /// As [`score`], but no error for an empty motion.
    pub fn self_intersections(
        &self,
        motion: &Motion,
        progress: impl Fn(usize) + Sync,
    ) -> Result<Vec<FrameIntersections>, Error> {
        measure_frames(
            motion.frame_count(),
            || self.meter(),
            |meter, frame| meter.measure(motion.frame_rotations(frame)),
            progress,
        )
    }

    fn meter(&self) -> Result<FrameMeter<'_>, Error> {
        let scan = ScanOptions {
            spacing: self.options.spacing_m,
            ..ScanOptions::default()
        };
        FrameMeter::new(&self.body, &self.surface, scan)
    }
}
