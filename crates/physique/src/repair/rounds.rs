//! Descent on the losses, measurement of the surface, and again.

use glam::DVec3;
use physique_body::Joint;
use physique_motion::Motion;
use physique_physics::loss::{MotionSlices, sole_contacts};

use super::change::{Source, UNKNOWNS};
use super::descent::minimise;
use super::objective::Objective;
use super::promise::{Worse, broken};
use super::stiffness::Stiffness;
use super::touch::Touches;
use super::{Repaired, Repairer};
use crate::series::SupportName;
use crate::{Error, MotionScore};

/// Frames with less than this are let be, in cm3: about what the scan's lines can tell.
const CLEAN_CM3: f64 = 1.0;
/// Self-intersection weighs so much more from round to round.
const HARDER: f64 = 2.0;
/// How much stiffer trunk and legs are. Arms get out of the way first: that leaves feet and balance
/// alone. Only what they cannot mend is left to the whole body.
const BEARING: [f64; 2] = [30.0, 1.0];
/// Faults of less than this are not visible: no second attempt.
const INVISIBLE: f64 = 0.3;
/// Rounds go on while they mend more than this part of the faults.
const WORTHWHILE: f64 = 0.02;
/// A descent ends when a step gains less than this part of the cost.
const GAIN: f64 = 1e-4;

/// The state of one repair.
pub(super) struct Rounds<'a> {
    repairer: &'a Repairer,
    source: Source,
    before: MotionScore,
    touches: Touches,
    grounded: Vec<f64>,
    contacts: Vec<f64>,
    /// `[frames]`, growing where the surface still intersects.
    self_weights: Vec<f32>,
}

/// A motion that a round reached.
struct Candidate {
    motion: Motion,
    change: Vec<f64>,
    score: MotionScore,
    faults: f64,
    worse: Vec<Worse>,
}

/// What has been reached so far.
struct Taken {
    best: Option<Candidate>,
    least: f64,
    held_back_by: Vec<Worse>,
    rounds: usize,
}

impl Taken {
    /// Takes a candidate that keeps the promise and mends more than all before; says whether
    /// another round is worth its while.
    fn offer(&mut self, candidate: Candidate) -> bool {
        if !candidate.worse.is_empty() {
            self.held_back_by = candidate.worse;
            return true;
        }
        let gained = self.least - candidate.faults;
        if gained <= 0.0 {
            return true;
        }
        let worthwhile = gained > WORTHWHILE * self.least;
        self.least = candidate.faults;
        self.held_back_by.clear();
        self.best = Some(candidate);
        worthwhile
    }
}

impl<'a> Rounds<'a> {
    pub(super) fn new(repairer: &'a Repairer, motion: &Motion) -> Result<Self, Error> {
        let source = Source::new(motion);
        let start = source.changed(&vec![0.0; source.unknowns()]);
        let slices = MotionSlices {
            frame_rate: motion.frame_rate(),
            rotations: &start.rotations,
            root: &start.root,
            betas: &[],
        };
        let before = repairer.scorer.score(motion)?;
        let support = before
            .series
            .as_ref()
            .and_then(|series| series.support.as_ref());
        let grounded = support.into_iter().flatten().map(|support| match support {
            SupportName::Flight => 0.0,
            SupportName::Ground | SupportName::Nothing => 1.0,
        });
        Ok(Self {
            touches: Touches::of(repairer.body(), &repairer.sphere_body, motion),
            grounded: grounded.collect(),
            before,
            contacts: sole_contacts(&repairer.loss_body, &slices, 0.0)?,
            self_weights: vec![0.0; motion.frame_count()],
            repairer,
            source,
        })
    }

    pub(super) fn run(
        mut self,
        mut progress: impl FnMut(usize, &MotionScore),
    ) -> Result<Repaired, Error> {
        let mut taken = Taken {
            best: None,
            least: self.faults(&self.before),
            held_back_by: Vec::new(),
            rounds: 0,
        };
        for bearing in BEARING {
            self.self_weights.fill(0.0);
            weigh_frames(&self.before, &mut self.self_weights);
            self.attempt(bearing, &mut taken, &mut progress)?;
            if taken.least < INVISIBLE {
                break;
            }
        }
        Ok(self.outcome(taken))
    }

