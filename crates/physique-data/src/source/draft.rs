//! Motions that were looked at, before they are counted and split.

use physique::motion::features::MotionFeatures;

use crate::recipe::Labels;
use crate::{Caption, LeftOut, Split};

/// What is going to be looked at.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plan {
    pub(crate) jobs: usize,
    pub(crate) left_out: Vec<LeftOut>,
    pub(crate) unnamed_files: usize,
    pub(crate) notes: Vec<String>,
}

/// What became of a motion.
#[derive(Debug)]
pub(crate) enum Outcome {
    Kept(Draft),
    LeftOut(LeftOut),
}

/// A motion to keep.
#[derive(Debug)]
pub(crate) struct Draft {
    pub(crate) name: String,
    pub(crate) rows: Vec<f32>,
    pub(crate) row_count: usize,
    /// All that statistics are taken of: the motion, and its mirror image where it is wanted.
    pub(crate) features: Vec<MotionFeatures>,
    pub(crate) clips: Vec<DraftClip>,
    pub(crate) split: SplitBy,
}

/// How a motion gets its split.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum SplitBy {
    /// The data set says.
    Given(Split),
    /// By the recipe's rule, within this group.
    Rule(String),
}

/// A clip of a motion.
#[derive(Debug)]
pub(crate) struct DraftClip {
    pub(crate) start: usize,
    pub(crate) frames: usize,
    pub(crate) mirrored: bool,
    pub(crate) labels: Labels,
    pub(crate) sayings: Sayings,
}

/// What is said of a clip.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sayings {
    pub(crate) training: Vec<(Caption, f32)>,
    pub(crate) held_out: Vec<Caption>,
}
