//! Sizes, and how to train.

use serde::{Deserialize, Serialize};

use crate::Error;
use crate::evaluation::EvaluatorSizes;

/// Shape of a sentence evaluator's networks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SentenceConfig {
    /// Features a frame.
    pub columns: usize,
    /// Numbers of an encoded caption.
    pub text: usize,
    /// Widths of the layers.
    pub sizes: EvaluatorSizes,
}

impl SentenceConfig {
    /// For features of `columns` numbers and captions of `text`: a quarter of the published widths
    /// or less, which a small data set fills.
    pub const fn small(columns: usize, text: usize) -> Self {
        Self {
            columns,
            text,
            sizes: EvaluatorSizes {
                movement: 128,
                motion_state: 128,
                text_state: 256,
                embedding: 128,
            },
        }
    }
}

/// How a sentence evaluator learns.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SentenceTraining {
    /// Pairs a step; all but the own one are negatives.
    pub batch: usize,
    /// What squared distances are divided by before the softmax.
    pub temperature: f64,
    /// Cosine of two captions, less the mean caption, from which on they are not told apart.
    pub same_caption: f64,
    /// Share of the movement encoder's activations that are dropped, as published.
    pub dropout: f64,
}

impl Default for SentenceTraining {
    fn default() -> Self {
        Self {
            batch: 32,
            temperature: 10.0,
            same_caption: 0.9,
            dropout: 0.2,
        }
    }
}

impl SentenceTraining {
    pub(super) fn check(&self) -> Result<(), Error> {
        if self.batch < 2 {
            return Err(Error::setting("batch", "2 or more", self.batch));
        }
        if !(self.temperature.is_finite() && self.temperature > 0.0) {
            let expected = "a finite number above 0";
            return Err(Error::setting("temperature", expected, self.temperature));
        }
        if !(-1.0..=1.0).contains(&self.same_caption) {
            return Err(Error::setting("same_caption", "-1 to 1", self.same_caption));
        }
        if !(0.0..1.0).contains(&self.dropout) {
            let expected = "at least 0 and below 1";
            return Err(Error::setting("dropout", expected, self.dropout));
        }
        Ok(())
    }
}
