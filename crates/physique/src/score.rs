//! One motion on one body: every measure.

use physique_body::Body;
use physique_geometry::ScanOptions;
use physique_motion::{FrameRate, Motion};
use physique_physics::protocol::measure as measure_published;
use physique_physics::{Floor as MotionFloor, Physics, PhysicsOptions};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::floor::lowered;
use crate::frames::measure_frames;
use crate::measures::needs_floor;
use crate::physics_score::{BalanceScore, FeetScore, GroundScore, SmoothnessScore};
use crate::self_intersection::{FrameIntersections, FrameMeter, SelfIntersection, Surface};
use crate::sia::{SiaMeter, SiaScore};
use crate::{Error, Floor, Group, Protocol, PublishedScore, Series};

/// How to score.
#[derive(Clone, Debug, PartialEq)]
pub struct ScoreOptions {
    /// Which definitions of the measures.
    pub protocols: Vec<Protocol>,
    /// Which groups of Physique's own measures.
    pub groups: Vec<Group>,
    /// Where the floor is.
    pub floor: Floor,
    /// Distance between the lines of the scan in metres; the `sia` protocol has its own grid.
    pub spacing_m: f32,
    /// Whether the measures of every frame are kept.
    pub series: bool,
}

impl Default for ScoreOptions {
    fn default() -> Self {
        Self {
            protocols: vec![Protocol::Native],
            groups: Group::ALL.to_vec(),
            floor: Floor::Zero,
            spacing_m: ScanOptions::default().spacing,
            series: false,
        }
    }
}

impl ScoreOptions {
    /// Whether Physique's own measures of a group are asked for.
    pub fn wants(&self, group: Group) -> bool {
        self.protocols.contains(&Protocol::Native) && self.groups.contains(&group)
    }

    /// Groups of ground, feet, balance and smoothness asked for.
    fn physics_groups(&self) -> Vec<Group> {
        let physics = Group::ALL.into_iter().skip(1);
        physics.filter(|&group| self.wants(group)).collect()
    }
}

/// Every measure of one motion; those not asked for are null.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MotionScore {
    /// Number of frames.
    pub frames: usize,
    /// Frames a second.
    pub frame_rate_fps: f64,
    /// Length in seconds.
    pub duration_s: f64,
    /// Height of the floor in the motion's world, in metres; null where nothing stands on it.
    pub floor_height_m: Option<f64>,
    /// How much the body passes through itself.
    pub self_intersection: Option<SelfIntersection>,
    /// Skin in the ground and above.
    pub ground: Option<GroundScore>,
    /// Feet that slide.
    pub feet: Option<FeetScore>,
    /// Whether the body could stand as it moves.
    pub balance: Option<BalanceScore>,
    /// How smoothly the joints move; null for clips of less than half a second or so, too.
    pub smoothness: Option<SmoothnessScore>,
    /// The published voxel metric.
    pub sia: Option<SiaScore>,
    /// The other published protocols.
    pub published: Vec<PublishedScore>,
    /// Measures of every frame.
    pub series: Option<Series>,
}

impl MotionScore {
    /// What is known of a motion before anything is measured.
    pub(crate) fn unmeasured(frames: usize, frame_rate: FrameRate) -> Self {
        Self {
            frames,
            frame_rate_fps: frame_rate.per_second(),
            duration_s: frames as f64 * frame_rate.frame_seconds(),
            floor_height_m: None,
            self_intersection: None,
            ground: None,
            feet: None,
            balance: None,
            smoothness: None,
            sia: None,
            published: Vec::new(),
            series: None,
        }
    }
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
    /// Where something stands on a floor.
    physics: Option<Physics>,
}

