//! How much noise each step holds, in 64 bits.

use std::f64::consts::FRAC_PI_2;

use crate::Error;

/// No step takes away more than this share of the variance.
const LARGEST_BETA: f64 = 0.999;

/// Steps of noise: `step` 0 is nearly clean, the last one is nearly all noise.
///
/// With beta the share of noise that a step adds and alpha-bar the product of all 1 - beta up to
/// it, x_t = sqrt(alpha-bar) x_0 + sqrt(1 - alpha-bar) noise. Ho et al., "Denoising Diffusion
/// Probabilistic Models", 2020, equations 4 and 7.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    betas: Vec<f64>,
    /// Alpha-bar of every step.
    kept: Vec<f64>,
    /// What a network calls the step: differs from its index when steps are left out.
    network_steps: Vec<usize>,
}

/// The distribution of x_(t-1) where x_t and x_0 are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posterior {
    /// Factor of x_0 in the mean.
    pub from_clean: f64,
    /// Factor of x_t in the mean.
    pub from_noisy: f64,
    /// Variance.
    pub variance: f64,
    /// Its logarithm; that of step 0, which has no variance, is the next step's.
    pub log_variance: f64,
}

impl Schedule {
    /// The cosine schedule of Nichol and Dhariwal, "Improved Denoising Diffusion Probabilistic
    /// Models", 2021, equation 17. Published MDM models have 1,000, 50 or 10 steps.
    ///
    /// # Errors
    /// [`Error::Setting`] unless there are 1 to 100,000 steps.
    pub fn cosine(steps: usize) -> Result<Self, Error> {
        if !(1..=100_000).contains(&steps) {
            let expected = "1 to 100,000 diffusion steps";
            return Err(Error::setting("diffusion_steps", expected, steps));
        }
        let signal = |share: f64| ((share + 0.008) / 1.008 * FRAC_PI_2).cos().powi(2);
        let share = |step: usize| step as f64 / steps as f64;
        let betas = (0..steps)
            .map(|step| (1.0 - signal(share(step + 1)) / signal(share(step))).min(LARGEST_BETA));
        Ok(Self::from_betas(betas.collect(), (0..steps).collect()))
    }

    /// The same steps with another share of noise: the ratio of the signal's variance to the
    /// noise's is multiplied by `factor`. Below 1 the decisions, which motion's features leave to
    /// the noisiest steps, are spread over more of them.
    ///
    /// # Errors
    /// [`Error::Setting`] unless the factor is finite and above 0.
    pub fn with_signal(&self, factor: f64) -> Result<Self, Error> {
        if !(factor.is_finite() && factor > 0.0) {
            let expected = "a finite number above 0";
            return Err(Error::setting("signal", expected, factor));
        }
        let kept = self.kept.iter().map(|kept| {
            let ratio = factor * kept / (1.0 - kept);
            ratio / (1.0 + ratio)
        });
        Ok(Self::from_kept(kept.collect(), self.network_steps.clone()))
    }

    /// With alpha-bar as given, to the bit.
    fn from_kept(kept: Vec<f64>, network_steps: Vec<usize>) -> Self {
        let before = std::iter::once(&1.0).chain(&kept);
        let betas = kept
            .iter()
            .zip(before)
            .map(|(kept, before)| 1.0 - kept / before);
        Self {
            betas: betas.collect(),
            kept,
            network_steps,
        }
    }

    fn from_betas(betas: Vec<f64>, network_steps: Vec<usize>) -> Self {
        let products = betas.iter().scan(1.0, |product, beta| {
            *product *= 1.0 - beta;
            Some(*product)
        });
        Self {
            kept: products.collect(),
            betas,
            network_steps,
        }
    }

    /// A faster schedule for the same network: only `steps` of the steps, spread evenly from the
    /// first to the last, with the noise that the steps between them would have added.
    ///
    /// # Errors
    /// [`Error::Setting`] unless there are 2 steps or more, and no more than now.
    pub fn respaced(&self, steps: usize) -> Result<Self, Error> {
        if !(2..=self.len()).contains(&steps) {
            let expected = format!("2 to {} of the network's steps", self.len());
            return Err(Error::setting("sampling_steps", expected, steps));
        }
        let stride = (self.len() - 1) as f64 / (steps - 1) as f64;
        // Python's rounding, as published: halves go to the even neighbour.
        let step = |index: usize| (index as f64 * stride).round_ties_even() as usize;
        Ok(self.with_steps((0..steps).map(step)))
    }

    /// The spacing that DDIM was published with: every k-th step from the first, for a whole k
    /// that gives exactly `steps`.
    ///
    /// # Errors
    /// [`Error::Setting`] where there is no such k.
    pub fn respaced_for_ddim(&self, steps: usize) -> Result<Self, Error> {
        let strides = 1..=self.len();
        let stride = strides
            .into_iter()
            .find(|&stride| self.len().div_ceil(stride) == steps);
        match stride {
            Some(stride) => Ok(self.with_steps((0..self.len()).step_by(stride))),
            None => {
                let expected = format!("a whole stride through {} steps", self.len());
                Err(Error::setting("sampling_steps", expected, steps))
            }
        }
    }

    fn with_steps(&self, steps: impl Iterator<Item = usize>) -> Self {
        let steps: Vec<usize> = steps.collect();
        let kept = steps.iter().map(|&step| self.kept[step]);
        let network_steps = steps.iter().map(|&step| self.network_steps[step]);
        Self::from_kept(kept.collect(), network_steps.collect())
    }

    /// Number of steps.
    pub const fn len(&self) -> usize {
        self.betas.len()
    }

    /// Never: a schedule has a step.
    pub const fn is_empty(&self) -> bool {
        self.betas.is_empty()
    }

    /// Share of noise that every step adds.
    pub fn betas(&self) -> &[f64] {
        &self.betas
    }

    /// Alpha-bar: share of the clean signal's variance that is left in every step.
    pub fn kept(&self) -> &[f64] {
        &self.kept
    }

    /// Alpha-bar of the step before; 1 before the first.
    pub fn kept_before(&self, step: usize) -> f64 {
        step.checked_sub(1).map_or(1.0, |before| self.kept[before])
    }

    /// What a network calls a step.
    ///
    /// # Panics
    /// When there is no such step.
    pub fn network_step(&self, step: usize) -> usize {
        self.network_steps[step]
    }

    /// What is left to take from a step to the one before it.
    ///
    /// # Panics
    /// When there is no such step.
    pub fn posterior(&self, step: usize) -> Posterior {
        let (beta, kept, before) = (self.betas[step], self.kept[step], self.kept_before(step));
        let variance = |step: usize| {
            self.betas[step] * (1.0 - self.kept_before(step)) / (1.0 - self.kept[step])
        };
        // Step 0 has none, whose logarithm would be infinite.
        let with_variance = if step == 0 && self.len() > 1 { 1 } else { step };
        Posterior {
            from_clean: beta * before.sqrt() / (1.0 - kept),
            from_noisy: (1.0 - before) * (1.0 - beta).sqrt() / (1.0 - kept),
            variance: variance(step),
            log_variance: variance(with_variance).ln(),
        }
    }
}
