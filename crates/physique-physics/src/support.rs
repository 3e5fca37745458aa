//! What carries the body in each frame: the ground, nothing while it flies, or nothing at all.

use crate::balance::GRAVITY;

/// What carries the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Support {
    /// Slow skin touches the ground.
    Ground,
    /// Nothing touches, and the centre of mass falls as free bodies do.
    Flight,
    /// Nothing touches, yet the body does not fall: it floats, or only slides along.
    Nothing,
}

/// Curvature of a flight is looked at over at least this long, in seconds.
const LEAST_WINDOW: f64 = 0.1;
/// Nothing is said of fewer frames than this.
const LEAST_FRAMES: usize = 4;
/// Falling faster than this part of gravity is flight: contacts found a little late or early, and
/// noise, take their share from a perfect 1.
const FLIGHT: f64 = 0.5;

/// Tells flight from floating: every run of frames without contact flies when the parabola fitted
/// to its heights of the centre of mass falls with more than half of gravity.
pub(crate) fn classify(touching: &[bool], centre_heights: &[f64], frame_s: f64) -> Vec<Support> {
    let mut support = Vec::with_capacity(touching.len());
    for run in touching.chunk_by(|a, b| a == b) {
        let begin = support.len();
        let end = begin + run.len();
        let kind = if run[0] {
            Support::Ground
        } else {
            let window = (LEAST_WINDOW / frame_s).ceil() as usize + 1;
            let missing = window.max(LEAST_FRAMES).saturating_sub(run.len());
            let from = begin.saturating_sub(missing.div_ceil(2));
            let to = (end + missing.div_ceil(2)).min(touching.len());
            match curvature(&centre_heights[from..to], frame_s) {
                Some(fall) if fall < -FLIGHT * GRAVITY => Support::Flight,
                _ => Support::Nothing,
            }
        };
        support.resize(end, kind);
    }
    support
}

/// Second derivative of the parabola fitted to evenly spaced values.
fn curvature(values: &[f64], step: f64) -> Option<f64> {
    let count = values.len() as f64;
    if values.len() < 3 {
        return None;
    }
    // The quadratic of the discrete orthogonal (Gram) polynomials over t = -m..m.
    let middle = (count - 1.0) / 2.0;
    let mean_square = (count * count - 1.0) / 12.0;
    let quadratic = |index: usize| (index as f64 - middle).powi(2) - mean_square;
    let along: f64 = values
        .iter()
        .enumerate()
        .map(|(i, v)| quadratic(i) * v)
        .sum();
    let norm: f64 = (0..values.len()).map(|i| quadratic(i).powi(2)).sum();
    Some(2.0 * along / norm / (step * step))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_has_its_curvature() {
        let values: Vec<_> = (0..9)
            .map(|i| 2.0 - 1.5 * f64::from(i) - 4.9 * f64::from(i * i))
            .collect();
        assert!((curvature(&values, 1.0).unwrap() + 9.8).abs() < 1e-12);
        assert!((curvature(&values[..4], 0.5).unwrap() + 39.2).abs() < 1e-12);
    }

    #[test]
    fn jumps_fly_and_hovering_does_not() {
        let step = 0.05;
        let jump: Vec<_> = (0..20)
            .map(|i| {
                let t = (f64::from(i) - 9.5) * step;
                (1.2 - GRAVITY * t * t / 2.0).max(1.0)
            })
            .collect();
        let touching: Vec<_> = jump.iter().map(|&height| height <= 1.0).collect();
        let support = classify(&touching, &jump, step);
        assert!(support.contains(&Support::Flight) && !support.contains(&Support::Nothing));
        let hovering = classify(&[false; 20], &[1.0; 20], step);
        assert_eq!(hovering, [Support::Nothing; 20]);
    }
}
