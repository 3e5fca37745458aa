//! What a step of training sees.

use std::ops::Range;

use crate::Error;
use crate::text::Embeddings;

/// Motions of one step.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionBatch {
    /// Frames of the longest motion, to which the others are padded with zeros.
    pub frames: usize,
    /// Normalised features, `[batch][frames][columns]`.
    pub features: Vec<f32>,
    /// Frames of each motion.
    pub lengths: Vec<usize>,
    /// What each motion is.
    pub condition: BatchCondition,
}

/// What each motion of a batch is, as plain numbers.
#[derive(Clone, Debug, PartialEq)]
pub enum BatchCondition {
    /// Nothing is said.
    Nothing,
    /// Encoded captions.
    Text(Embeddings),
    /// Numbers of actions.
    Actions(Vec<usize>),
}

/// Where motions come from.
pub trait MotionSource: Sync {
    /// Features a frame.
    fn columns(&self) -> usize;

    /// The batch of a step. It depends on its arguments only: that is what makes a run repeatable,
    /// and lets it go on in the middle.
    ///
    /// # Errors
    /// Depends on the source.
    fn batch(&self, size: usize, seed: u64, step: u64) -> Result<MotionBatch, Error>;
}

impl MotionBatch {
    /// Only the motions of a range, with as much padding as they had.
    pub(crate) fn only(self, range: Range<usize>, columns: usize) -> Self {
        if range == (0..self.lengths.len()) {
            return self;
        }
        let size = self.frames * columns;
        let condition = match self.condition {
            BatchCondition::Nothing => BatchCondition::Nothing,
            BatchCondition::Actions(actions) => {
                BatchCondition::Actions(actions[range.clone()].to_vec())
            }
            BatchCondition::Text(text) => {
                let (marks, numbers) = (text.tokens, text.tokens * text.width);
                BatchCondition::Text(Embeddings {
                    batch: range.len(),
                    values: text.values[range.start * numbers..range.end * numbers].to_vec(),
                    padding: text.padding[range.start * marks..range.end * marks].to_vec(),
                    ..text
                })
            }
        };
        Self {
            frames: self.frames,
            features: self.features[range.start * size..range.end * size].to_vec(),
            lengths: self.lengths[range].to_vec(),
            condition,
        }
    }

    /// The first `context` frames of all motions, `[batch][context][columns]`, and the motions behind
    /// them.
    ///
    /// # Errors
    /// [`Error::Input`] when a motion has no frame behind them.
    pub(crate) fn behind(self, context: usize, columns: usize) -> Result<(Vec<f32>, Self), Error> {
        if let Some(length) = self.lengths.iter().find(|&&length| length <= context) {
            let expected = format!("more than the {context} frames that a planner goes on from");
            return Err(Error::input("Length of a motion", expected, length));
        }
        let motions = self.features.chunks_exact(self.frames * columns);
        let (front, rest): (Vec<&[f32]>, Vec<&[f32]>) = motions
            .map(|motion| motion.split_at(context * columns))
            .unzip();
        let lengths = self.lengths.iter().map(|length| length - context);
        let rest = Self {
            frames: self.frames - context,
            features: rest.concat(),
            lengths: lengths.collect(),
            condition: self.condition,
        };
        Ok((front.concat(), rest))
    }

    /// Whether counts fit each other.
    ///
    /// # Errors
    /// [`Error::Input`] with the first count that does not.
    pub(crate) fn check(&self, columns: usize) -> Result<(), Error> {
        let batch = self.lengths.len();
        let expected = batch * self.frames * columns;
        if self.features.len() != expected || batch == 0 {
            let expected = format!("{batch} x {} x {columns} numbers", self.frames);
            return Err(Error::input("Batch", expected, self.features.len()));
        }
        let possible = 1..=self.frames;
        if let Some(length) = self
            .lengths
            .iter()
            .find(|length| !possible.contains(length))
        {
            let expected = format!("1 to {} frames", self.frames);
            return Err(Error::input("Length of a motion", expected, length));
        }
        Ok(())
    }
}
