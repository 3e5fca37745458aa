//! The zero moment point inside the base of support.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::zero_moment::ZeroMoment;
use super::{FrameLoss, Window};
use crate::TimeFilter;
use crate::balance::on_ground;
use crate::soles::SOLE_POINTS;

/// How far the zero moment point is outside the soles that ought to stand:
/// `s log(1 + exp((d + margin) / s))` of the signed distance d, in metres.
///
/// The distance is `max_k n_k . z - h(n_k)` over 64 directions n, with the smooth support function
/// `h(n) = log(sum_i w_i exp(b n . p_i)) / b` of the sole points p with contact weights w; at most
/// 0.12 % below the true one. Frames near the ends, without contact, or with hardly any load have
/// no term.
#[derive(Clone, Debug, PartialEq)]
pub struct SupportedBalance<'a> {
    /// Height of the ground, in metres.
    pub ground: f64,
    /// Derivatives over time.
    pub filter: TimeFilter,
    /// `[frames][12]` contact weights of the sole points, flat: given, without gradient.
    pub contacts: &'a [f64],
    /// How far inside the point ought to be, in metres.
    pub margin: f64,
    /// Width of the step from free to full cost, in metres.
    pub softness: f64,
}

/// Directions of the support function.
pub(crate) const DIRECTIONS: usize = 64;
/// How sharply the support function picks its farthest point, per metre.
pub(crate) const SHARPNESS: f64 = 200.0;
/// Less contact than this is none.
pub(crate) const LEAST_CONTACT: f64 = 0.5;

/// The unit directions.
pub(crate) fn directions() -> impl Iterator<Item = DVec2> {
    (0..DIRECTIONS).map(|k| DVec2::from_angle(TAU * k as f64 / DIRECTIONS as f64))
}

/// Smooth support function of weighted points.
pub(crate) fn support(points: &[DVec2], weights: &[f64], direction: DVec2) -> f64 {
    let along = || points.iter().map(|p| direction.dot(*p));
    // Shifted by the farthest: no exponential overflows.
    let farthest = along().fold(f64::MIN, f64::max);
    let sum: f64 = along()
        .zip(weights)
        .map(|(along, weight)| weight * (SHARPNESS * (along - farthest)).exp())
        .sum();
    farthest + sum.ln() / SHARPNESS
}

/// Signed distance of a point to smoothly supported points, and the direction that decides.
pub(crate) fn signed_distance(
    point: DVec2,
    points: &[DVec2],
    weights: &[f64],
) -> Option<(f64, DVec2)> {
    directions()
        .map(|n| (n.dot(point) - support(points, weights, n), n))
        .max_by(|a, b| a.0.total_cmp(&b.0))
}

impl FrameLoss for SupportedBalance<'_> {
    fn reach(&self) -> usize {
        self.filter.reach()
    }

    fn term(&self, window: &mut Window<'_>, scale: f64) -> f64 {
        let begin = window.frame * SOLE_POINTS;
        let Some(weights) = self.contacts.get(begin..begin + SOLE_POINTS) else {
            return 0.0;
        };
        if weights.iter().sum::<f64>() < LEAST_CONTACT {
            return 0.0;
        }
        let points: [DVec2; SOLE_POINTS] =
            std::array::from_fn(|point| on_ground(window.skin_point(0, point)));
        let Some(zero_moment) = ZeroMoment::new(window, &self.filter, self.ground) else {
            return 0.0;
        };
        let Some((distance, normal)) = signed_distance(zero_moment.point, &points, weights) else {
            return 0.0;
        };
        let (value, slope) = softplus((distance + self.margin) / self.softness);
        let slope = slope * scale;
        zero_moment.backward(window, normal * slope);
        let reached = support(&points, weights, normal);
        for (index, (point, weight)) in points.iter().zip(weights).enumerate() {
            let share = weight * (SHARPNESS * (normal.dot(*point) - reached)).exp();
            if share > 0.0 {
                let gradient = normal * (-share * slope);
                window.add_skin_gradient(0, index, DVec3::new(gradient.x, 0.0, gradient.y));
            }
        }
        self.softness * value
    }
}

/// `log(1 + exp(x))` and its derivative, for any x.
pub(crate) fn softplus(x: f64) -> (f64, f64) {
    (
        x.max(0.0) + (-x.abs()).exp().ln_1p(),
        1.0 / (1.0 + (-x).exp()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smooth_distance_is_near_the_golden_one_over_64_directions() {
        let golden: serde_json::Value =
            serde_json::from_str(include_str!("../../tests/fixtures/physics.json")).unwrap();
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let number = |value: &serde_json::Value| value.as_f64().unwrap();
        for case in golden["bos_support_K64"].as_array().unwrap() {
            let point = DVec2::new(number(&case["p"][0]), number(&case["p"][1]));
            let (found, normal) = signed_distance(point, &square, &[1.0; 4]).unwrap();
            // The golden support is sharp; two corners that share an edge push a smooth one out.
            let pushed_out = 2.0_f64.ln() / SHARPNESS;
            let expected = number(&case["d"]);
            assert!(found <= expected + 1e-12 && found >= expected - 1.001 * pushed_out);
            assert!((normal.length() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn softplus_never_overflows() {
        assert_eq!(softplus(1e6), (1e6, 1.0));
        assert_eq!(softplus(-1e6), (0.0, 0.0));
        assert!((softplus(0.0).0 - 2.0_f64.ln()).abs() < 1e-15);
    }
}
