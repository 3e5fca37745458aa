//! A Gaussian filter over time.

use glam::{DVec3, Vec3};

/// Convolves with a Gaussian of `sigma` frames, cut off at 4 sigma; the ends are held.
///
/// Equals `scipy.ndimage.gaussian_filter1d(values, sigma, axis=0, mode="nearest")`, which sums in
/// 64 bits.
pub(super) fn gaussian(values: &[Vec3], sigma: f64) -> Vec<Vec3> {
    let radius = (4.0 * sigma + 0.5) as usize;
    let weight = |distance: usize| (-0.5 * (distance as f64 / sigma).powi(2)).exp();
    let weights: Vec<f64> = (0..=radius).map(weight).collect();
    let total = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    let Some(last) = values.len().checked_sub(1) else {
        return Vec::new();
    };
    let at = |frame: usize| values[frame.min(last)].as_dvec3();
    let smooth = |frame: usize| {
        let sides = weights.iter().enumerate().skip(1);
        let sum = sides.fold(weights[0] * at(frame), |sum: DVec3, (distance, &weight)| {
            sum + weight * (at(frame.saturating_sub(distance)) + at(frame + distance))
        });
        (sum / total).as_vec3()
    };
    (0..values.len()).map(smooth).collect()
}
