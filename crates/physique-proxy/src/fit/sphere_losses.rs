//! The losses that fit spheres to one body: equations 2 to 5 of the paper, fused.

mod clusters;
mod distance;
mod emptiness;
mod overlap;
mod spheres;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use clusters::Clusters;
pub(crate) use spheres::Spheres;

/// Points with their signed distances, structure of arrays.
#[derive(Clone, Debug, Default)]
pub(crate) struct SamplePoints {
    pub(crate) x: Vec<f32>,
    pub(crate) y: Vec<f32>,
    pub(crate) z: Vec<f32>,
    /// Signed distance to the body; negative inside.
    pub(crate) distance: Vec<f32>,
    /// Ends of stretches whose neighbours are neighbours in space.
    pub(crate) stretches: Vec<usize>,
}

impl SamplePoints {
    pub(crate) fn len(&self) -> usize {
        self.x.len()
    }

    pub(crate) fn clear(&mut self) {
        for values in [&mut self.x, &mut self.y, &mut self.z, &mut self.distance] {
            values.clear();
        }
        self.stretches.clear();
    }
}

/// Weights of the losses, and the depth at which a sphere counts as inside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SphereLossWeights {
    /// Of the signed-distance loss.
    pub signed_distance: f32,
    /// Of the emptiness loss.
    pub emptiness: f32,
    /// Of the spheres' overlap.
    pub overlap: f32,
    /// How far a sphere may stay away from all points inside the body. In the published training,
    /// not in the paper.
    pub tolerance: f32,
}

impl Default for SphereLossWeights {
    fn default() -> Self {
        Self {
            signed_distance: 1.0,
            emptiness: 10.0,
            overlap: 0.1,
            tolerance: 0.05,
        }
    }
}

/// The three losses, unweighted, of one body or the mean of many.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SphereLosses {
    /// Mean over points of `max(p, 0)` inside the body and `|d - p|` outside, where `d` is the
    /// signed distance to the body and `p` that to the spheres (equation 2).
    pub signed_distance: f64,
    /// Mean over spheres of what the nearest point inside the body is farther away than the
    /// tolerance (equation 4).
    pub emptiness: f64,
    /// Sum over pairs of how deep spheres overlap, over the squared number of spheres (equation 5).
    pub overlap: f64,
}

impl SphereLosses {
    /// The weighted sum (equation 6).
    pub fn total(&self, weights: &SphereLossWeights) -> f64 {
        f64::from(weights.signed_distance) * self.signed_distance
            + f64::from(weights.emptiness) * self.emptiness
            + f64::from(weights.overlap) * self.overlap
    }
}

/// Scratch space for the losses of one body after the other; one a task.
#[derive(Debug, Default)]
pub(crate) struct LossWorkspace {
    pub(crate) points: SamplePoints,
    clusters: Clusters,
    spheres: Spheres,
    /// `[spheres]` slopes by x, y, z and radius.
    slopes: Vec<[f32; 4]>,
    candidates: Vec<[f32; 4]>,
    numbers: Vec<u32>,
    gaps: Vec<f32>,
}

impl LossWorkspace {
    /// Losses of the workspace's points and one row of the regressor's outputs, `[log r, x, y, z]`
    /// a sphere. `gradient` is overwritten by that of the weighted sum, laid out as the row.
    ///
    /// Exact, but cheap: points go by clusters of neighbours, and only spheres that can be nearest
    /// to a point of the cluster are looked at.
    pub(crate) fn evaluate(
        &mut self,
        outputs: &[f32],
        weights: &SphereLossWeights,
        gradient: &mut [f32],
    ) -> SphereLosses {
        self.spheres.set(outputs);
        self.clusters.set(&self.points);
        self.slopes.clear();
        self.slopes.resize(self.spheres.len(), [0.0; 4]);
        let losses = SphereLosses {
            signed_distance: self.signed_distance(weights.signed_distance),
            emptiness: self.emptiness(weights.emptiness, weights.tolerance),
            overlap: overlap::add(&self.spheres, weights.overlap, &mut self.slopes),
        };
        let rows = gradient.as_chunks_mut::<4>().0.iter_mut();
        for ((row, &[x, y, z, r]), radius) in rows.zip(&self.slopes).zip(self.spheres.radii()) {
            // The network gives the logarithm of the radius.
            *row = [r * radius, x, y, z];
        }
        losses
    }
}
