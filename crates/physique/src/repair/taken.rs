//! What a repair has reached: the best that keeps the promise, and the best that does not.

use super::candidate::Candidate;
use super::promise::Worse;

/// Faults of less than this are not visible: nothing is changed for them.
pub(super) const INVISIBLE: f64 = 0.3;
/// Rounds go on while they mend more than this part of the faults.
const WORTHWHILE: f64 = 0.02;
/// A repair that breaks the promise is blended back where it mends this part of what is left.
const BLENDED: f64 = 0.1;

/// What has been reached so far.
pub(super) struct Taken {
    pub(super) best: Option<Candidate>,
    /// Faults that it leaves.
    pub(super) least: f64,
    /// What mends most and breaks least, of all that break the promise.
    broken: Option<Candidate>,
    pub(super) rounds: usize,
}

impl Taken {
    /// The source, with its faults.
    pub(super) const fn nothing(faults: f64) -> Self {
        Self {
            best: None,
            least: faults,
            broken: None,
            rounds: 0,
        }
    }

    /// The change of the best, or none, of so many unknowns.
    pub(super) fn change(&self, unknowns: usize) -> Vec<f64> {
        let best = self.best.as_ref();
        best.map_or_else(|| vec![0.0; unknowns], |best| best.change.clone())
    }

    /// Takes a candidate that keeps the promise and mends more than all before; says whether
    /// another round is worth its while.
    pub(super) fn offer(&mut self, candidate: Candidate) -> bool {
        if !candidate.worse.is_empty() {
            let least = self.broken.as_ref().map_or(f64::MAX, price);
            if price(&candidate) < least {
                self.broken = Some(candidate);
            }
            return true;
        }
        let gained = self.least - candidate.faults;
        if gained <= 0.0 {
            return true;
        }
        let worthwhile = gained > WORTHWHILE * self.least;
        self.least = candidate.faults;
        self.best = Some(candidate);
        worthwhile
    }

    /// What breaks the promise, and mends so much more that it matters.
    pub(super) fn better_but_broken(&mut self) -> Option<Candidate> {
        let most = ((1.0 - BLENDED) * self.least).min(self.least - INVISIBLE);
        self.broken.take_if(|broken| broken.faults < most)
    }
}

/// Faults that are left, and more for a broken promise.
fn price(broken: &Candidate) -> f64 {
    let violation: f64 = broken.worse.iter().map(Worse::violation).sum();
    broken.faults * (1.0 + violation)
}
