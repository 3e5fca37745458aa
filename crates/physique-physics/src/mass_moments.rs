//! Mass, first and second moments of skinned points: exact sums at the cost of the skeleton.
//!
//! A skinned point is `p_k = sum_j w_kj T_j x_k` with the rest position `x_k = (x, y, z, 1)`. So
//! `sum_k m_k p_k = sum_j T_j mu_j` with `mu_j = sum_k m_k w_kj x_k`, and
//! `sum_k m_k p_k q_k^T = sum_jl T_j M_jl U_l^T` with `M_jl = sum_k m_k w_kj w_kl x_k x_k^T` for
//! any other points `q_k` skinned by `U`: velocities and accelerations are those, by the time
//! derivatives of the transforms. Points enter once a body, not once a frame.

use glam::{DMat4, DVec3, DVec4};

use crate::MassPoints;

/// Moments of a body's mass points, by joint and pair of joints that share points.
#[derive(Clone, Debug, PartialEq)]
pub struct MassMoments {
    pub(crate) mass: f64,
    /// `mu_j`.
    pub(crate) first: Vec<DVec4>,
    /// `(j, l, M_jl)`, ordered pairs.
    pub(crate) second: Vec<(usize, usize, DMat4)>,
}

impl MassMoments {
    /// Sums the points once.
    pub(crate) fn new(points: &MassPoints) -> Self {
        let joints = (0..points.masses().len())
            .flat_map(|point| points.weights(point))
            .map(|&(joint, _)| joint + 1)
            .max()
            .unwrap_or(0);
        let mut first = vec![DVec4::ZERO; joints];
        let mut second = vec![None; joints * joints];
        for (point, (&rest, &mass)) in points.positions().iter().zip(points.masses()).enumerate() {
            let rest = rest.extend(1.0);
            let squares =
                DMat4::from_cols(rest * rest.x, rest * rest.y, rest * rest.z, rest * rest.w) * mass;
            for &(j, weight) in points.weights(point) {
                first[j] += rest * (mass * weight);
                for &(l, other) in points.weights(point) {
                    *second[j * joints + l].get_or_insert(DMat4::ZERO) +=
                        squares * (weight * other);
                }
            }
        }
        Self {
            mass: points.masses().iter().sum(),
            first,
            second: second
                .into_iter()
                .enumerate()
                .filter_map(|(pair, moment)| Some((pair / joints, pair % joints, moment?)))
                .collect(),
        }
    }

    /// Total mass, in kg.
    pub const fn mass(&self) -> f64 {
        self.mass
    }

    /// `[joints]` first moments `sum_k m_k w_kj (x_k, 1)`: of `world_from_rest` of a joint, its part
    /// of the mass times where that is.
    pub fn first(&self) -> &[DVec4] {
        &self.first
    }

    /// Mean of the posed points by mass: of `world_from_rest` the centre of mass, of its
    /// derivatives the centre's velocity and acceleration.
    pub fn mean(&self, transforms: &[DMat4]) -> DVec3 {
        let sum: DVec4 = transforms
            .iter()
            .zip(&self.first)
            .map(|(&transform, &moment)| transform * moment)
            .sum();
        sum.truncate() / self.mass
    }

    /// `sum_k m_k p_k x q_k` about the origin, with the points `p` posed by `transforms` and `q`
    /// by `others`: the angular momentum where `others` are the first derivatives, its rate where
    /// they are the second ones.
    pub fn moment_about_origin(&self, transforms: &[DMat4], others: &[DMat4]) -> DVec3 {
        let mut sum = DMat4::ZERO;
        // Pairs come ordered by their first joint.
        for pairs in self.second.chunk_by(|a, b| a.0 == b.0) {
            let inner = pairs
                .iter()
                .fold(DMat4::ZERO, |inner, &(_, other, moment)| {
                    inner + moment * others[other].transpose()
                });
            sum += transforms[pairs[0].0] * inner;
        }
        let entry = |row: usize, column: usize| sum.col(column)[row];
        DVec3::new(
            entry(1, 2) - entry(2, 1),
            entry(2, 0) - entry(0, 2),
            entry(0, 1) - entry(1, 0),
        )
    }

    /// [`MassMoments::moment_about_origin`] about the centre of mass instead.
    pub fn moment_about_centre(&self, transforms: &[DMat4], others: &[DMat4]) -> DVec3 {
        self.moment_about_origin(transforms, others)
            - self.mass * self.mean(transforms).cross(self.mean(others))
    }
}
