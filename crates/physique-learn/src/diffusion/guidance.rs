//! Classifier-free guidance.

use burn::tensor::Tensor;

use crate::Error;

/// What a network predicts with its condition, pushed away from what it predicts without: Ho and
/// Salimans, "Classifier-Free Diffusion Guidance", 2021.
///
/// `predict(true)` predicts with the condition, `predict(false)` without. A `scale` of 1 is the
/// condition alone, 0 none of it; both take one prediction, all others two. MDM's is 2.5.
///
/// # Errors
/// Those of `predict`.
pub fn guide(
    scale: f64,
    mut predict: impl FnMut(bool) -> Result<Tensor<3>, Error>,
) -> Result<Tensor<3>, Error> {
    if scale == 1.0 {
        return predict(true);
    }
    let without = predict(false)?;
    if scale == 0.0 {
        return Ok(without);
    }
    let with = predict(true)?;
    Ok(without.clone() + (with - without) * scale)
}
