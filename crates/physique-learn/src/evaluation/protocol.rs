//! The published protocol: which motions are compared with which, how often, in batches of how many.
//!
//! After the published drivers of Guo et al. (HumanML3D) and Tevet et al. (MDM):
//!
//! * Each repetition draws the clips of the split in another order, with other windows and captions,
//!   in batches of exactly 32; what is left over is dropped.
//! * The real row embeds those. Its FID is that of one draw against another one.
//! * A generated row asks for motions for the captions and lengths of a third draw, 1,024 at most,
//!   and compares them with **all** real ones of the second.
//! * Motions are padded with zeros to the data set's longest window. What a generator made behind the
//!   length that was asked for stays: the evaluator's convolutions see up to three frames of it.
//! * Multimodality: in the first repetitions, the captions of four batches are generated 30 times.
//! * Self-intersection: the published voxel metric on the motions of a row; of the real row once, on
//!   every clip from its start.
//!
//! All that is random comes from the seed and the repetition's number: repetitions can be made in
//! any order, by several machines, or after a break.

mod captions;
mod draw;
mod generated;
mod measures;
mod options;
mod real;
mod row;
mod self_intersection;

use std::cell::OnceCell;

use physique_data::Dataset;

pub use measures::RepetitionMeasures;
pub use options::{MultimodalityOptions, ProtocolOptions};
pub use row::EvaluationRow;
pub use self_intersection::SelfIntersectionMeter;

use self::captions::CaptionPoints;
use self::draw::{Draws, Pair};
use super::{CaptionReading, NumpyRandom, PairEvaluator, Points, RETRIEVAL_BATCH};
use crate::Error;
use crate::random::Random;

/// Told apart from all other uses of a seed.
const PURPOSE: u64 = 0x6576_616C;

/// The protocol on a data set, by an evaluator.
pub struct EvaluationProtocol<'a> {
    dataset: &'a Dataset,
    evaluator: &'a dyn PairEvaluator,
    meter: Option<&'a SelfIntersectionMeter>,
    options: ProtocolOptions,
    draws: Draws,
    captions: CaptionPoints,
    /// That of the real motions, once it is known.
    real_self_intersection: OnceCell<f64>,
}

impl<'a> EvaluationProtocol<'a> {
    /// Prepares the evaluation; without a meter there is no self-intersection.
    ///
    /// # Errors
    /// [`Error::Setting`] for options that cannot be; [`Error::Input`] for a split of fewer than 32
    /// clips, or an evaluator of another skeleton.
    pub fn new(
        dataset: &'a Dataset,
        evaluator: &'a dyn PairEvaluator,
        meter: Option<&'a SelfIntersectionMeter>,
        options: ProtocolOptions,
    ) -> Result<Self, Error> {
        options.check()?;
        let columns = dataset.skeleton().feature_count();
        let found = evaluator.statistics().mean().len();
        if found != columns {
            let expected = format!("{columns} columns, as the data set has");
            return Err(Error::input("Evaluator", expected, found));
        }
        Ok(Self {
            draws: Draws::new(dataset, options.split, options.seed)?,
            captions: CaptionPoints::new(dataset, options.split),
            dataset,
            evaluator,
            meter,
            options,
            real_self_intersection: OnceCell::new(),
        })
    }

    /// What is evaluated, and how often.
    pub const fn options(&self) -> &ProtocolOptions {
        &self.options
    }

    /// Motions that a repetition of a generated row asks for.
    pub fn motions_to_generate(&self, repetition: usize) -> usize {
        let batches = self.generated_batches();
        let more = self.options.multimodality.map_or(0, |of| {
            let measured = repetition < of.repetitions;
            usize::from(measured) * of.batches.min(batches) * of.motions.saturating_sub(1)
        });
        (batches + more) * RETRIEVAL_BATCH
    }

    /// A row of repetitions, with remarks where it is not what the paper's would be.
    pub fn row(&self, name: &str, about: &str, measures: &[RepetitionMeasures]) -> EvaluationRow {
        let mut row = EvaluationRow::of(name, about, measures);
        let published = ProtocolOptions::default();
        let count = measures.len();
        let remarks = [
            (row.real_motions < published.generated)
                .then(|| format!("{} real motions: FID is biased upwards", row.real_motions)),
            (row.diversity_pairs < published.diversity_pairs)
                .then(|| format!("{} pairs for diversity", row.diversity_pairs)),
            (count != published.repetitions).then(|| format!("{count} repetitions")),
            self.options
                .caption_length_bug
                .then(|| "captions of generated motions read over their padding".to_owned()),
        ];
        row.remarks = remarks.into_iter().flatten().collect();
        row
    }

    fn generated_batches(&self) -> usize {
        let asked = self.options.generated.div_ceil(RETRIEVAL_BATCH);
        asked.min(self.draws.batches())
    }

    fn numpy_random(&self, repetition: usize) -> NumpyRandom {
        let mut random = Random::new(&[self.options.seed, PURPOSE, repetition as u64, 3]);
        NumpyRandom::new(random.bits() as u32)
    }

    fn caption_points(&self, pairs: &[Pair], reading: CaptionReading) -> Result<Points, Error> {
        let captions = pairs.iter().map(|pair| pair.caption);
        self.captions
            .points(self.dataset, self.evaluator, captions, reading)
    }

    /// Normalised for the evaluator, with zeros up to the longest window.
    fn padded(&self, mut rows: Vec<f32>) -> Vec<f32> {
        self.evaluator.statistics().normalise(&mut rows);
        rows.resize(self.frames() * self.dataset.skeleton().feature_count(), 0.0);
        rows
    }

    /// Rows of the longest window.
    fn frames(&self) -> usize {
        self.dataset.index().longest_window
    }
}
