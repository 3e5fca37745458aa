//! MDM's geometric losses, of motions that are rotations: equations 3 to 5 of Tevet et al., 2023.
//!
//! Its models of features are trained without them, those of actions with all three at weight 1.

use burn::tensor::Tensor;

use super::RotationSkeleton;
use super::losses::FrameMask;
use crate::Error;

/// Ankles and feet of SMPL.
const FEET: [usize; 4] = [7, 10, 8, 11];
/// A foot that moves less than this from one frame to the next stands, in metres.
const STANDS: f64 = 0.01;

/// `lambda_vel`: the squared error of how rotations change from frame to frame, `[batch]`; the root's
/// path does not count.
///
/// # Errors
/// [`Error::Input`] when motions have no two frames.
pub fn rotation_velocity_error(
    skeleton: &RotationSkeleton,
    predicted: Tensor<3>,
    clean: Tensor<3>,
    mask: &FrameMask,
) -> Result<Tensor<1>, Error> {
    let mask = mask.of_steps()?;
    let columns = 6 * skeleton.joints();
    let error = (predicted - clean).narrow(2, 0, columns);
    Ok(mask.mean(steps(error).square(), columns))
}

/// `lambda_rcxyz`: the squared error of joints' positions, `[batch]`, in square metres; both are
/// [`RotationSkeleton::positions`].
pub fn joint_error(predicted: Tensor<4>, clean: Tensor<4>, mask: &FrameMask) -> Tensor<1> {
    let columns = predicted.dims()[2] * 3;
    mask.mean(flat(predicted - clean).square(), columns)
}

/// `lambda_fc`: how far ankles and feet move from frame to frame that stand in the clean motion, their
/// square in square metres, `[batch]`; both are [`RotationSkeleton::positions`].
///
/// # Errors
/// [`Error::Input`] when motions have no two frames.
pub fn foot_contact_error(
    predicted: Tensor<4>,
    clean: Tensor<4>,
    mask: &FrameMask,
) -> Result<Tensor<1>, Error> {
    let mask = mask.of_steps()?;
    let feet = |positions: Tensor<4>| {
        let feet = FEET.map(|joint| positions.clone().narrow(2, joint, 1));
        steps(flat(Tensor::cat(feet.to_vec(), 2)))
    };
    let (predicted, clean) = (feet(predicted), feet(clean));
    let [batch, frames, _] = clean.dims();
    let by_foot = [batch, frames, FEET.len(), 3];
    let squares = clean.detach().reshape(by_foot).square().sum_dim(3);
    let stands = squares.lower_equal_elem(STANDS * STANDS).float();
    let moved = predicted.reshape(by_foot).square() * stands;
    Ok(mask.mean(flat(moved), 3 * FEET.len()))
}

/// From each frame to the next.
fn steps(frames: Tensor<3>) -> Tensor<3> {
    let count = frames.dims()[1] - 1;
    frames.clone().narrow(1, 1, count) - frames.narrow(1, 0, count)
}

/// `[batch][frames][joints * 3]`.
fn flat(positions: Tensor<4>) -> Tensor<3> {
    let [batch, frames, joints, axes] = positions.dims();
    positions.reshape([batch, frames, joints * axes])
}
