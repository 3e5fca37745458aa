//! From betas to joints.

use glam::Vec3;
use physique_body::Joint;

use super::betas::of_betas;
use super::{Network, NetworkLayout};
use crate::Error;

/// The joint regressor: betas to the 22 rest joints in the paper's normalised unit, for those who
/// have a proxy but no body model. 0.3 million parameters at the paper's width of 512.
#[derive(Clone, Debug)]
pub struct JointRegressor {
    network: Network,
}

impl JointRegressor {
    /// Width of the paper's hidden layers.
    pub const WIDTH: usize = 512;

    /// The published layout: names and shapes of all parameters.
    ///
    /// # Errors
    /// [`Error::Regressor`] for no betas or a width of 0, more than 1,024 betas, or a width above
    /// 8,192.
    pub fn layout(betas: usize, width: usize) -> Result<NetworkLayout, Error> {
        if !(1..=1024).contains(&betas) || !(1..=8192).contains(&width) {
            return Err(Error::Regressor {
                array: "the joint regressor".into(),
                expected: "1 to 1,024 betas and a width of 1 to 8,192".into(),
                found: format!("{betas} betas, width {width}"),
            });
        }
        Ok(NetworkLayout::new()
            .linear("linear_stack.0", betas, width, false)
            .linear("linear_stack.2", width, width, false)
            .linear("linear_stack.4", width, 3 * Joint::COUNT, false))
    }

    /// A layout of [`JointRegressor::layout`] with its parameters, in the layout's order.
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

    /// Number of betas that it reads.
    pub fn beta_count(&self) -> usize {
        self.network.layout().input_count()
    }

    /// The rest joints of one shape; missing betas are 0.
    ///
    /// # Errors
    /// [`Error::Betas`] for more betas than it reads, or for one that is not finite.
    pub fn joints(&self, betas: &[f32]) -> Result<[Vec3; Joint::COUNT], Error> {
        let activations = of_betas(&self.network, betas)?;
        let mut joints = [Vec3::ZERO; Joint::COUNT];
        for (joint, &position) in joints.iter_mut().zip(activations.outputs().as_chunks().0) {
            *joint = Vec3::from_array(position);
        }
        Ok(joints)
    }
}
