//! What all evaluators do with motions.

use burn::module::Module;
use burn::tensor::{Device, Tensor};

use super::Points;
use super::networks::{EvaluatorSizes, MotionEncoder, MovementEncoder};
use crate::Error;
use crate::layers::{Dropout, Initialiser};
use crate::tensors::{numbers, tensor};

/// Frames that one step of the movement encoder stands for.
pub(super) const FRAMES_A_STEP: usize = 4;
/// Most frames behind a motion's end that its last step of movement sees.
pub(super) const SEEN_BEHIND: usize = 3;
/// Columns at the end of a row, contacts of the feet, that the networks do not see.
const UNSEEN: usize = 4;

/// Motions to points: four frames to a step of movement, all steps to a point.
#[derive(Module, Debug)]
pub(super) struct MotionSide {
    pub(super) movement_encoder: MovementEncoder,
    pub(super) motion_encoder: MotionEncoder,
    pub(super) columns: usize,
}

impl MotionSide {
    /// Of features with `columns` numbers a frame.
    pub(super) fn new(
        columns: usize,
        sizes: EvaluatorSizes,
        initialiser: &mut Initialiser,
    ) -> Result<Self, Error> {
        if columns <= UNSEEN {
            return Err(Error::setting("columns", "more than 4 features", columns));
        }
        Ok(Self {
            movement_encoder: MovementEncoder::new(columns - UNSEEN, sizes.movement, initialiser),
            motion_encoder: MotionEncoder::new(sizes, initialiser),
            columns,
        })
    }

    /// Steps of movement, `[motions][frames / 4][width]`, of motions `[motions][frames][columns]`.
    pub(super) fn movement(
        &self,
        motions: &[f32],
        frames: usize,
        device: &Device,
        dropout: &Dropout,
    ) -> Result<Tensor<3>, Error> {
        let motion = frames * self.columns;
        if frames < FRAMES_A_STEP || motions.is_empty() || !motions.len().is_multiple_of(motion) {
            let expected = format!("motions of {frames} x {} numbers", self.columns);
            return Err(Error::input("Motions", expected, motions.len()));
        }
        let shape = [motions.len() / motion, frames, self.columns];
        let motions = tensor(motions.to_vec(), shape, device).narrow(2, 0, self.columns - UNSEEN);
        Ok(self.movement_encoder.forward(motions, dropout))
    }

    /// Points of motions `[motions][frames][columns]`, of which each has `lengths` frames.
    ///
    /// # Errors
    /// [`Error::Input`] when the numbers are no whole motions, or a length is below 4 or above
    /// `frames`.
    pub(super) fn forward(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
        device: &Device,
        dropout: &Dropout,
    ) -> Result<Tensor<2>, Error> {
        let movement = self.movement(motions, frames, device, dropout)?;
        let [batch, steps, _] = movement.dims();
        if lengths.len() != batch {
            let expected = format!("{batch}, one a motion");
            return Err(Error::input("Lengths", expected, lengths.len()));
        }
        let possible = FRAMES_A_STEP..=steps * FRAMES_A_STEP;
        if let Some(length) = lengths.iter().find(|length| !possible.contains(length)) {
            let expected = format!("{} to {} frames", possible.start(), possible.end());
            return Err(Error::input("Length of a motion", expected, length));
        }
        let steps: Vec<usize> = lengths
            .iter()
            .map(|length| length / FRAMES_A_STEP)
            .collect();
        Ok(self.motion_encoder.forward(movement, &steps))
    }
}

/// Rows of a tensor as points.
pub(super) fn points(embeddings: Tensor<2>) -> Result<Points, Error> {
    let width = embeddings.dims()[1];
    let values = numbers(embeddings)?.into_iter().map(f64::from);
    Points::new(width, values.collect())
}
