//! The bodies that a proxy is fitted to and measured on.

use std::sync::Arc;

use glam::Vec3;
use physique_body::{Body, BodyModel};
use physique_geometry::sia::UnitBall;

use crate::Error;
use crate::random::Random;

/// What a drawn shape is for; each purpose has its own shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// To fit spheres to.
    Spheres = 0,
    /// To fit joints to.
    Joints = 1,
    /// To derive blend weights from.
    BlendWeights = 2,
    /// To measure on, never fitted to.
    HeldOut = 3,
}

/// Betas of shape number `index`.
pub(crate) fn betas(
    purpose: Purpose,
    index: usize,
    model: &BodyModel,
    range: f32,
    seed: u64,
) -> Vec<f32> {
    let mut random = Random::new(&[seed, purpose as u64, index as u64]);
    (0..model.beta_count().min(BETAS))
        .map(|_| random.within(range))
        .collect()
}

/// Betas that a proxy reads, as in the paper; models with more keep the others at 0.
pub(crate) const BETAS: usize = 10;

/// A rest body in the unit ball.
#[derive(Clone, Debug)]
pub(crate) struct NormalisedBody {
    pub(crate) body: Body,
    pub(crate) ball: UnitBall,
    /// `[vertices]` in the ball.
    pub(crate) vertices: Vec<Vec3>,
}

impl NormalisedBody {
    pub(crate) fn new(model: &Arc<BodyModel>, betas: &[f32]) -> Result<Self, Error> {
        let body = Body::new(Arc::clone(model), betas)?;
        let ball = UnitBall::around(body.rest_vertices())?;
        let vertices = body
            .rest_vertices()
            .iter()
            .map(|&vertex| ball.ball_from_world(vertex))
            .collect();
        Ok(Self {
            body,
            ball,
            vertices,
        })
    }
}
