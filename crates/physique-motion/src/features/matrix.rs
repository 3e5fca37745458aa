//! Features over time: the matrix that networks see.

use glam::Vec3;

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
            let column = index % columns;
            return Err(Error::FeatureNotFinite {
                frame: index / columns,
                column,
                what: FeatureLayout::of(skeleton).describe(skeleton, column),
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

    /// Whether these look like features from which a mean was taken and that were divided by a
    /// deviation, as networks see them.
    ///
    /// Features in their own units hold rotations, whose first three numbers are a unit vector,
    /// and bones about as long as the data set's; normalised ones hold neither. Zeros in place of
    /// the rotations, as some programs write, are not mistaken for it.
    pub fn look_normalised(&self) -> bool {
        let layout = self.layout();
        let (mut off, mut count) = (0.0, 0.0);
        for row in self.rows() {
            for numbers in row[layout.rotations.clone()].as_chunks::<6>().0 {
                let length = Vec3::new(numbers[0], numbers[1], numbers[2]).length();
                off += f64::from((length - 1.0).abs());
                count += 1.0;
            }
        }
        off > 0.3 * count && !self.has_plausible_bones()
    }

    /// Whether most bones are, in the mean, between half and twice as long as the data set's.
    fn has_plausible_bones(&self) -> bool {
        let layout = self.layout();
        let offsets = self.skeleton.offsets();
        let mut lengths = vec![0.0_f32; offsets.len()];
        for row in self.rows() {
            let at = |joint: usize| match joint.checked_sub(1) {
                None => Vec3::new(0.0, row[layout.root_height], 0.0),
                Some(index) => Vec3::from_slice(&row[layout.positions.start + 3 * index..]),
            };
            for [parent, joint] in self.skeleton.bones() {
                lengths[joint] += at(parent).distance(at(joint));
            }
        }
        let plausible = lengths.iter().zip(&offsets).filter(|(sum, offset)| {
            let ratio = *sum / (self.frame_count() as f32 * offset.length());
            (0.5..2.0).contains(&ratio)
        });
        4 * plausible.count() >= 3 * (offsets.len() - 1)
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
