//! The recipe of a fit.

use serde::{Deserialize, Serialize};

use super::SphereLossWeights;
use super::blocks::BLOCK_POINTS;
use crate::Error;

/// How a proxy is fitted to a body; the default is the paper's recipe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FitOptions {
    /// Number of spheres: 128, 192 and 256 in the paper.
    pub spheres: usize,
    /// Betas are drawn uniformly from plus and minus this. The paper draws from 5 for SMPL-H; the
    /// open body's shapes stop looking human beyond 3, which already gives 1.4 to 2.0 m and a body
    /// mass index of 10 to 48.
    pub beta_range: f32,
    /// Bodies that the spheres are fitted to.
    pub sphere_bodies: usize,
    /// Bodies that the joints are fitted to.
    pub joint_bodies: usize,
    /// Points in the unit ball, a body.
    pub ball_points: usize,
    /// Points near the surface, a body: half of them inside.
    pub surface_points: usize,
    /// Points that a body shows in one step: 16,384 in the paper, or that divided by a whole number.
    pub step_points: usize,
    /// Bodies in one step.
    pub batch: usize,
    /// Passes over the bodies for the spheres.
    pub sphere_epochs: usize,
    /// First learning rate of the spheres; halved four times, after equal parts of the passes.
    pub sphere_rate: f32,
    /// Passes over the bodies for the joints.
    pub joint_epochs: usize,
    /// First learning rate of the joints; divided by ten after each third of the passes.
    pub joint_rate: f32,
    /// Width of the networks' hidden layers.
    pub width: usize,
    /// Weights of the losses.
    pub losses: SphereLossWeights,
    /// Fits with equal seeds and bodies are equal.
    pub seed: u64,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            spheres: 192,
            beta_range: 3.0,
            sphere_bodies: 800,
            joint_bodies: 8_000,
            ball_points: 250_000,
            surface_points: 500_000,
            step_points: 16_384,
            batch: 64,
            sphere_epochs: 2_800,
            sphere_rate: 5e-4,
            joint_epochs: 300,
            joint_rate: 1e-4,
            width: 512,
            losses: SphereLossWeights::default(),
            seed: 10,
        }
    }
}

impl FitOptions {
    /// # Errors
    /// [`Error::FitOptions`] with the first option that cannot be.
    pub fn check(&self) -> Result<(), Error> {
        let counts = [
            ("spheres", self.spheres, 4_096),
            ("bodies for the spheres", self.sphere_bodies, 1 << 20),
            ("bodies for the joints", self.joint_bodies, 1 << 20),
            ("points in the ball", self.ball_points, 1 << 26),
            ("points near the surface", self.surface_points, 1 << 26),
            ("points a step", self.step_points, 1 << 22),
            ("bodies a step", self.batch, 1 << 14),
            ("epochs for the spheres", self.sphere_epochs, 1 << 24),
            ("epochs for the joints", self.joint_epochs, 1 << 24),
            ("width of the networks", self.width, 8_192),
        ];
        for (what, found, most) in counts {
            if !(1..=most).contains(&found) {
                return Err(Error::FitOptions {
                    what,
                    expected: format!("1 to {most}"),
                    found: found.to_string(),
                });
            }
        }
        let SphereLossWeights {
            signed_distance,
            emptiness,
            overlap,
            tolerance,
        } = self.losses;
        for (what, found) in [
            ("the range of betas", self.beta_range),
            ("the learning rate of the spheres", self.sphere_rate),
            ("the learning rate of the joints", self.joint_rate),
            ("the weight of signed distances", signed_distance),
            ("the weight of emptiness", emptiness),
            ("the weight of overlap", overlap),
            ("the tolerance of emptiness", tolerance),
        ] {
            if !(found.is_finite() && found >= 0.0) {
                return Err(Error::FitOptions {
                    what,
                    expected: "a finite number of at least 0".into(),
                    found: found.to_string(),
                });
            }
        }
        if !BLOCK_POINTS.is_multiple_of(self.step_points) {
            return Err(Error::FitOptions {
                what: "points a step",
                expected: format!("a divisor of {BLOCK_POINTS}"),
                found: self.step_points.to_string(),
            });
        }
        let fewest = Shares::BLOCK;
        if self.ball_points < fewest.ball || self.surface_points < 2 * fewest.detail {
            return Err(Error::FitOptions {
                what: "points a body",
                expected: format!(
                    "at least {} in the ball and {} near the surface",
                    fewest.ball,
                    2 * fewest.detail
                ),
                found: format!("{} and {}", self.ball_points, self.surface_points),
            });
        }
        Ok(())
    }

    /// One of how many points of a block a step shows.
    pub(crate) fn thinning(&self) -> usize {
        BLOCK_POINTS / self.step_points
    }
}

/// Points of each kind in one block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shares {
    /// Anywhere in the unit ball.
    pub(crate) ball: usize,
    /// Near the surface of hands and feet.
    pub(crate) detail: usize,
    /// Near the rest of the surface, half of them inside.
    pub(crate) surface: usize,
}

impl Shares {
    /// As the paper's steps.
    pub(crate) const BLOCK: Self = {
        let ball = BLOCK_POINTS / 10;
        let detail = (BLOCK_POINTS - ball) / 2;
        Self {
            ball,
            detail,
            surface: BLOCK_POINTS - ball - detail,
        }
    };
}
