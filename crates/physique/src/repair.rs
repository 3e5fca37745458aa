//! The smallest change of a motion that a body could really perform.
//!
//! All rotations and the root path are free. Their change costs by its size, its speed and its
//! acceleration; against that stand the self-intersection loss of the sphere proxy and the losses of
//! ground and feet. A preconditioned quasi-Newton descent over the whole clip finds the balance,
//! then the real surface is measured, and frames that still intersect weigh more in the next round.
//!
//! Hands that touch the body on purpose keep touching. And a promise is kept: no measure of `score`
//! gets worse beyond [`PROMISE`]; a repair that would break it is made gentler, or not made.

mod change;
mod descent;
mod objective;
mod promise;
mod rounds;
mod stiffness;
mod touch;

pub use promise::{PROMISE, Tolerance, Worse};

use physique_body::Body;
use physique_motion::Motion;
use physique_physics::loss::LossBody;
use physique_proxy::{Pairs, SelfIntersection, SphereBody};

use crate::{Error, MotionScore, ScoreOptions, Scorer};
use rounds::Rounds;

/// Points of skin that the ground is compared with, besides the soles'.
const SKIN_POINTS: usize = 500;

/// What is to be repaired.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
#[derive(Clone, Copy, Debug, PartialEq)]
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
            rounds: 5,
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
    /// Whether the motion was changed.
    pub changed: bool,
    /// What kept repairs that went further from being taken: their measures that got worse.
    pub held_back_by: Vec<Worse>,
    /// Rounds of descent and measurement.
    pub rounds: usize,
    /// Frames in which a hand touches the body on purpose, as far as can be seen.
    pub touching_frames: usize,
    /// Mean turn of a joint, in degrees.
    pub mean_turn_degrees: f64,
    /// Greatest turn of a joint, in degrees.
    pub greatest_turn_degrees: f64,
    /// Mean displacement of the root, in centimetres.
    pub mean_displacement_cm: f64,
}

/// Repairs motions of one body: what they share is prepared once.
pub struct Repairer {
    scorer: Scorer,
    loss_body: LossBody,
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
            loss_body: LossBody::new(&body, SKIN_POINTS)?,
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
