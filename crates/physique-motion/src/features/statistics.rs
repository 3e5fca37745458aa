//! Mean and standard deviation of features, and normalising by them.

use std::path::Path;

use super::{FeatureLayout, FeatureSkeleton, MotionFeatures};
use crate::npz::{Array, ArrayLimits};
use crate::read_file::read_file;
use crate::{Error, Limits};

/// Mean and standard deviation of every column over a data set.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureStatistics {
    skeleton: FeatureSkeleton,
    mean: Vec<f32>,
    deviation: Vec<f32>,
}

impl FeatureStatistics {
    /// What root and contact columns are divided by for the evaluators and MoMask, as published.
    pub const FEATURE_BIAS: f32 = 5.0;

    /// What they are divided by in effect: the reference divides one array in place, once for the
    /// training and again for the validation set.
    pub const EFFECTIVE_FEATURE_BIAS: f32 = Self::FEATURE_BIAS * Self::FEATURE_BIAS;

    /// Statistics from their arrays, as of `Mean.npy` and `Std.npy`.
    ///
    /// # Errors
    /// [`Error::Statistics`] with the column unless both have a number for each column, all are
    /// finite and deviations are above 0.
    pub fn new(
        skeleton: FeatureSkeleton,
        mean: Vec<f32>,
        deviation: Vec<f32>,
    ) -> Result<Self, Error> {
        for (array, values) in [("mean", &mean), ("standard deviation", &deviation)] {
            let (expected, found) = (skeleton.feature_count(), values.len());
            if found != expected {
                return Err(Error::FeatureCount {
                    columns: expected,
                    found,
                });
            }
            let is_wrong = |value: &f32| !value.is_finite() || array != "mean" && *value <= 0.0;
            if let Some(column) = values.iter().position(is_wrong) {
                return Err(Error::Statistics {
                    array,
                    column,
                    found: values[column],
                });
            }
        }
        Ok(Self {
            skeleton,
            mean,
            deviation,
        })
    }

    /// Reads the two arrays of a data set, `Mean.npy` and `Std.npy`: their length says which.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::Array`] for anything but an array of numbers, [`Error::Format`] for
    /// another length, and those of [`Self::new`].
    pub fn read(
        mean: impl AsRef<Path>,
        deviation: impl AsRef<Path>,
        limits: &Limits,
    ) -> Result<Self, Error> {
        let (mean, deviation) = (mean.as_ref(), deviation.as_ref());
        let read = |path: &Path| read_file(path, limits.bytes);
        Self::parse((mean, read(mean)?), (deviation, read(deviation)?), limits)
    }

    /// As [`Self::read`], of bytes that were read; paths only name them in errors.
    ///
    /// # Errors
    /// As [`Self::read`], without [`Error::Io`].
    pub fn parse(
        mean: (&Path, Vec<u8>),
        deviation: (&Path, Vec<u8>),
        limits: &Limits,
    ) -> Result<Self, Error> {
        let place = deviation.0;
        let mean = numbers(mean, limits)?;
        let values = numbers(deviation, limits)?;
        let skeletons = FeatureSkeleton::ALL.into_iter();
        let skeleton = skeletons
            .filter(|skeleton| skeleton.feature_count() == mean.len())
            .find(|_| mean.len() == values.len());
        let Some(skeleton) = skeleton else {
            return Err(Error::Format {
                path: place.into(),
                place: "the array".into(),
                expected: "263 or 251 numbers, as many as of the mean".into(),
                found: format!("{} of the mean, {} here", mean.len(), values.len()),
            });
        };
        Self::new(skeleton, mean, values)
    }

    /// Which features these are of.
    pub const fn skeleton(&self) -> FeatureSkeleton {
        self.skeleton
    }

    /// Mean of each column.
    pub fn mean(&self) -> &[f32] {
        &self.mean
    }

    /// Standard deviation of each column.
    pub fn deviation(&self) -> &[f32] {
        &self.deviation
    }

    /// The statistics with the deviations of the root's four and the contacts' four columns divided
    /// by `bias`, so that a network minds them more.
    ///
    /// [`Self::EFFECTIVE_FEATURE_BIAS`] gives those of the published evaluators. MDM has none.
    ///
    /// # Errors
    /// [`Error::Statistics`] when a deviation is no longer finite and above 0.
    pub fn with_feature_bias(&self, bias: f32) -> Result<Self, Error> {
        let layout = FeatureLayout::of(self.skeleton);
        let mut deviation = self.deviation.clone();
        for column in (0..=layout.root_height).chain(layout.contacts) {
            deviation[column] /= bias;
        }
        Self::new(self.skeleton, self.mean.clone(), deviation)
    }

