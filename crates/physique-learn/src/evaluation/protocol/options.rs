//! What is evaluated, and how often.

use physique_data::Split;
use serde::Serialize;

use crate::Error;

/// The default is as published.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ProtocolOptions {
    /// Clips to compare with.
    pub split: Split,
    /// How often all is done.
    pub repetitions: usize,
    /// Most motions to generate for a repetition, rounded up to whole batches.
    pub generated: usize,
    /// Pairs of motions whose distances are diversity; fewer where there are fewer motions.
    pub diversity_pairs: usize,
    /// How multimodality is measured, if it is.
    pub multimodality: Option<MultimodalityOptions>,
    /// Captions of generated motions are read over their padding, as before January 2024: see
    /// [`CaptionReading::WithPadding`](crate::evaluation::CaptionReading::WithPadding).
    pub caption_length_bug: bool,
    /// What all random numbers depend on.
    pub seed: u64,
}

/// How multimodality is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MultimodalityOptions {
    /// Repetitions that it is measured in: the first ones.
    pub repetitions: usize,
    /// Batches of captions.
    pub batches: usize,
    /// Motions for each caption.
    pub motions: usize,
    /// Pairs of them.
    pub pairs: usize,
}

impl Default for MultimodalityOptions {
    fn default() -> Self {
        Self {
            repetitions: 5,
            batches: 4,
            motions: 30,
            pairs: 10,
        }
    }
}

impl Default for ProtocolOptions {
    fn default() -> Self {
        Self {
            split: Split::Test,
            repetitions: 20,
            generated: 1024,
            diversity_pairs: 300,
            multimodality: Some(MultimodalityOptions::default()),
            caption_length_bug: false,
            seed: 10,
        }
    }
}

impl ProtocolOptions {
    pub(super) fn check(&self) -> Result<(), Error> {
        let counts = [
            ("repetitions", self.repetitions),
            ("generated", self.generated),
            ("diversity_pairs", self.diversity_pairs),
        ];
        let multimodality = self.multimodality.map(|of| {
            [
                ("multimodality.batches", of.batches),
                ("multimodality.pairs", of.pairs),
                // As many pairs are drawn twice, without repetition.
                (
                    "multimodality.motions",
                    (of.motions + 1).saturating_sub(of.pairs),
                ),
            ]
        });
        for (what, found) in counts
            .into_iter()
            .chain(multimodality.into_iter().flatten())
        {
            if found == 0 {
                let expected = match what {
                    "multimodality.motions" => "as many as pairs, or more",
                    _ => "1 or more",
                };
                return Err(Error::setting(what, expected, "less"));
            }
        }
        Ok(())
    }
}