    /// Round after round, each with faults that weigh more, until little is gained.
    fn attempt(
        &mut self,
        bearing: f64,
        taken: &mut Taken,
        progress: &mut impl FnMut(usize, &MotionScore),
    ) -> Result<(), Error> {
        let options = self.repairer.options;
        let targets = options.targets;
        let rate = self.source.motion().frame_rate();
        let stiffness = Stiffness::new(self.source.frame_count(), rate, bearing);
        let mut change = vec![0.0; self.source.unknowns()];
        let mut self_strength = options.strength;
        for _ in 0..options.rounds {
            if taken.least <= 0.0 {
                break;
            }
            let objective = Objective {
                source: &self.source,
                stiffness: &stiffness,
                body: &self.repairer.loss_body,
                spheres: &self.repairer.spheres,
                touches: &self.touches,
                self_weights: targets.self_intersection.then(|| self.self_weights.clone()),
                grounded: targets.ground.then(|| self.grounded.clone()),
                contacts: targets.feet.then(|| self.contacts.clone()),
                self_strength,
                strength: self_strength,
            };
            minimise(&objective, &mut change, options.steps, GAIN);
            let candidate = self.candidate(&change)?;
            taken.rounds += 1;
            progress(taken.rounds, &candidate.score);
            weigh_frames(&candidate.score, &mut self.self_weights);
            self_strength *= HARDER;
            if !taken.offer(candidate) {
                break;
            }
        }
        Ok(())
    }

    fn candidate(&self, change: &[f64]) -> Result<Candidate, Error> {
        let motion = self.source.motion_of(change)?;
        let score = self.repairer.scorer.score(&motion)?;
        Ok(Candidate {
            faults: self.faults(&score),
            worse: broken(&self.before, &score),
            change: change.to_vec(),
            motion,
            score,
        })
    }

    /// What is left of the targeted faults, each in units of what is hardly visible.
    fn faults(&self, score: &MotionScore) -> f64 {
        let targets = self.repairer.options.targets;
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

    fn outcome(self, taken: Taken) -> Repaired {
        let best = taken.best;
        let turns = best.as_ref().map_or_else(Default::default, Turns::of);
        let changed = best.is_some();
        let (motion, mut after) = match best {
            Some(best) => (best.motion, best.score),
            None => (self.source.motion().clone(), self.before.clone()),
        };
        let mut before = self.before;
        (before.series, after.series) = (None, None);
        Repaired {
            motion,
            after,
            before,
            changed,
            held_back_by: taken.held_back_by,
            rounds: taken.rounds,
            touching_frames: self.touches.frames(),
            mean_turn_degrees: turns.mean.to_degrees(),
            greatest_turn_degrees: turns.greatest.to_degrees(),
            mean_displacement_cm: 100.0 * turns.displacement,
        }
    }
}

/// Frames whose surface intersects weigh more, others what they did.
fn weigh_frames(score: &MotionScore, weights: &mut [f32]) {
    let series = score.series.as_ref();
    let volumes = series.and_then(|series| series.self_intersection_cm3.as_ref());
    for (weight, &volume) in weights.iter_mut().zip(volumes.into_iter().flatten()) {
        if volume > CLEAN_CM3 {
            *weight = (*weight * 2.0).max(1.0);
        }
    }
}

/// Size of a change, in radians and metres.
#[derive(Default)]
struct Turns {
    mean: f64,
    greatest: f64,
    displacement: f64,
}

impl Turns {
    fn of(candidate: &Candidate) -> Self {
        let frames = candidate.change.chunks_exact(UNKNOWNS);
        let count = frames.len().max(1) as f64;
        let mut turns = Self::default();
        for frame in frames {
            let (joints, root) = frame.split_at(3 * Joint::COUNT);
            for joint in joints.chunks_exact(3) {
                let angle = DVec3::from_slice(joint).length();
                turns.mean += angle / (count * Joint::COUNT as f64);
                turns.greatest = turns.greatest.max(angle);
            }
            turns.displacement += DVec3::from_slice(root).length() / count;
        }
        turns
    }
}
