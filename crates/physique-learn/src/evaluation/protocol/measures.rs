//! What a repetition gives.

use serde::{Deserialize, Serialize};

use crate::Error;
use crate::evaluation::{
    Moments, NumpyRandom, Points, RETRIEVAL_BATCH, Retrieval, diversity, frechet_distance,
};

/// The measures of one repetition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RepetitionMeasures {
    /// Which repetition, from 0.
    pub repetition: usize,
    /// Motions of the row.
    pub motions: usize,
    /// Real motions that they are compared with.
    pub real_motions: usize,
    /// Pairs of motions whose distances are diversity.
    pub diversity_pairs: usize,
    /// Top 1, 2 and 3 of 32.
    pub r_precision: [f64; 3],
    /// Mean distance of motions from their captions.
    pub multimodal_distance: f64,
    /// Fréchet distance from the real motions.
    pub fid: f64,
    /// Mean distance of motions from each other.
    pub diversity: f64,
    /// Mean distance of motions of one caption from each other.
    pub multimodality: Option<f64>,
    /// Mean over motions, in the published metric's "cm3".
    pub self_intersection_cm3: Option<f64>,
}

/// Pairs of captions and motions as points, whole batches of 32.
pub(super) struct Embedded {
    pub(super) captions: Points,
    pub(super) motions: Points,
}

impl Embedded {
    /// Compares pairs with each other and motions with real ones.
    pub(super) fn measure(
        &self,
        repetition: usize,
        real: &Points,
        pairs: usize,
        random: &mut NumpyRandom,
    ) -> Result<RepetitionMeasures, Error> {
        let mut retrieval = Retrieval::default();
        let batch = RETRIEVAL_BATCH * self.motions.width();
        let captions = self.captions.values().chunks(batch);
        for (captions, motions) in captions.zip(self.motions.values().chunks(batch)) {
            let points = |values: &[f64]| Points::new(self.motions.width(), values.to_vec());
            retrieval.add(&points(captions)?, &points(motions)?)?;
        }
        let diversity_pairs = pairs.min(self.motions.len());
        let fid = frechet_distance(&Moments::of(real)?, &Moments::of(&self.motions)?)?;
        Ok(RepetitionMeasures {
            repetition,
            motions: self.motions.len(),
            real_motions: real.len(),
            diversity_pairs,
            r_precision: retrieval.precision(),
            multimodal_distance: retrieval.multimodal_distance(),
            fid,
            diversity: diversity(&self.motions, diversity_pairs, random)?,
            multimodality: None,
            self_intersection_cm3: None,
        })
    }
}
