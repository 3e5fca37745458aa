//! Words for the values of labels.

use std::collections::BTreeMap;

use serde::Deserialize;

/// What can be said of a clip whose label has a certain value: lists of words by name.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Words {
    /// The value of the label in the mirror image, where it is another one.
    #[serde(default)]
    pub mirrored: Option<String>,
    /// Words that training never sees, by list.
    #[serde(default)]
    pub held_out: BTreeMap<String, Vec<String>>,
    /// Words to train with, by list.
    #[serde(flatten)]
    pub training: BTreeMap<String, Vec<String>>,
}

impl Words {
    /// Whether there is a list of this name.
    pub(super) fn has(&self, list: &str) -> bool {
        self.training.contains_key(list) || self.held_out.contains_key(list)
    }
}
