//! One body's betas through a network.

use super::{Activations, Network};
use crate::Error;

/// What each layer gives for one shape; missing betas are 0.
pub(super) fn of_betas(network: &Network, betas: &[f32]) -> Result<Activations, Error> {
    let available = network.layout().input_count();
    if betas.len() > available || !betas.iter().all(|beta| beta.is_finite()) {
        return Err(Error::Betas {
            available,
            found: format!("{betas:?}"),
        });
    }
    let mut inputs = betas.to_vec();
    inputs.resize(available, 0.0);
    let mut activations = Activations::default();
    network.forward(&inputs, 1, &mut activations);
    Ok(activations)
}