    /// (x - mean) / deviation for rows of features, in place. Pad with zeros *after* this.
    ///
    /// # Panics
    /// When a row is not whole.
    pub fn normalise(&self, rows: &mut [f32]) {
        self.each_row(rows, |value, mean, deviation| (value - mean) / deviation);
    }

    /// The inverse of [`Self::normalise`].
    ///
    /// # Panics
    /// When a row is not whole.
    pub fn denormalise(&self, rows: &mut [f32]) {
        self.each_row(rows, |value, mean, deviation| value * deviation + mean);
    }

    fn each_row(&self, rows: &mut [f32], change: impl Fn(f32, f32, f32) -> f32) {
        assert!(
            rows.len().is_multiple_of(self.mean.len()),
            "rows of {} columns",
            self.mean.len()
        );
        for row in rows.chunks_exact_mut(self.mean.len()) {
            for ((value, &mean), &deviation) in row.iter_mut().zip(&self.mean).zip(&self.deviation)
            {
                *value = change(*value, mean, deviation);
            }
        }
    }
}

/// All numbers of a `.npy`.
fn numbers((path, bytes): (&Path, Vec<u8>), limits: &Limits) -> Result<Vec<f32>, Error> {
    let array_limits = ArrayLimits {
        bytes: limits.bytes,
        ..ArrayLimits::default()
    };
    let array = Array::from_npy("array", bytes, &array_limits);
    let numbers = array.and_then(|array| array.to_f32());
    numbers.map_err(|problem| Error::Array {
        path: path.into(),
        problem,
    })
}

/// Gathers statistics motion by motion, in memory of one row (Welford's algorithm, 64 bits).
#[derive(Clone, Debug)]
pub struct StatisticsGatherer {
    skeleton: FeatureSkeleton,
    rows: u64,
    mean: Vec<f64>,
    /// Sum of squared distances from the mean.
    squares: Vec<f64>,
}

impl StatisticsGatherer {
    /// Nothing gathered yet.
    pub fn new(skeleton: FeatureSkeleton) -> Self {
        let columns = skeleton.feature_count();
        Self {
            skeleton,
            rows: 0,
            mean: vec![0.0; columns],
            squares: vec![0.0; columns],
        }
    }

    /// Adds all rows of a motion. The data sets' own statistics are over all clips, mirrored ones
    /// and all splits included.
    ///
    /// # Errors
    /// [`Error::FeatureCount`] for features of the other skeleton.
    pub fn add(&mut self, features: &MotionFeatures) -> Result<(), Error> {
        if features.skeleton() != self.skeleton {
            let columns = self.skeleton.feature_count();
            return Err(Error::FeatureCount {
                columns,
                found: features.skeleton().feature_count(),
            });
        }
        for row in features.rows() {
            self.rows += 1;
            for ((&value, mean), squares) in row.iter().zip(&mut self.mean).zip(&mut self.squares) {
                let from_old_mean = f64::from(value) - *mean;
                *mean += from_old_mean / self.rows as f64;
                *squares += from_old_mean * (f64::from(value) - *mean);
            }
        }
        Ok(())
    }

    /// Mean, and population deviation averaged over each block of columns: one number for all
    /// positions, one for all rotations and so on, as published.
    ///
    /// # Errors
    /// [`Error::NoFrames`] when nothing was added; [`Error::Statistics`] for a block that never
    /// changes.
    pub fn finish(&self) -> Result<FeatureStatistics, Error> {
        if self.rows == 0 {
            return Err(Error::NoFrames);
        }
        let mut deviation = vec![0.0_f32; self.mean.len()];
        for block in FeatureLayout::of(self.skeleton).blocks() {
            let columns = block.len() as f64;
            let squares = self.squares[block.clone()].iter();
            let sum: f64 = squares
                .map(|squares| (squares / self.rows as f64).sqrt())
                .sum();
            deviation[block].fill((sum / columns) as f32);
        }
        let mean = self.mean.iter().map(|&mean| mean as f32).collect();
        FeatureStatistics::new(self.skeleton, mean, deviation)
    }
}
