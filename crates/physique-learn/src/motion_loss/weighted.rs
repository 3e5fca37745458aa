//! Losses that count together.

use std::sync::Arc;

use burn::tensor::Tensor;

use super::{MotionLoss, losses};
use crate::Error;

/// A [`MotionLoss`], what it is called and how much it counts.
#[derive(Clone, Debug)]
pub struct WeightedLoss {
    name: &'static str,
    weight: f64,
    loss: Arc<dyn MotionLoss>,
}

impl WeightedLoss {
    /// A loss that counts `weight` times.
    ///
    /// # Errors
    /// [`Error::Setting`] unless the weight is a finite number from 0.
    pub fn new(
        name: &'static str,
        weight: f64,
        loss: impl MotionLoss + 'static,
    ) -> Result<Self, Error> {
        check(name, weight)?;
        Ok(Self {
            name,
            weight,
            loss: Arc::new(loss),
        })
    }

    /// The same loss with another weight.
    ///
    /// # Errors
    /// As [`WeightedLoss::new`].
    pub fn with_weight(mut self, weight: f64) -> Result<Self, Error> {
        check(self.name, weight)?;
        self.weight = weight;
        Ok(self)
    }

    /// What it is called, in logs too.
    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// How much it counts.
    pub const fn weight(&self) -> f64 {
        self.weight
    }

    /// The loss itself.
    pub fn loss(&self) -> &Arc<dyn MotionLoss> {
        &self.loss
    }

    /// The mean over a batch of normalised motions `[batch][frames][columns]`, not yet weighed:
    /// one number, which Burn differentiates.
    pub fn mean(&self, motions: Tensor<3>, lengths: &[usize]) -> Tensor<1> {
        losses(motions, lengths, &self.loss).mean()
    }
}

fn check(name: &'static str, weight: f64) -> Result<(), Error> {
    if weight.is_finite() && weight >= 0.0 {
        return Ok(());
    }
    Err(Error::setting(name, "a finite weight from 0", weight))
}
