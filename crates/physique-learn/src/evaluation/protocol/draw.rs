//! Which windows and captions a repetition sees.

use physique_data::{Dataset, Drawn, Sampler, SamplerOptions, Split, Window};

use super::PURPOSE;
use crate::Error;
use crate::evaluation::RETRIEVAL_BATCH;
use crate::random::Random;

/// What a draw is for; each is another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Draw {
    /// The real row itself.
    Row = 0,
    /// Real motions that FID compares with.
    Reference = 1,
    /// Captions and lengths to generate for.
    Prompts = 2,
}

/// A window and the number of a caption of the data set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pair {
    pub(super) window: Window,
    pub(super) caption: usize,
}

/// Draws whole batches of a split.
#[derive(Debug)]
pub(super) struct Draws {
    sampler: Sampler,
    seed: u64,
}

impl Draws {
    /// # Errors
    /// [`Error::Input`] for a split of fewer clips than a batch has.
    pub(super) fn new(dataset: &Dataset, split: Split, seed: u64) -> Result<Self, Error> {
        let options = SamplerOptions {
            split,
            ..SamplerOptions::default()
        };
        let sampler = Sampler::new(dataset, options)?;
        if sampler.clip_count() < RETRIEVAL_BATCH {
            let expected = format!("a batch of {RETRIEVAL_BATCH} or more");
            return Err(Error::input(
                "Clips of the split",
                expected,
                sampler.clip_count(),
            ));
        }
        Ok(Self { sampler, seed })
    }

    /// Whole batches of the split.
    pub(super) fn batches(&self) -> usize {
        self.sampler.clip_count() / RETRIEVAL_BATCH
    }

    /// The first `batches` of a draw, which has each clip once at most.
    ///
    /// # Errors
    /// [`Error::Input`] for a clip without captions.
    pub(super) fn pairs(
        &self,
        repetition: usize,
        draw: Draw,
        batches: usize,
    ) -> Result<Vec<Pair>, Error> {
        let seed = Random::new(&[self.seed, PURPOSE, repetition as u64, draw as u64]).bits();
        let drawn = (0..batches.min(self.batches()) as u64)
            .flat_map(|step| self.sampler.draw(seed, step, RETRIEVAL_BATCH));
        let pairs = drawn.map(|Drawn { window, caption }| {
            let missing = || Error::input("Clips of the split", "captions for each", "one without");
            let caption = caption.ok_or_else(missing)?;
            Ok(Pair { window, caption })
        });
        pairs.collect()
    }
}
