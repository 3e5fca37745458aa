//! What weighs how much, learnt from what went wrong.

use super::RepairOptions;
use super::objective::Weights;
use super::promise::Worse;

/// Faults weigh so much more after a round that kept the promise.
const HARDER: f64 = 2.0;
/// What a measure is guarded by weighs so much more after a round that made it worse.
const GUARD: f64 = 3.0;
/// Changes get so much slower after a round that made the motion less smooth.
const SLOWER: f64 = 1.4;

/// Weights of the coming round.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guards {
    spheres: f64,
    ground: f64,
    feet: f64,
    balance: f64,
    /// How much slower than usual changes are.
    pub(super) smooth: f64,
    grounded: bool,
}

impl Guards {
    pub(super) fn new(options: RepairOptions) -> Self {
        Self {
            spheres: options.strength,
            ground: options.strength,
            feet: options.strength,
            balance: 1.0,
            smooth: 1.0,
            grounded: options.targets.ground,
        }
    }

    pub(super) const fn weights(&self) -> Weights {
        Weights {
            spheres: self.spheres,
            ground: self.ground,
            feet: self.feet,
            balance: self.balance,
        }
    }

    /// After a round: guards what got worse; if nothing did, goes on harder.
    pub(super) fn learn(&mut self, worse: &[Worse]) {
        if worse.is_empty() {
            self.spheres *= HARDER;
            self.ground *= HARDER;
            self.feet *= HARDER;
            return;
        }
        let group = |name: &str| worse.iter().any(|worse| worse.measure.starts_with(name));
        if group("self_intersection") {
            self.spheres *= GUARD;
        }
        if group("ground") && self.grounded {
            self.ground *= GUARD;
        }
        if group("feet") {
            // Soles that come down to the ground are seen to slide.
            self.ground /= HARDER;
        }
        if group("feet") || (group("ground") && !self.grounded) {
            self.feet *= GUARD;
        }
        if group("balance") {
            self.balance *= GUARD;
        }
        if group("smoothness") {
            self.smooth *= SLOWER;
        }
    }
}
