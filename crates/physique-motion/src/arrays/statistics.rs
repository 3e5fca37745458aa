//! Means and deviations of data sets: arrays that lie among motions and are none.

use std::path::Path;

use super::rows;
use crate::features::FeatureSkeleton;
use crate::npz::{Array, ArrayLimits};
use crate::read::stem;
use crate::read_file::read_file;

/// Whether a file is the mean or deviation of a data set's features, as `Mean.npy` and `Std.npy`
/// are: one row of numbers, as many as a frame of features has, or named so.
///
/// Such files lie beside motions; whoever walks a folder passes them over. What cannot be read is
/// not one. Cost: the file is read if it is below 64 KiB.
pub fn is_statistics_file(path: impl AsRef<Path>) -> bool {
    const LARGEST: u64 = 1 << 16;
    let path = path.as_ref();
    let Ok(bytes) = read_file(path, LARGEST) else {
        return false;
    };
    if !bytes.starts_with(b"\x93NUMPY") {
        return false;
    }
    let limits = ArrayLimits {
        bytes: LARGEST,
        ..ArrayLimits::default()
    };
    Array::from_npy("array", bytes, &limits).is_ok_and(|array| describe(&array, path).is_some())
}

/// What an array of statistics looks like; `None` for other arrays.
pub(super) fn describe(array: &Array, path: &Path) -> Option<String> {
    let name = stem(path).to_lowercase();
    let mut words = name.split(|c: char| !c.is_alphanumeric());
    let is_named = words.any(|word| ["mean", "std"].contains(&word));
    let width = match *array.shape() {
        [width] => Some(width),
        [1, width] if is_named => Some(width),
        [joints, 3] if is_named => Some(3 * joints),
        _ => None,
    }?;
    let skeletons = FeatureSkeleton::ALL.into_iter();
    let mut features = skeletons.filter(|skeleton| skeleton.feature_count() == width);
    if let Some(skeleton) = features.next() {
        let whose = match skeleton {
            FeatureSkeleton::HumanMl3d => "HumanML3D",
            FeatureSkeleton::Kit => "KIT-ML",
        };
        return Some(format!(
            "the mean or deviation of {whose}'s {width} features, which goes to --mean or --std, \
             and is no motion"
        ));
    }
    (is_named || rows::is_width(width)).then(|| {
        format!(
            "the mean or deviation of {width} numbers a frame, which is no motion: features must \
             be taken back to their own units with it first"
        )
    })
}
