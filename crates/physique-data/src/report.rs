//! What was found in a folder, what was kept, and what was left out and why.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::Split;

/// Why something is not trained on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Reason {
    /// The file cannot be read, or holds no human.
    Unreadable,
    /// A number is NaN or infinite.
    NotFinite,
    /// No features can be taken of it: a body that faces nowhere, a bone of no length.
    NoFeatures,
    /// A joint is elsewhere from one frame to the next.
    Jump,
    /// Shorter than the shortest window.
    TooShort,
    /// Longer than the data set allows.
    TooLong,
    /// No sentence can be made for it.
    NoCaption,
    /// A text file that is missing or broken.
    Text,
    /// The same recording as another file.
    Duplicate,
    /// The recipe says so.
    Recipe,
    /// The published data set lists it as broken.
    Listed,
}

impl Reason {
    /// All reasons, in the order of tables.
    pub const ALL: [Self; 11] = [
        Self::Unreadable,
        Self::NotFinite,
        Self::NoFeatures,
        Self::Jump,
        Self::TooShort,
        Self::TooLong,
        Self::NoCaption,
        Self::Text,
        Self::Duplicate,
        Self::Recipe,
        Self::Listed,
    ];

    /// Its name in files and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unreadable => "unreadable",
            Self::NotFinite => "not-finite",
            Self::NoFeatures => "no-features",
            Self::Jump => "jump",
            Self::TooShort => "too-short",
            Self::TooLong => "too-long",
            Self::NoCaption => "no-caption",
            Self::Text => "text",
            Self::Duplicate => "duplicate",
            Self::Recipe => "recipe",
            Self::Listed => "listed",
        }
    }
}

/// Something that is not trained on.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeftOut {
    /// Name below the folder.
    pub name: String,
    /// What kind of reason.
    pub reason: Reason,
    /// A sentence with place, expectation and finding.
    pub message: String,
}

/// How much there is of something, mirror images counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Amount {
    /// Clips.
    pub clips: usize,
    /// Hours of them.
    pub hours: f64,
}

impl Amount {
    pub(crate) fn add(&mut self, seconds: f64) {
        self.clips += 1;
        self.hours += seconds / 3600.0;
    }
}

/// What building a data set found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BuildReport {
    /// Motions that the recipe names.
    pub found: usize,
    /// Motion files in the folder that no pattern of the recipe names.
    pub unnamed_files: usize,
    /// What is in the file as recorded, without mirror images.
    pub recorded: Amount,
    /// What there is to draw, mirror images included, by split.
    pub splits: BTreeMap<Split, Amount>,
    /// What there is to draw, by label and its value.
    pub labels: BTreeMap<String, BTreeMap<String, Amount>>,
    /// Different sentences to train with.
    pub training_captions: usize,
    /// Different sentences that training never sees.
    pub held_out_captions: usize,
    /// What is not trained on.
    pub left_out: Vec<LeftOut>,
    /// What a person should know: full sentences.
    pub notes: Vec<String>,
}

impl BuildReport {
    /// How many were left out, by reason.
    pub fn left_out_by_reason(&self) -> BTreeMap<Reason, usize> {
        let mut counts = BTreeMap::new();
        for left_out in &self.left_out {
            *counts.entry(left_out.reason).or_default() += 1;
        }
        counts
    }
}
