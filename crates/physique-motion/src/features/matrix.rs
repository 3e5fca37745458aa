//! Features over time: the matrix that networks see.

use super::{FeatureLayout, FeatureSkeleton};
use crate::{Error, FrameRate};

/// Features `[frames][263]` or `[frames][251]`, not normalised; see [`FeatureLayout`].
#[derive(Clone, Debug, PartialEq)]
pub struct MotionFeatures {
    frame_rate: FrameRate,
    skeleton: FeatureSkeleton,
    values: Vec<f32>,
}

impl MotionFeatures {
    /// Features in the order `[frames][columns]`.
    ///
    /// # Errors
    /// [`Error::FeatureCount`] unless `values` are whole rows; [`Error::FeatureNotFinite`] with
    /// frame and column; [`Error::NoFrames`].
    pub fn new(
        frame_rate: FrameRate,
        skeleton: FeatureSkeleton,
        values: Vec<f32>,
    ) -> Result<Self, Error> {
        let columns = skeleton.feature_count();
        if !values.len().is_multiple_of(columns) {
            return Err(Error::FeatureCount {
                columns,
                found: values.len(),
            });
        }
        if values.is_empty() {
            return Err(Error::NoFrames);
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(Error::FeatureNotFinite {
                frame: index / columns,
                column: index % columns,
            });
        }
        Ok(Self {
            frame_rate,
            skeleton,
            values,
        })
    }

    /// Frames a second.
    pub const fn frame_rate(&self) -> FrameRate {
        self.frame_rate
    }

    /// Which joints these are features of.
    pub const fn skeleton(&self) -> FeatureSkeleton {
        self.skeleton
    }

    /// Where each block lies in a row.
    pub const fn layout(&self) -> FeatureLayout {
        FeatureLayout::of(self.skeleton)
    }

    /// Number of frames, at least 1.
    pub fn frame_count(&self) -> usize {
        self.values.len() / self.skeleton.feature_count()
    }

    /// `[frames][columns]` numbers, flat.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The row of each frame in turn.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, f32> {
        self.values.chunks_exact(self.skeleton.feature_count())
    }

    pub(super) fn rows_mut(&mut self) -> std::slice::ChunksExactMut<'_, f32> {
        self.values.chunks_exact_mut(self.skeleton.feature_count())
    }
}
