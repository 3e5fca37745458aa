//! The true frame rate, from jumps: in flight every body falls by gravity.
//!
//! Told at `stated` frames a second, a motion recorded at `true` ones falls by
//! `g (stated / true)^2`. Rises of the lowest skin above ground whose centre of mass follows a
//! parabola are flights; walking on tiptoe or being held follows none.

use physique_physics::{FramePhysics, GRAVITY};

use super::{Defect, DefectKind, DefectLimits};

/// The lowest skin is higher than this above ground all the while, in metres,
const CLEAR_M: f64 = 0.03;
/// and at its highest above this.
const TOP_M: f64 = 0.1;
/// The centre of mass rises and falls by at least this much, in metres,
const LEAST_SAG_M: f64 = 0.03;
/// and differs from a parabola by at most this part of it.
const MISFIT: f64 = 0.05;
/// Fewer frames have no shape.
const LEAST_FRAMES: usize = 5;

/// A frame rate at which bodies fall too fast or too slowly. `ground` is the height at which the
/// soles stand, above that from which the frames count.
pub(super) fn find(
    frames: &[FramePhysics],
    ground: f64,
    stated_fps: f64,
    limits: &DefectLimits,
) -> Option<Defect> {
    let mut falls = Vec::new();
    let mut begin = 0;
    for run in frames.chunk_by(|a, b| in_air(a, ground) == in_air(b, ground)) {
        let first = begin;
        begin += run.len();
        // A run cut off by an end of the clip is a flight all the same.
        if in_air(&run[0], ground)
            && let Some(fall) = fall(run, ground)
        {
            falls.push((first, fall * stated_fps * stated_fps));
        }
    }
    falls.sort_by(|a, b| a.1.total_cmp(&b.1));
    let &(first, fall) = falls.get(falls.len() / 2)?;
    let factor = (fall / GRAVITY).sqrt();
    if factor.max(1.0 / factor) <= limits.frame_rate_factor {
        return None;
    }
    let message = format!(
        "In flight the body falls by {fall:.1} m/s2: the true frame rate is probably about {:.0} a \
         second, not {stated_fps:.0}.",
        stated_fps / factor
    );
    Some(Defect::measured(
        DefectKind::FrameRate,
        message,
        Some(first as f64 / stated_fps),
        factor,
        limits.frame_rate_factor,
    ))
}

fn in_air(frame: &FramePhysics, ground: f64) -> bool {
    frame.lowest_m - ground > CLEAR_M
}

/// Downward acceleration of a flight in metres a frame squared; `None` for what is no flight.
fn fall(run: &[FramePhysics], ground: f64) -> Option<f64> {
    let top = run.iter().map(|frame| frame.lowest_m - ground);
    if run.len() < LEAST_FRAMES || top.fold(f64::MIN, f64::max) < TOP_M {
        return None;
    }
    let heights: Vec<f64> = run.iter().map(|frame| frame.centre_of_mass.y).collect();
    let parabola = Parabola::fit(&heights);
    let sag = -parabola.quadratic * (heights.len() as f64).powi(2) / 4.0;
    (sag > LEAST_SAG_M && parabola.misfit < MISFIT * sag).then_some(-2.0 * parabola.quadratic)
}

/// Least-squares parabola through evenly spaced values.
struct Parabola {
    /// Coefficient of the squared index.
    quadratic: f64,
    /// Root mean square of what is left.
    misfit: f64,
}

impl Parabola {
    /// By the first three discrete orthogonal (Gram) polynomials over a middle index of 0.
    fn fit(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let middle = (count - 1.0) / 2.0;
        let spread = (count * count - 1.0) / 12.0;
        let basis: [&dyn Fn(f64) -> f64; 3] = [&|_| 1.0, &|t| t, &|t| t * t - spread];
        let indexed = || {
            values
                .iter()
                .enumerate()
                .map(|(i, v)| (i as f64 - middle, *v))
        };
        let coefficients = basis.map(|basis| {
            let along: f64 = indexed().map(|(t, value)| basis(t) * value).sum();
            let norm: f64 = indexed().map(|(t, _)| basis(t).powi(2)).sum();
            along / norm
        });
        let left = indexed().map(|(t, value)| {
            let fitted = basis
                .iter()
                .zip(coefficients)
                .map(|(basis, c)| c * basis(t));
            (value - fitted.sum::<f64>()).powi(2)
        });
        Self {
            quadratic: coefficients[2],
            misfit: (left.sum::<f64>() / count).sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_found_and_a_corner_is_none() {
        let fall = |t: f64| 1.0 + 0.3 * t - 0.02 * t * t;
        let values: Vec<f64> = (0..12).map(|i| fall(f64::from(i))).collect();
        let found = Parabola::fit(&values);
        assert!((found.quadratic + 0.02).abs() < 1e-12 && found.misfit < 1e-12);
        let corner: Vec<f64> = (0..13).map(|i| -0.1 * f64::from(i - 6).abs()).collect();
        assert!(Parabola::fit(&corner).misfit > 0.03);
    }
}
