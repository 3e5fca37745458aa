//! What the protocol asks of an evaluator.

use physique_data::Caption;
use physique_motion::features::FeatureStatistics;

use super::Points;
use crate::Error;

/// Embeds captions and motions as points of one space, matching ones close to each other.
pub trait PairEvaluator {
    /// What it is, in words, for reports.
    fn about(&self) -> String;

    /// What motions must be normalised by before it sees them.
    fn statistics(&self) -> &FeatureStatistics;

    /// Embeds motions `[motions][frames][columns]`, of which each has `lengths` frames.
    ///
    /// # Errors
    /// [`Error::Input`] when the numbers are no whole motions, or a length is below 4 or above
    /// `frames`.
    fn embed_motions(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<Points, Error>;

    /// Embeds captions.
    ///
    /// # Errors
    /// [`Error::Input`] for captions without what it reads; [`Error::Setting`] for a reading that it
    /// does not know.
    fn embed_captions(
        &self,
        captions: &[&Caption],
        reading: CaptionReading,
    ) -> Result<Points, Error>;
}

/// How far captions are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CaptionReading {
    /// To their last word.
    #[default]
    Whole,
    /// Over the padding behind, too: the bug of issue 182 of MDM's repository. Captions of generated
    /// motions were read so in everything published before January 2024; R-precision and multimodal
    /// distance come out worse, nothing else changes.
    WithPadding,
}
