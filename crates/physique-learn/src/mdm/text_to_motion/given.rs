//! What is given of motions before the network makes the rest.

use burn::tensor::Tensor;
use physique_motion::features::{FeatureLayout, MotionFeatures};

use super::{KnownMotion, TextToMotion};
use crate::Error;
use crate::diffusion::{BatchEdit, Edit};
use crate::tensors::tensor;

impl TextToMotion {
    /// The last frames of a motion, for each motion of a batch.
    pub(super) fn context(&self, after: &MotionFeatures, batch: usize) -> Result<Tensor<3>, Error> {
        let config = self.folder.network.config();
        let (frames, columns) = (config.context(), config.columns);
        let mut values = after.values().to_vec();
        if values.len() < frames * columns || after.layout() != self.layout() {
            let expected = format!("{frames} frames of {columns} features or more");
            let found = format!("{} frames", after.frame_count());
            return Err(Error::input("Motion to go on from", expected, found));
        }
        self.folder.statistics.normalise(&mut values);
        let last = &values[values.len() - frames * columns..];
        let shape = [batch, frames, columns];
        Ok(tensor(
            last.repeat(batch),
            shape,
            &self.folder.network.device(),
        ))
    }

    /// The edit of a batch, padded to whole tokens of the network.
    pub(super) fn edit(&self, known: &KnownMotion, lengths: &[usize]) -> Result<BatchEdit, Error> {
        let frames = known.features.frame_count();
        if let Some(length) = lengths.iter().find(|&&length| length != frames) {
            let expected = format!("{frames} frames, as of the known motion");
            return Err(Error::input("Motions", expected, length));
        }
        let config = self.folder.network.config();
        let padded = frames.next_multiple_of(config.frames_per_token);
        let mut features = known.features.values().to_vec();
        self.folder.statistics.normalise(&mut features);
        features.resize(padded * config.columns, 0.0);
        let shape = [lengths.len(), padded, config.columns];
        let features = tensor(
            features.repeat(lengths.len()),
            shape,
            &self.folder.network.device(),
        );
        let edits = vec![known.edit.clone().padded(padded); lengths.len()];
        Edit::of_batch(&edits, features)
    }

    /// Keeps path and legs of normalised motions, each of which has the frames of the longest or more;
    /// nothing is kept behind a motion's own length.
    pub(super) fn legs(&self, motions: &[&[f32]], lengths: &[usize]) -> Result<BatchEdit, Error> {
        let config = self.folder.network.config();
        let longest = lengths.iter().copied().max().unwrap_or(0);
        let frames = longest.next_multiple_of(config.frames_per_token);
        let skeleton = self.folder.statistics.skeleton();
        let edits: Vec<Edit> = lengths
            .iter()
            .map(|&length| Edit::upper_body(length, skeleton).padded(frames))
            .collect();
        let mut known = Vec::with_capacity(motions.len() * frames * config.columns);
        for motion in motions {
            known.extend_from_slice(&motion[..frames * config.columns]);
        }
        let shape = [motions.len(), frames, config.columns];
        Edit::of_batch(&edits, tensor(known, shape, &self.folder.network.device()))
    }

    fn layout(&self) -> FeatureLayout {
        FeatureLayout::of(self.folder.statistics.skeleton())
    }
}
