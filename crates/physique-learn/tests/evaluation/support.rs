//! Small made-up data sets in the published layout.

use std::fs;
use std::path::Path;

use physique_data::{DataLimits, Dataset, PublishedSet, Source, build};
use physique_files::npz::npy_f32;
use physique_motion::FrameRate;
use physique_motion::features::{FeatureSkeleton, MotionFeatures, write_features};

pub(crate) const COLUMNS: usize = 263;
/// Column that tells which clip a made-up motion is of: the root's height.
pub(crate) const NUMBER: usize = 3;

/// A clip of a made-up data set.
pub(crate) struct MadeUp {
    /// `[frames][263]`.
    pub(crate) rows: Vec<f32>,
    /// The caption, and its words.
    pub(crate) caption: String,
    pub(crate) tokens: String,
}

impl MadeUp {
    /// A clip that tells its number, by its caption and in one column.
    pub(crate) fn numbered(number: usize) -> Self {
        let mut row = [0.1; COLUMNS];
        row[NUMBER] = number as f32;
        Self {
            rows: row.repeat(44),
            caption: format!("clip {number}"),
            tokens: format!("clip/NOUN n{number}/NUM"),
        }
    }
}

/// A data set of these clips.
pub(crate) fn dataset(folder: &Path, train: Vec<MadeUp>, test: Vec<MadeUp>) -> Dataset {
    for name in ["new_joint_vecs", "texts"] {
        fs::create_dir_all(folder.join(name)).expect("a folder");
    }
    // Made-up clips do not vary in every column.
    for (name, value) in [("Mean.npy", 0.0), ("Std.npy", 1.0)] {
        let array = npy_f32(&[COLUMNS], &[value; COLUMNS]).expect("whole");
        fs::write(folder.join(name), array).expect("written");
    }
    let mut next = 0;
    for (list, clips) in [
        ("train.txt", train),
        ("val.txt", Vec::new()),
        ("test.txt", test),
    ] {
        let mut names = String::new();
        for clip in clips {
            let name = format!("{next:06}");
            next += 1;
            let rate = FrameRate::new(20.0).expect("possible");
            let features = MotionFeatures::new(rate, FeatureSkeleton::HumanMl3d, clip.rows);
            let file = folder.join("new_joint_vecs").join(format!("{name}.npy"));
            write_features(file, &features.expect("whole rows")).expect("written");
            let text = format!("{}#{}#0.0#0.0\n", clip.caption, clip.tokens);
            fs::write(folder.join("texts").join(format!("{name}.txt")), text).expect("written");
            names += &format!("{name}\n");
        }
        fs::write(folder.join(list), names).expect("written");
    }
    let (output, limits) = (folder.join("made-up.pmd"), DataLimits::default());
    let source = Source::Published(PublishedSet::HumanMl3d);
    build(&source, folder, &output, &limits, &()).expect("sound clips");
    Dataset::open(&output, &limits).expect("just built")
}
