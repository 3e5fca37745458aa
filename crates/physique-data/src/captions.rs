//! Sentences that describe clips.

use serde::{Deserialize, Serialize};

/// Whether a wording is for training or for testing how a model copes with words it has not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Wording {
    /// Drawn while training.
    Training,
    /// Never drawn while training: at least one of its words is held out.
    HeldOut,
}

/// A sentence.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Caption {
    /// The sentence.
    pub text: String,
    /// `lemma/POS` words, apart by blanks, where the data set has them; the published evaluators
    /// read these.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tokens: Option<String>,
}

/// The captions of clips that are described alike. Numbers count the captions of the
/// [`crate::Index`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaptionSet {
    /// Captions to train with.
    pub training: Vec<usize>,
    /// How often each is drawn, relative to the others; as many as there are training captions.
    pub weights: Vec<f32>,
    /// Captions that training never sees.
    pub held_out: Vec<usize>,
}
