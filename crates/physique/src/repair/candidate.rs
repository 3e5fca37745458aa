//! Changes, applied and measured.

use physique_motion::Motion;

use super::change::Source;
use super::grid::Grid;
use super::promise::{Worse, broken};
use super::{Repairer, Targets};
use crate::{Error, MotionScore};

/// A motion that a change leads to.
pub(super) struct Candidate {
    pub(super) motion: Motion,
    /// By knots.
    pub(super) change: Vec<f64>,
    pub(super) score: MotionScore,
    /// What is left to repair.
    pub(super) faults: f64,
    /// Where the promise is broken.
    pub(super) worse: Vec<Worse>,
}

/// Applies changes to a motion, all frames of it or the knots, and measures what comes of it.
pub(super) struct Meter<'a> {
    repairer: &'a Repairer,
    pub(super) source: Source,
    /// Where all frames are to be changed.
    grid: Option<Grid>,
    /// The source, measured.
    pub(super) before: MotionScore,
}

impl<'a> Meter<'a> {
    /// Measures the source.
    pub(super) fn new(
        repairer: &'a Repairer,
        motion: &Motion,
        grid: Option<Grid>,
    ) -> Result<Self, Error> {
        Ok(Self {
            before: repairer.scorer.score(motion)?,
            source: Source::new(motion),
            repairer,
            grid,
        })
    }

    /// Applies a change of the knots, and measures.
    pub(super) fn measure(&self, change: Vec<f64>) -> Result<Candidate, Error> {
        let motion = match self.grid {
            Some(grid) => self.source.motion_of(&grid.at_frames(&change))?,
            None => self.source.motion_of(&change)?,
        };
        let score = self.repairer.scorer.score(&motion)?;
        Ok(Candidate {
            faults: faults(&score, self.repairer.options.targets),
            worse: broken(&self.before, &score),
            change,
            motion,
            score,
        })
    }
}

/// What is left of the targeted faults, each in units of what is hardly visible.
pub(super) fn faults(score: &MotionScore, targets: Targets) -> f64 {
    let mut faults = 0.0;
    if targets.self_intersection
        && let Some(found) = &score.self_intersection
    {
        faults += found.mean_cm3 / 5.0;
    }
    if targets.ground
        && let Some(found) = &score.ground
    {
        faults += found.penetration_mean_cm / 0.3;
        faults += found.floating_mean_cm / 0.3;
    }
    if targets.feet
        && let Some(found) = &score.feet
    {
        faults += found.slide_mean_cm_s / 2.0;
    }
    faults
}
