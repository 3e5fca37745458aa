//! The real row.

use physique_data::Window;
use rayon::prelude::*;

use super::draw::{Draw, Pair};
use super::measures::Embedded;
use super::{EvaluationProtocol, RepetitionMeasures, SelfIntersectionMeter};
use crate::Error;
use crate::evaluation::{CaptionReading, Points, RETRIEVAL_BATCH};

impl EvaluationProtocol<'_> {
    /// A repetition of the real row.
    ///
    /// # Errors
    /// Those of data set and evaluator.
    pub fn real(&self, repetition: usize) -> Result<RepetitionMeasures, Error> {
        let reference = self.reference(repetition)?;
        let pairs = self.draws.pairs(repetition, Draw::Row, usize::MAX)?;
        let row = Embedded {
            captions: self.caption_points(&pairs, CaptionReading::Whole)?,
            motions: self.real_points(&pairs)?,
        };
        let mut random = self.numpy_random(repetition);
        let mut measures = row.measure(
            repetition,
            &reference,
            self.options.diversity_pairs,
            &mut random,
        )?;
        measures.self_intersection_cm3 = match (self.meter, self.real_self_intersection.get()) {
            (Some(_), Some(&known)) => Some(known),
            (Some(meter), None) => {
                let found = self.measure_real(meter)?;
                Some(*self.real_self_intersection.get_or_init(|| found))
            }
            (None, _) => None,
        };
        Ok(measures)
    }

    /// Real motions that FID compares with.
    pub(super) fn reference(&self, repetition: usize) -> Result<Points, Error> {
        let pairs = self.draws.pairs(repetition, Draw::Reference, usize::MAX)?;
        self.real_points(&pairs)
    }

    fn real_points(&self, pairs: &[Pair]) -> Result<Points, Error> {
        let (mut values, mut width) = (Vec::new(), 1);
        for pairs in pairs.chunks(RETRIEVAL_BATCH) {
            let dataset = self.dataset;
            let features = pairs.par_iter().map(|pair| dataset.features(pair.window));
            let features: Vec<Result<_, _>> = features.collect();
            let mut rows = Vec::new();
            for features in features {
                rows.extend(self.padded(features?.values().to_vec()));
            }
            let lengths: Vec<usize> = pairs.iter().map(|pair| pair.window.frames).collect();
            let points = self
                .evaluator
                .embed_motions(&rows, self.frames(), &lengths)?;
            width = points.width();
            values.extend_from_slice(points.values());
        }
        Points::new(width, values)
    }

    fn measure_real(&self, meter: &SelfIntersectionMeter) -> Result<f64, Error> {
        let mut motions = Vec::new();
        for clip in self.dataset.clips_of(self.options.split) {
            let whole = self.dataset.whole(clip)?;
            let frames = whole.frames.min(self.frames());
            motions.push(self.dataset.features(Window { frames, ..whole })?);
        }
        meter.mean(&motions)
    }
}
