//! What training makes small.

use std::ops::Range;

use burn::tensor::Tensor;

use crate::Error;
use crate::tensors::tensor;

/// Which frames of a batch count, and how much: each motion as much as any other.
#[derive(Clone, Debug)]
pub struct FrameMask {
    /// `[batch][frames][1]`: 1 within a motion, 0 behind its end.
    within: Tensor<3>,
    /// `[batch]`: frames of each motion.
    lengths: Tensor<1>,
}

impl FrameMask {
    /// Of motions of `lengths` frames, padded to `frames`, for tensors like `like`.
    pub fn new(lengths: &[usize], frames: usize, like: &Tensor<3>) -> Self {
        let device = like.device();
        let within = lengths
            .iter()
            .flat_map(|&length| (0..frames).map(move |frame| f32::from(u8::from(frame < length))));
        let shape = [lengths.len(), frames, 1];
        Self {
            within: tensor(within.collect(), shape, &device),
            lengths: tensor(
                lengths.iter().map(|&length| length as f32).collect(),
                [lengths.len()],
                &device,
            ),
        }
    }

    /// Which steps from one frame to the next count: those to frames within a motion.
    ///
    /// # Errors
    /// [`Error::Input`] when motions have no two frames.
    pub(super) fn of_steps(&self) -> Result<Self, Error> {
        let [_, frames, _] = self.within.dims();
        if frames < 2 {
            return Err(Error::input("Motions", "two frames or more", frames));
        }
        Ok(Self {
            within: self.within.clone().narrow(1, 1, frames - 1),
            lengths: self.lengths.clone() - 1.0,
        })
    }

    /// Squared differences of each motion, `[batch]`: their sum over frames within the motion,
    /// divided by the motion's frames and by `columns`.
    pub(super) fn mean(&self, squares: Tensor<3>, columns: usize) -> Tensor<1> {
        let sums = (squares * self.within.clone()).sum_dims_squeeze::<1, _>(&[1, 2]);
        // As published; no motion is without frames.
        sums / (self.lengths.clone() * columns as f64 + 1e-8)
    }
}

/// The squared error of features, `[batch]`: the published loss. `columns` weighs columns, where
/// not all weigh 1.
pub fn squared_error(
    predicted: Tensor<3>,
    clean: Tensor<3>,
    mask: &FrameMask,
    columns: Option<Tensor<3>>,
) -> Tensor<1> {
    let count = clean.dims()[2];
    let squares = (predicted - clean).square();
    let squares = match columns {
        Some(weights) => squares * weights,
        None => squares,
    };
    mask.mean(squares, count)
}

/// The squared error of differences between neighbouring frames in a block of columns, `[batch]`,
/// in units of `factor`.
///
/// # Errors
/// [`Error::Input`] when a motion has no two frames.
pub fn velocity_error(
    predicted: Tensor<3>,
    clean: Tensor<3>,
    mask: &FrameMask,
    columns: Range<usize>,
    factor: f64,
) -> Result<Tensor<1>, Error> {
    let [_, frames, _] = clean.dims();
    if frames < 2 {
        return Err(Error::input("Motions", "two frames or more", frames));
    }
    let error = (predicted - clean).narrow(2, columns.start, columns.len());
    let after = error.clone().narrow(1, 1, frames - 1);
    let before = error.narrow(1, 0, frames - 1);
    let squares = ((after - before) * factor).square();
    let mask = FrameMask {
        within: mask.within.clone().narrow(1, 1, frames - 1),
        lengths: mask.lengths.clone(),
    };
    Ok(mask.mean(squares, columns.len()))
}
