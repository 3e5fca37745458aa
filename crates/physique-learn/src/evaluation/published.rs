//! The published evaluator with all that it needs.

use physique_data::Caption;
use physique_motion::features::FeatureStatistics;

use super::{CaptionReading, Evaluator, PairEvaluator, Points, WordVectors};
use crate::Error;

/// A published evaluator, the word vectors that it reads captions by, and the statistics that it was
/// trained with, which are not those of the data set.
#[derive(Clone, Debug)]
pub struct PublishedEvaluator {
    networks: Evaluator,
    words: WordVectors,
    statistics: FeatureStatistics,
    name: String,
}

impl PublishedEvaluator {
    /// Puts an evaluator together; `name` tells reports which one it is.
    ///
    /// # Errors
    /// [`Error::Input`] when networks and statistics are of different features.
    pub fn new(
        networks: Evaluator,
        words: WordVectors,
        statistics: FeatureStatistics,
        name: String,
    ) -> Result<Self, Error> {
        let (expected, found) = (networks.columns(), statistics.mean().len());
        if found != expected {
            let expected = format!("{expected} columns, as the evaluator reads");
            return Err(Error::input("Statistics", expected, found));
        }
        Ok(Self {
            networks,
            words,
            statistics,
            name,
        })
    }
}

impl PairEvaluator for PublishedEvaluator {
    fn about(&self) -> String {
        format!("published, {}", self.name)
    }

    fn statistics(&self) -> &FeatureStatistics {
        &self.statistics
    }

    fn embed_motions(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<Points, Error> {
        self.networks.embed_motions(motions, frames, lengths)
    }

    fn embed_captions(
        &self,
        captions: &[&Caption],
        reading: CaptionReading,
    ) -> Result<Points, Error> {
        let words = self.words.vectorise(captions, reading)?;
        self.networks.embed_captions(&words)
    }
}
