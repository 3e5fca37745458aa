//! How to train.

use serde::{Deserialize, Serialize};

use super::AdamWConfig;
use crate::Error;

/// How a run goes, whatever it trains. The default is MDM's as published.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrainerConfig {
    /// Steps of the optimiser.
    pub steps: u64,
    /// What all random numbers depend on.
    pub seed: u64,
    /// The optimiser's settings.
    pub optimiser: AdamWConfig,
    /// How the learning rate changes over the run.
    pub rate: RateSchedule,
    /// Largest norm of the whole gradient; a longer one is shortened to it.
    pub clip: Option<f64>,
    /// Decay of the running average of parameters, which sampling uses; `None`: no average. It
    /// follows from the first step, faster at the beginning: (1 + step) / (10 + step) at most.
    pub average: Option<f64>,
    /// Steps from one checkpoint to the next.
    pub save_every: u64,
    /// Checkpoints that are kept, the newest ones; `None`: all.
    pub keep: Option<usize>,
    /// Steps from one line of the log to the next.
    pub log_every: u64,
}

/// How the learning rate changes over a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RateSchedule {
    /// It does not.
    #[default]
    Constant,
    /// It grows evenly in the first steps, then falls along a cosine to a share of itself.
    WarmUpThenCosine {
        /// Steps of growth.
        warm_up: u64,
        /// Share at the end.
        final_share: f64,
    },
}

impl RateSchedule {
    /// Factor of the learning rate in a step of `steps`.
    pub fn factor(&self, step: u64, steps: u64) -> f64 {
        match *self {
            Self::Constant => 1.0,
            Self::WarmUpThenCosine {
                warm_up,
                final_share,
            } => {
                let growth = ((step + 1) as f64 / warm_up.max(1) as f64).min(1.0);
                let progress = (step as f64 / steps.max(1) as f64).min(1.0);
                let cosine = 0.5 * (1.0 + (std::f64::consts::PI * progress).cos());
                growth * (final_share + (1.0 - final_share) * cosine)
            }
        }
    }
}

impl Default for TrainerConfig {
    fn default() -> Self {
        Self {
            steps: 600_000,
            seed: 10,
            optimiser: AdamWConfig::default(),
            rate: RateSchedule::Constant,
            clip: None,
            average: None,
            save_every: 50_000,
            keep: None,
            log_every: 1000,
        }
    }
}

impl TrainerConfig {
    /// Whether one can train so.
    ///
    /// # Errors
    /// [`Error::Setting`] with the first setting that cannot be.
    pub fn check(&self) -> Result<(), Error> {
        let counts = [
            ("steps", self.steps),
            ("save_every", self.save_every),
            ("log_every", self.log_every),
        ];
        for (what, found) in counts {
            if found == 0 {
                return Err(Error::setting(what, "1 or more", found));
            }
        }
        if let Some(found) = self.average.filter(|share| !(0.0..1.0).contains(share)) {
            return Err(Error::setting("average", "at least 0 and below 1", found));
        }
        if let Some(found) = self.clip.filter(|norm| !(norm.is_finite() && *norm > 0.0)) {
            return Err(Error::setting("clip", "a finite number above 0", found));
        }
        self.optimiser.check()
    }
}
