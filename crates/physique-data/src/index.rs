//! What a data file knows of its clips.

use std::collections::BTreeMap;

use physique::motion::features::FeatureSkeleton;
use serde::{Deserialize, Serialize};

use crate::{BuildReport, Caption, CaptionSet, Split};

/// What the rows of a file are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Storage {
    /// Positions of the joints, metres, brought to the data set's skeleton and floor; features are
    /// taken of each window by itself, so that rotations agree with positions, at a quarter of the
    /// size.
    Positions,
    /// Features as published; windows are cut out of them, as the published models were trained.
    Features,
}

/// Which skeleton the rows belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SkeletonName {
    /// 22 joints, 263 features.
    Humanml3d,
    /// 21 joints, 251 features.
    Kit,
}

impl From<SkeletonName> for FeatureSkeleton {
    fn from(name: SkeletonName) -> Self {
        match name {
            SkeletonName::Humanml3d => Self::HumanMl3d,
            SkeletonName::Kit => Self::Kit,
        }
    }
}

/// A run of rows of the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recording {
    /// Name below the folder, without ending.
    pub name: String,
    /// Its first row among all rows of the file.
    pub first_row: u64,
    /// Its rows. Positions give one row of features less: steps need a next frame.
    pub rows: usize,
}

/// Something to train on: a recording or a part of it, or a mirror image, with its description.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Clip {
    /// Which recording.
    pub recording: usize,
    /// First row of features of the recording.
    pub start: usize,
    /// Rows of features.
    pub frames: usize,
    /// Whether left and right are exchanged.
    pub mirrored: bool,
    /// Which split.
    pub split: Split,
    /// Which caption set.
    pub captions: usize,
    /// Labels by name.
    pub labels: BTreeMap<String, String>,
}

/// Everything but the rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Index {
    /// The data set's name.
    pub name: String,
    /// Licence of the recordings, which what is trained on them inherits.
    pub licence: String,
    /// Whom to name.
    pub attribution: String,
    /// Version of Physique that built the file.
    pub physique_version: String,
    /// What the rows are.
    pub storage: Storage,
    /// Whose joints.
    pub skeleton: SkeletonName,
    /// Frames a second.
    pub frame_rate: f64,
    /// Shortest window, in rows of features.
    pub shortest_window: usize,
    /// Longest window, in rows of features.
    pub longest_window: usize,
    /// Mean of each column of the features.
    pub mean: Vec<f32>,
    /// Deviation of each column, averaged over each block as published.
    pub deviation: Vec<f32>,
    /// Runs of rows, one after the other without gaps.
    pub recordings: Vec<Recording>,
    /// What to train on.
    pub clips: Vec<Clip>,
    /// All sentences.
    pub captions: Vec<Caption>,
    /// Sentences of clips that are described alike.
    pub caption_sets: Vec<CaptionSet>,
    /// What was found, kept and left out.
    pub report: BuildReport,
}

impl Index {
    /// Numbers in a row of the file.
    pub fn columns(&self) -> usize {
        let skeleton = FeatureSkeleton::from(self.skeleton);
        match self.storage {
            Storage::Positions => 3 * skeleton.joint_count(),
            Storage::Features => skeleton.feature_count(),
        }
    }

    /// Rows of features that a recording gives.
    pub fn feature_rows(&self, recording: &Recording) -> usize {
        match self.storage {
            Storage::Positions => recording.rows.saturating_sub(1),
            Storage::Features => recording.rows,
        }
    }

    /// Name of a clip: its recording's; a part is told by its rows, a mirror image by `mirrored`.
    pub fn clip_name(&self, clip: &Clip) -> String {
        let Some(recording) = self.recordings.get(clip.recording) else {
            return String::new();
        };
        let mut name = recording.name.clone();
        if clip.start > 0 || clip.frames < self.feature_rows(recording) {
            name += &format!("[{}..{}]", clip.start, clip.start + clip.frames);
        }
        if clip.mirrored {
            name += " mirrored";
        }
        name
    }
}
