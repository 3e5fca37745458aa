//! Descent on the losses, measurement of the surface, and again.

use glam::DVec3;
use physique_body::Joint;
use physique_motion::Motion;

use super::balance::Balance;
use super::blend::Blend;
use super::candidate::{Candidate, Meter, faults};
use super::change::UNKNOWNS;
use super::descent::minimise;
use super::feet::Feet;
use super::figure::Pose;
use super::grid::Grid;
use super::ground::Ground;
use super::guards::Guards;
use super::objective::Objective;
use super::preconditioner::Preconditioner;
use super::promise::Worse;
use super::stiffness::Stiffness;
use super::taken::{INVISIBLE, Taken};
use super::touch::Touches;
use super::{Change, Outcome, Repaired, Repairer};
use crate::series::{Series, SupportName};
use crate::{Error, MotionScore};

/// Frames with less than this are let be, in cm3: about what the scan's lines can tell.
const CLEAN_CM3: f64 = 1.0;
/// Neighbours of frames that intersect must not begin to, in seconds.
const AROUND_S: f64 = 0.25;
/// How much stiffer trunk and legs are. Arms get out of the way first: that leaves feet and balance
/// alone. Only what they cannot mend is left to the whole body.
const BEARING: [f64; 2] = [30.0, 1.0];
/// A descent ends when a step gains less than this part of the cost.
const GAIN: f64 = 3e-4;
/// Most blends that are tried.
const BLENDS: usize = 8;

/// The state of one repair.
pub(super) struct Rounds<'a> {
    repairer: &'a Repairer,
    /// All frames; none where all frames are knots.
    whole: Option<Meter<'a>>,
    /// The knots, where the change is sought.
    knots: Meter<'a>,
    stride: usize,
    poses: Vec<Pose>,
    touches: Touches,
    feet: Feet,
    balance: Balance,
    ground: Option<Ground>,
    /// `[knots]`, growing where the surface still intersects.
    self_weights: Vec<f32>,
}

impl<'a> Rounds<'a> {
    pub(super) fn new(repairer: &'a Repairer, motion: &Motion) -> Result<Self, Error> {
        let targets = repairer.options.targets;
        let grid = Grid::new(motion.frame_count(), motion.frame_rate());
        let knots = Meter::new(repairer, &grid.at_knots(motion)?, None)?;
        let whole = match grid.stride() {
            1 => None,
            _ => Some(Meter::new(repairer, motion, Some(grid))?),
        };
        let source = &knots.source;
        let frame_s = source.motion().frame_rate().frame_seconds();
        let figure = &repairer.figure;
        let poses = source.poses(figure, &vec![0.0; source.unknowns()]);
        let series = knots.before.series.clone().unwrap_or_default();
        let support = series.support.unwrap_or_default();
        let grounded = support.iter().map(|name| *name != SupportName::Flight);
        let distances = series.zero_moment_distance_cm.unwrap_or_default();
        let distances: Vec<_> = distances.iter().map(|cm| Some((*cm)? / 100.0)).collect();
        let feet = Feet::of(&poses, frame_s, targets.feet);
        Ok(Self {
            touches: Touches::of(&repairer.sphere_body, &poses, frame_s),
            balance: Balance::of(&poses, frame_s, &feet, &distances),
            ground: targets
                .ground
                .then(|| Ground::of(figure, &poses, grounded.collect())),
            feet,
            self_weights: vec![0.0; source.frame_count()],
            stride: grid.stride(),
            knots,
            whole,
            poses,
            repairer,
        })
    }

    pub(super) fn run(
        mut self,
        mut progress: impl FnMut(usize, &MotionScore),
    ) -> Result<Repaired, Error> {
        let targets = self.repairer.options.targets;
        let mut taken = Taken::nothing(faults(&self.knots.before, targets));
        let progress = &mut progress;
        for bearing in BEARING {
            if taken.least < INVISIBLE {
                break;
            }
            self.self_weights.fill(0.0);
            self.weigh_frames(&self.knots.before.clone());
            self.attempt(bearing, &mut taken, progress)?;
        }
        let mut held_back_by = Vec::new();
        if let Some(broken) = taken.better_but_broken() {
            held_back_by.clone_from(&broken.worse);
            self.blend(&self.knots, &broken, &mut taken, progress)?;
        }
        // What keeps the promise at the knots may break it between them.
        if let Some(whole) = &self.whole
            && let Some(best) = taken.best.take()
        {
            let best = whole.measure(best.change)?;
            taken.least = faults(&whole.before, targets);
            if best.worse.is_empty() {
                taken.offer(best);
            } else {
                let known = |worse: &Worse| {
                    let mut others = held_back_by.iter();
                    others.any(|other: &Worse| other.measure == worse.measure)
                };
                let more = best.worse.iter().filter(|worse| !known(worse));
                held_back_by.extend(more.cloned().collect::<Vec<_>>());
                self.blend(whole, &best, &mut taken, progress)?;
            }
        }
        Ok(self.outcome(taken, held_back_by))
    }