impl Scorer {
    /// Prepares the body's surface.
    ///
    /// # Errors
    /// [`Error::NothingToMeasure`] for options without protocol or group; [`Error::Geometry`] for a
    /// surface that is not closed or a spacing that is not a length.
    pub fn new(body: Body, options: ScoreOptions) -> Result<Self, Error> {
        let of_groups = options.protocols == [Protocol::Native] && options.groups.is_empty();
        if options.protocols.is_empty() || of_groups {
            return Err(Error::NothingToMeasure);
        }
        let surface = Surface::new(&body)?;
        let physics = match needs_floor(&options.protocols, &options.groups) {
            true => Some(Physics::new(&body)?),
            false => None,
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
    /// call, from any thread: of the slowest measure, so that it adds up to the motion's frames.
    ///
    /// # Errors
    /// As [`score`].
    pub fn score_with_progress(
        &self,
        motion: &Motion,
        progress: impl Fn(usize) + Sync,
    ) -> Result<MotionScore, Error> {
        if motion.frame_count() == 0 {
            return Err(Error::NoFrames);
        }
        let frame_s = motion.frame_rate().frame_seconds();
        let mut series = Series::new(motion.frame_count(), frame_s);
        let mut score = MotionScore::unmeasured(motion.frame_count(), motion.frame_rate());
        let scanned = self.options.wants(Group::SelfIntersection);
        let counted = self.options.protocols.contains(&Protocol::Sia);
        if scanned {
            let frames = self.self_intersections(motion, &progress)?;
            score.self_intersection = self.summary(&frames, frame_s);
            series.add_intersections(&frames);
        }
        if counted {
            let told = |frames| {
                if !scanned {
                    progress(frames);
                }
            };
            score.sia = Some(self.sia(motion, told)?);
        }
        if let Some(physics) = &self.physics {
            self.measure_on_floor(physics, motion, &mut score, &mut series)?;
        }
        if !scanned && !counted {
            progress(motion.frame_count());
        }
        score.series = self.options.series.then_some(series);
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

    fn summary(&self, frames: &[FrameIntersections], frame_s: f64) -> Option<SelfIntersection> {
        let spacing = f64::from(self.options.spacing_m);
        SelfIntersection::summarise(frames, frame_s, spacing, self.body.volume() * 1e6)
    }

    fn sia(&self, motion: &Motion, progress: impl Fn(usize) + Sync) -> Result<SiaScore, Error> {
        let frames = measure_frames(
            motion.frame_count(),
            || SiaMeter::new(&self.body, &self.surface.triangles),
            |meter, frame| meter.measure(motion, frame),
            progress,
        )?;
        SiaScore::summarise(&frames).ok_or(Error::NoFrames)
    }

    /// Ground, feet, balance, smoothness and the published protocols.
    fn measure_on_floor(
        &self,
        physics: &Physics,
        motion: &Motion,
        score: &mut MotionScore,
        series: &mut Series,
    ) -> Result<(), Error> {
        let height = self.options.floor.height(physics, motion)?;
        score.floor_height_m = Some(height);
        let on_floor = lowered(motion, height)?;
        let groups = self.options.physics_groups();
        if !groups.is_empty() {
            let found = physics.measure(&on_floor, &PhysicsOptions::default())?;
            for group in &groups {
                match group {
                    Group::SelfIntersection => {}
                    Group::Ground => score.ground = Some(GroundScore::of(&found)),
                    Group::Feet => score.feet = Some(FeetScore::of(&found)),
                    Group::Balance => score.balance = Some(BalanceScore::of(&found)),
                    Group::Smoothness => score.smoothness = SmoothnessScore::of(&found),
                }
            }
            series.add_physics(&found, &groups);
        }
        let published = self.options.protocols.par_iter().filter_map(|&protocol| {
            let Protocol::Published(published) = protocol else {
                return None;
            };
            let measures = measure_published(physics, &on_floor, published, MotionFloor::AsGiven);
            Some(measures.map(|measures| {
                PublishedScore {
                    protocol,
                    frame_rate_fps: protocol.frame_rate(),
                    measures: measures
                        .into_iter()
                        .map(|measure| (measure.name.to_owned(), measure.value))
                        .collect(),
                }
            }))
        });
        score.published = published.collect::<Result<_, _>>()?;
        Ok(())
    }

    fn meter(&self) -> Result<FrameMeter<'_>, Error> {
        let scan = ScanOptions {
            spacing: self.options.spacing_m,
            ..ScanOptions::default()
        };
        FrameMeter::new(&self.body, &self.surface, scan)
    }
}
