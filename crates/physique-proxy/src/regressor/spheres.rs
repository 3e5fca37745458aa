//! From betas to spheres.

use glam::Vec3;

use super::betas::of_betas;
use super::{Gradient, Network, NetworkLayout};
use crate::Error;

/// Spheres of one shape, in the paper's normalised unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RegressedSpheres {
    /// `[spheres]` centres.
    pub centres: Vec<Vec3>,
    /// `[spheres]` radii, above 0.
    pub radii: Vec<f32>,
}

/// The sphere regressor: betas to centres and radii.
///
/// DualSDF's decoder (Hao et al., CVPR 2020) read from betas: four weight-normalised layers with
/// rectifiers, the betas appended, four more, then a plain layer that gives `[log r, x, y, z]` a
/// sphere. 2.2 million parameters for 192 spheres at the paper's width of 512, each read once for a
/// shape: about a millisecond.
#[derive(Clone, Debug)]
pub struct SphereRegressor {
    network: Network,
}

impl SphereRegressor {
    /// Width of the paper's hidden layers.
    pub const WIDTH: usize = 512;

    /// The published layout: names and shapes of all parameters.
    ///
    /// # Errors
    /// [`Error::Regressor`] for no spheres or betas, for more than 4,096 spheres, 1,024 betas or a
    /// width above 8,192, or for layers no wider than the betas that are appended to one.
    pub fn layout(betas: usize, width: usize, spheres: usize) -> Result<NetworkLayout, Error> {
        if betas == 0 || width <= betas || spheres == 0 {
            return Err(Error::Regressor {
                array: "the sphere regressor".into(),
                expected: "betas, layers wider than the betas, and spheres".into(),
                found: format!("{betas} betas, width {width}, {spheres} spheres"),
            });
        }
        if betas > 1024 || width > 8192 || spheres > 4096 {
            return Err(Error::Regressor {
                array: "the sphere regressor".into(),
                expected: "at most 1,024 betas, width 8,192 and 4,096 spheres".into(),
                found: format!("{betas} betas, width {width}, {spheres} spheres"),
            });
        }
        Ok(NetworkLayout::new()
            .linear("net1.0", betas, width, true)
            .linear("net1.2", width, width, true)
            .linear("net1.4", width, width, true)
            .linear("net1.6", width, width - betas, true)
            .skip()
            .linear("net2.0", width, width, true)
            .linear("net2.2", width, width, true)
            .linear("net2.4", width, width, true)
            .linear("net2.6", width, width, true)
            .linear("net2.8", width, 4 * spheres, false))
    }

    /// A layout of [`SphereRegressor::layout`] with its parameters, in the layout's order.
    ///
    /// # Errors
    /// [`Error::Regressor`] unless there is one finite number a parameter.
    pub fn new(layout: NetworkLayout, parameters: Vec<f32>) -> Result<Self, Error> {
        let network = Network::new(layout, parameters)?;
        Ok(Self { network })
    }

    /// The network.
    pub fn network(&self) -> &Network {
        &self.network
    }

    pub(crate) fn network_mut(&mut self) -> &mut Network {
        &mut self.network
    }

    /// Number of spheres.
    pub fn sphere_count(&self) -> usize {
        self.network.layout().output_count() / 4
    }

    /// Number of betas that it reads.
    pub fn beta_count(&self) -> usize {
        self.network.layout().input_count()
    }

    /// The spheres of one shape; missing betas are 0.
    ///
    /// # Errors
    /// [`Error::Betas`] for more betas than it reads, or for one that is not finite.
    pub fn spheres(&self, betas: &[f32]) -> Result<RegressedSpheres, Error> {
        let activations = of_betas(&self.network, betas)?;
        let rows = activations.outputs().as_chunks::<4>().0.iter();
        let (radii, centres) = rows
            .map(|&[log_radius, x, y, z]| (log_radius.exp(), Vec3::new(x, y, z)))
            .unzip();
        Ok(RegressedSpheres { centres, radii })
    }

    /// Gradient of a loss by betas, from its gradient by centres and radii: for losses that a
    /// shape shall follow.
    ///
    /// # Errors
    /// As [`SphereRegressor::spheres`]; [`Error::Length`] unless there is one slope a sphere.
    pub fn betas_gradient(
        &self,
        betas: &[f32],
        centres: &[Vec3],
        radii: &[f32],
    ) -> Result<Vec<f32>, Error> {
        for (what, found) in [
            ("slopes of centres", centres.len()),
            ("slopes of radii", radii.len()),
        ] {
            let expected = self.sphere_count();
            if found != expected {
                return Err(Error::Length {
                    what,
                    expected,
                    found,
                });
            }
        }
        let activations = of_betas(&self.network, betas)?;
        let rows = activations.outputs().as_chunks::<4>().0.iter();
        let slopes: Vec<f32> = rows
            .zip(centres.iter().zip(radii))
            .flat_map(|([log_radius, ..], (centre, radius))| {
                [radius * log_radius.exp(), centre.x, centre.y, centre.z]
            })
            .collect();
        let mut gradient = Gradient::default();
        self.network
            .backward_inputs(&activations, &slopes, &mut gradient);
        gradient.inputs.truncate(betas.len());
        Ok(gradient.inputs)
    }
}