    /// Round after round until little is gained: what still intersects weighs more, and so does
    /// what broke the promise.
    fn attempt(
        &mut self,
        bearing: f64,
        taken: &mut Taken,
        progress: &mut impl FnMut(usize, &MotionScore),
    ) -> Result<(), Error> {
        let options = self.repairer.options;
        let rate = self.knots.source.motion().frame_rate();
        let mut guards = Guards::new(options);
        let mut change = taken.change(self.knots.source.unknowns());
        for _ in 0..options.rounds {
            let source = &self.knots.source;
            let frames = source.frame_count();
            let stiffness = Stiffness::new(frames, rate, bearing, guards.smooth);
            let keep = (&self.feet, &self.balance);
            let figure = &self.repairer.figure;
            let weights = guards.weights();
            let objective = Objective {
                source,
                figure,
                preconditioner: &Preconditioner::new(
                    figure,
                    &self.poses,
                    &stiffness,
                    keep,
                    weights,
                ),
                stiffness: &stiffness,
                spheres: &self.repairer.spheres,
                touches: &self.touches,
                feet: &self.feet,
                balance: &self.balance,
                ground: self.ground.as_ref(),
                self_weights: &self.self_weights,
                weights,
            };
            minimise(&objective, &mut change, options.steps, GAIN);
            let candidate = self.knots.measure(change.clone())?;
            taken.rounds += 1;
            progress(taken.rounds, &candidate.score);
            self.weigh_frames(&candidate.score);
            guards.learn(&candidate.worse);
            if !taken.offer(candidate) || taken.least < INVISIBLE {
                break;
            }
        }
        Ok(())
    }

    /// Goes back from a broken promise, window by window, until it holds.
    fn blend(
        &self,
        meter: &Meter<'_>,
        broken: &Candidate,
        taken: &mut Taken,
        progress: &mut impl FnMut(usize, &MotionScore),
    ) -> Result<(), Error> {
        let knots = self.knots.source.motion();
        let base = taken.change(broken.change.len());
        let mut blend = Blend::new(knots.seconds());
        let mut worse = broken.worse.clone();
        let mut after = broken.score.series.clone();
        for _ in 0..BLENDS {
            let last = blend.clone();
            if let (Some(before), Some(after)) = (&meter.before.series, &after) {
                blend.give_way(before, after, &worse);
            }
            if blend == last {
                blend.give_way_everywhere();
            }
            if blend.is_empty() {
                break;
            }
            let knot_s = knots.frame_rate().frame_seconds();
            let candidate = meter.measure(blend.between(&base, &broken.change, knot_s))?;
            taken.rounds += 1;
            progress(taken.rounds, &candidate.score);
            if candidate.worse.is_empty() {
                taken.offer(candidate);
                break;
            }
            worse = candidate.worse;
            after = candidate.score.series;
        }
        Ok(())
    }

    /// Knots whose surface intersects weigh more, their neighbours at least something.
    fn weigh_frames(&mut self, score: &MotionScore) {
        if !self.repairer.options.targets.self_intersection {
            return;
        }
        let volumes = score.series.as_ref().map(Series::self_intersections);
        let volumes = volumes.unwrap_or_default();
        let rate = self.knots.source.motion().frame_rate();
        let around = (AROUND_S * rate.per_second()).ceil() as usize;
        for (knot, &volume) in volumes.iter().enumerate() {
            if volume <= CLEAN_CM3 {
                continue;
            }
            self.self_weights[knot] = (self.self_weights[knot] * 2.0).max(1.0);
            let last = (knot + around + 1).min(volumes.len());
            for weight in &mut self.self_weights[knot.saturating_sub(around)..last] {
                *weight = weight.max(1.0);
            }
        }
    }

    fn outcome(self, taken: Taken, held_back_by: Vec<Worse>) -> Repaired {
        let best = taken.best;
        let outcome = match (best.is_some(), held_back_by.is_empty()) {
            (true, true) => Outcome::Repaired,
            (true, false) => Outcome::RepairedInPart,
            (false, true) => Outcome::Sound,
            (false, false) => Outcome::HeldBack,
        };
        let change = Change {
            touching_frames: self.touches.frames() * self.stride,
            rounds: taken.rounds,
            ..best.as_ref().map_or_else(Change::default, size_of)
        };
        let source = self.whole.unwrap_or(self.knots);
        let (motion, mut after) = match best {
            Some(best) => (best.motion, best.score),
            None => (source.source.motion().clone(), source.before.clone()),
        };
        let mut before = source.before;
        (before.series, after.series) = (None, None);
        Repaired {
            motion,
            before,
            after,
            outcome,
            change,
            held_back_by,
        }
    }
}

/// How large the change of a candidate is.
fn size_of(candidate: &Candidate) -> Change {
    let frames = candidate.change.chunks_exact(UNKNOWNS);
    let count = frames.len().max(1) as f64;
    let mut size = Change::default();
    for frame in frames {
        let (joints, root) = frame.split_at(3 * Joint::COUNT);
        for joint in joints.chunks_exact(3) {
            let angle = DVec3::from_slice(joint).length().to_degrees();
            size.mean_turn_degrees += angle / (count * Joint::COUNT as f64);
            size.greatest_turn_degrees = size.greatest_turn_degrees.max(angle);
        }
        size.mean_displacement_cm += 100.0 * DVec3::from_slice(root).length() / count;
        if frame.iter().any(|unknown| *unknown != 0.0) {
            size.frames_percent += 100.0 / count;
        }
    }
    size
}
