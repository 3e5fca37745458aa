//! The smallest change of a motion that a body could really perform.
//!
//! All rotations and the root path are free. Their change costs by its size, its speed and its
//! acceleration; against that stand the self-intersection loss of the sphere proxy and the losses of
//! ground and feet. A preconditioned quasi-Newton descent over the whole clip finds the balance,
//! then the real surface is measured, and frames that still intersect weigh more in the next round.
//!
//! Hands that touch the body on purpose keep touching. And a promise is kept: no measure of `score`
//! gets worse beyond [`PROMISE`]; a repair that would break it is made gentler, or not made.

mod balance;
mod banded;
mod blend;
mod candidate;
mod change;
mod descent;
mod feet;
mod figure;
mod grid;
mod ground;
mod guards;
mod objective;
mod preconditioner;
mod promise;
pub mod report;
mod rounds;
mod stiffness;
mod taken;
mod touch;
mod wrench;

pub use promise::{PROMISE, Tolerance, Worse};
pub use report::{Change, Outcome, RepairHead, RepairReport, RepairedMotion};

use physique_body::Body;
use physique_motion::Motion;
use physique_proxy::{Pairs, SelfIntersection, SphereBody};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Error, MotionScore, ScoreOptions, Scorer};
use figure::Figure;
use rounds::Rounds;

/// What is to be repaired.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Targets {
    /// Parts of the body inside others.
    pub self_intersection: bool,
    /// Skin in the ground, and bodies that float above it.
    pub ground: bool,
    /// Feet that slide where they stand.
    pub feet: bool,
}

impl Targets {
    /// Everything.
    pub const ALL: Self = Self {
        self_intersection: true,
        ground: true,
        feet: true,
    };
}

/// How to repair.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RepairOptions {
    /// What is to be repaired.
    pub targets: Targets,
    /// How much faults weigh against changes: 1 by default, more for thorough repairs.
    pub strength: f64,
    /// Most rounds of descent and measurement.
    pub rounds: usize,
    /// Most steps of descent a round.
    pub steps: usize,
}

impl Default for RepairOptions {
    fn default() -> Self {
        Self {
            targets: Targets::ALL,
            strength: 1.0,
            rounds: 7,
            steps: 40,
        }
    }
}

/// A repaired motion and what the repair did.
#[derive(Clone, Debug, PartialEq)]
pub struct Repaired {
    /// The repaired motion; the source where nothing could be gained.
    pub motion: Motion,
    /// Measures of the source.
    pub before: MotionScore,
    /// Measures of the repaired motion.
    pub after: MotionScore,
    /// How it ended.
    pub outcome: Outcome,
    /// How much was changed.
    pub change: Change,
    /// What kept repairs that went further from being taken: their measures that got worse.
    pub held_back_by: Vec<Worse>,
}

/// Repairs motions of one body: what they share is prepared once.
pub struct Repairer {
    scorer: Scorer,
    figure: Figure,
    sphere_body: SphereBody,
    spheres: SelfIntersection,
    options: RepairOptions,
}

impl Repairer {
    /// Prepares a body and its spheres, in metres.
    ///
    /// # Errors
    /// As [`Scorer::new`]; [`Error::Proxy`] for spheres that do not fit each other;
    /// [`Error::Strength`] unless the strength is a positive number.
    pub fn new(
        body: Body,
        spheres: SphereBody,
        pairs: &Pairs,
        options: RepairOptions,
    ) -> Result<Self, Error> {
        if !(options.strength.is_finite() && options.strength > 0.0) {
            return Err(Error::Strength {
                found: options.strength,
            });
        }
        Ok(Self {
            figure: Figure::new(&body)?,
            scorer: Scorer::new(
                body,
                ScoreOptions {
                    series: true,
                    ..ScoreOptions::default()
                },
            )?,
            spheres: SelfIntersection::new(&spheres, pairs)?,
            sphere_body: spheres,
            options,
        })
    }

    /// The body that motions are repaired for.
    pub const fn body(&self) -> &Body {
        self.scorer.body()
    }

    /// Repairs a motion; the result does not depend on the number of threads.
    ///
    /// # Errors
    /// As [`Scorer::score`].
    pub fn repair(&self, motion: &Motion) -> Result<Repaired, Error> {
        self.repair_with_progress(motion, |_, _| ())
    }

    /// As [`Repairer::repair`]; `progress` is called with the number of rounds done and the
    /// measures reached.
    ///
    /// # Errors
    /// As [`Repairer::repair`].
    pub fn repair_with_progress(
        &self,
        motion: &Motion,
        progress: impl FnMut(usize, &MotionScore),
    ) -> Result<Repaired, Error> {
        Rounds::new(self, motion)?.run(progress)
    }
}
