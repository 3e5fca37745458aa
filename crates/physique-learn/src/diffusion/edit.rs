//! Editing: parts of a motion are given, the network makes the rest.

use std::ops::Range;

use burn::tensor::{Device, Tensor, TensorData};
use physique_motion::features::{FeatureLayout, FeatureSkeleton};

use crate::Error;

/// Which numbers of a motion are kept: `[frames][columns]`.
///
/// After every prediction x_0 is replaced where it is known; the network sees the known part
/// through the noise of the next step, and makes the rest fit. As published for MDM (Tevet et al.,
/// "Human Motion Diffusion Model", 2023, section 4).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    frames: usize,
    columns: usize,
    kept: Vec<bool>,
}

impl Edit {
    /// Nothing is kept: all is made.
    pub fn all_new(frames: usize, columns: usize) -> Self {
        Self {
            frames,
            columns,
            kept: vec![false; frames * columns],
        }
    }

    /// In-betweening as published: the first and the last quarter of `length` frames are kept, and
    /// all frames behind it.
    pub fn in_between(length: usize, frames: usize, columns: usize) -> Self {
        let (start, end) = (length / 4, length * 3 / 4);
        Self::all_new(frames, columns)
            .keep(0..start, 0..columns)
            .keep(end..frames, 0..columns)
    }

    /// The legs' motion and path are kept, trunk and arms are made: 107 of HumanML3D's 263 columns.
    pub fn upper_body(frames: usize, skeleton: FeatureSkeleton) -> Self {
        let legs: &[usize] = match skeleton {
            FeatureSkeleton::HumanMl3d => &[0, 1, 2, 4, 5, 7, 8, 10, 11],
            FeatureSkeleton::Kit => &[0, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20],
        };
        Self::all_new(frames, skeleton.feature_count()).keep_joints(0..frames, legs, skeleton)
    }

    /// Keeps joints of a skeleton in a range of frames: their positions, rotations and velocities;
    /// with the root (0) its path and height, and with it the contacts of the feet.
    ///
    /// Joints and frames that are not there are passed over.
    #[must_use]
    pub fn keep_joints(
        mut self,
        frames: Range<usize>,
        joints: &[usize],
        skeleton: FeatureSkeleton,
    ) -> Self {
        let layout = FeatureLayout::of(skeleton);
        for &joint in joints
            .iter()
            .filter(|&&joint| joint < skeleton.joint_count())
        {
            let block = |start: usize, index: usize, width: usize| {
                start + index * width..start + (index + 1) * width
            };
            let mut columns = vec![block(layout.velocities.start, joint, 3)];
            match joint.checked_sub(1) {
                Some(index) => {
                    columns.push(block(layout.positions.start, index, 3));
                    columns.push(block(layout.rotations.start, index, 6));
                }
                None => {
                    columns.push(0..layout.root_height + 1);
                    columns.push(layout.contacts.clone());
                }
            }
            for columns in columns {
                self = self.keep(frames.clone(), columns);
            }
        }
        self
    }

    /// Keeps columns in a range of frames; what is not there is passed over.
    #[must_use]
    pub fn keep(mut self, frames: Range<usize>, columns: Range<usize>) -> Self {
        let columns = columns.start.min(self.columns)..columns.end.min(self.columns);
        for frame in frames.start..frames.end.min(self.frames) {
            let row = frame * self.columns;
            if !columns.is_empty() {
                self.kept[row + columns.start..row + columns.end].fill(true);
            }
        }
        self
    }

    /// The same with `frames` frames; nothing is kept of those that come in addition.
    #[must_use]
    pub fn padded(mut self, frames: usize) -> Self {
        self.kept.resize(frames * self.columns, false);
        self.frames = frames;
        self
    }

    /// `[frames][columns]`: which numbers are kept.
    pub fn kept(&self) -> &[bool] {
        &self.kept
    }

    /// The edit of a batch, ready for use on a device; `known` are the motions that numbers are
    /// kept of, `[batch][frames][columns]`, normalised.
    ///
    /// # Errors
    /// [`Error::Input`] when they have other frames or columns than the edits, or are not as many.
    pub fn of_batch(edits: &[Self], known: Tensor<3>) -> Result<BatchEdit, Error> {
        let [batch, frames, columns] = known.dims();
        let fits = edits.len() == batch
            && edits
                .iter()
                .all(|edit| (edit.frames, edit.columns) == (frames, columns));
        if !fits {
            let found: Vec<_> = edits
                .iter()
                .map(|edit| [edit.frames, edit.columns])
                .collect();
            let expected = format!("{batch} of [{frames}, {columns}], as the motions");
            return Err(Error::input("Edits", expected, format!("{found:?}")));
        }
        let kept = edits.iter().flat_map(|edit| &edit.kept);
        let kept: Vec<f32> = kept.map(|&kept| f32::from(u8::from(kept))).collect();
        let device: Device = known.device();
        let kept = Tensor::from_data(TensorData::new(kept, [batch, frames, columns]), &device);
        Ok(BatchEdit {
            known: known * kept.clone(),
            made: -kept + 1.0,
        })
    }
}

/// Edits of a batch, see [`Edit::of_batch`].
#[derive(Clone, Debug)]
pub struct BatchEdit {
    /// The known numbers, 0 where there are none.
    known: Tensor<3>,
    /// 1 where numbers are made, 0 where they are known.
    made: Tensor<3>,
}

impl BatchEdit {
    /// `[batch][frames][columns]`: 1 where numbers are made, 0 where they are known.
    pub(super) fn made(&self) -> Tensor<3> {
        self.made.clone()
    }

    /// A prediction with the known numbers in their places.
    pub fn apply(&self, clean: Tensor<3>) -> Tensor<3> {
        clean * self.made.clone() + self.known.clone()
    }
}
