//! Derivatives over time, of a bandwidth stated in Hz.
//!
//! A second difference over neighbouring frames means something else at every frame rate: 1 mm of
//! noise is 1 m/s2 at 20 fps and 35 m/s2 at 120. So the default is a filter in seconds: a quartic
//! fitted to the frames around, weighted by a Gaussian in time (a Savitzky-Golay filter with soft
//! ends). With `s = (omega sigma)^2 / 2` it passes the first and second derivatives by
//! `(1 + s) exp(-s)` to 2 % (the window ends at 4.5 sigma), at any frame rate that resolves sigma.
//!
//! Such a filter overshoots: some of its weights are negative. Where a derivative is compared with
//! a bound, [`TimeFilter::averaging`] does not: means of what keeps to the bound keep to it.

use physique_motion::FrameRate;

use crate::Error;

/// `sigma * cut-off`: where `(1 + s) exp(-s)` falls to 1/sqrt(2).
const SIGMA_HZ: f64 = 0.233_70;
/// The window ends at this many sigmas.
const WINDOW_SIGMAS: f64 = 4.5;
/// A narrower Gaussian than this many frames does not see its neighbours.
const LEAST_SIGMA_FRAMES: f64 = 0.7;
/// The same for an average: what is left beside the differences must still be a Gaussian.
const LEAST_AVERAGE_FRAMES: f64 = 0.8;
/// Beyond this the window would hold more frames than any motion.
const HIGHEST_RATE: f64 = 10_000.0;
/// `sigma * cut-off` of an average: where `exp(-s)` falls to 1/sqrt(2).
const AVERAGE_SIGMA_HZ: f64 = 0.132_505;
/// An average ends at this many sigmas: 0.05 % of the weights lie beyond.
const AVERAGE_SIGMAS: f64 = 3.5;
/// Coefficients of the fitted quartic.
const TERMS: usize = 5;
const FACTORIAL: [f64; 4] = [1.0, 1.0, 2.0, 6.0];

/// Taps on the frames `-reach..=reach` around a frame, for the value and three derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeFilter {
    reach: usize,
    cutoff_hz: f64,
    taps: [Vec<f64>; 4],
}

impl TimeFilter {
    /// The filter with this cut-off (-3 dB of first and second derivatives). At frame rates below
    /// about three times the cut-off, the cut-off falls with the frame rate;
    /// [`TimeFilter::cutoff_hz`] tells.
    ///
    /// # Errors
    /// [`Error::Option`] for a cut-off that is not between 0.1 and 50 Hz, or for more than 10,000
    /// frames a second.
    pub fn new(frame_rate: FrameRate, cutoff_hz: f64) -> Result<Self, Error> {
        let sigma_frames = sigma_frames(frame_rate, cutoff_hz, SIGMA_HZ)?.max(LEAST_SIGMA_FRAMES);
        let frame = frame_rate.frame_seconds();
        let sigma = sigma_frames * frame;
        let reach = ((WINDOW_SIGMAS * sigma_frames).round() as usize).max(2);
        // Time in sigmas: well conditioned for any rate.
        let times: Vec<_> = frames(reach).map(|k| k / sigma_frames).collect();
        let weights = times.iter().map(|t| (-t * t / 2.0).exp()).collect();
        Ok(Self {
            reach,
            cutoff_hz: SIGMA_HZ / sigma,
            taps: fit(&times, weights, TERMS, sigma),
        })
    }

    /// Gaussian means, -3 dB at this cut-off, of the plain differences of neighbouring frames: the
    /// response of a derivative is `exp(-s)`, at any frame rate that resolves sigma.
    ///
    /// All weights of order 0 and all weights on the differences are positive, and equal but for
    /// what a difference smooths by itself. A zero moment point from such derivatives is the mean
    /// of those around it: while they lie in their bases of support, it lies in the mean of these
    /// ([`SupportPolygon::mean`](crate::SupportPolygon::mean)).
    ///
    /// # Errors
    /// As [`TimeFilter::new`].
    pub fn averaging(frame_rate: FrameRate, cutoff_hz: f64) -> Result<Self, Error> {
        let sigma =
            sigma_frames(frame_rate, cutoff_hz, AVERAGE_SIGMA_HZ)?.max(LEAST_AVERAGE_FRAMES);
        let frame = frame_rate.frame_seconds();
        let reach = (AVERAGE_SIGMAS * sigma).ceil() as usize + 1;
        // A difference is itself a mean of the derivative over the frames it spans, of this
        // variance in frames: the Gaussian adds the rest.
        let difference = |taps: &[f64], variance: f64, order: i32| {
            let half = taps.len() / 2;
            let weights = gaussian(reach - half, (sigma * sigma - variance).sqrt());
            let mut means = vec![0.0; 2 * reach + 1];
            for (place, weight) in weights.iter().enumerate() {
                for (offset, tap) in taps.iter().enumerate() {
                    means[place + offset] += weight * tap / frame.powi(order);
                }
            }
            means
        };
        Ok(Self {
            reach,
            cutoff_hz: AVERAGE_SIGMA_HZ / (sigma * frame),
            taps: [
                gaussian(reach, sigma),
                difference(&[-0.5, 0.0, 0.5], 1.0 / 3.0, 1),
                difference(&[1.0, -2.0, 1.0], 1.0 / 6.0, 2),
                difference(&[-0.5, 1.0, 0.0, -1.0, 0.5], 1.0 / 2.0, 3),
            ],
        })
    }

    /// The second difference `[1, -2, 1] / h^2` of the released HUMOS, with the central first
    /// difference. Its bandwidth is that of the frame rate.
    pub fn second_difference(frame_rate: FrameRate) -> Self {
        Self::quadratic(frame_rate, 1)
    }

    /// The quadratic Savitzky-Golay filter over five frames.
    pub fn savitzky_golay_5(frame_rate: FrameRate) -> Self {
        Self::quadratic(frame_rate, 2)
    }

    fn quadratic(frame_rate: FrameRate, reach: usize) -> Self {
        let times: Vec<_> = frames(reach).collect();
        let weights = vec![1.0; times.len()];
        Self {
            reach,
            cutoff_hz: frame_rate.per_second() / 2.0,
            taps: fit(&times, weights, 3, frame_rate.frame_seconds()),
        }
    }

    /// Frames that the filter looks at on either side.
    pub const fn reach(&self) -> usize {
        self.reach
    }

    /// The cut-off in Hz; for the short filters, half the frame rate.
    pub const fn cutoff_hz(&self) -> f64 {
        self.cutoff_hz
    }

    /// `[2 reach + 1]` taps of the derivative of this order (0 to 3; 0 smooths).
    ///
    /// # Panics
    /// For a higher order.
    pub fn taps(&self, order: usize) -> &[f64] {
        &self.taps[order]
    }

    /// Whether `frame` of `count` has all its neighbours.
    pub const fn covers(&self, frame: usize, count: usize) -> bool {
        frame >= self.reach && frame + self.reach < count
    }
}

/// Width of a Gaussian in frames: `sigma_hz` over the cut-off.
fn sigma_frames(frame_rate: FrameRate, cutoff_hz: f64, sigma_hz: f64) -> Result<f64, Error> {
    if !(0.1..=50.0).contains(&cutoff_hz) {
        return Err(Error::Option {
            option: "cut-off of the time derivatives",
            expected: "0.1 to 50 Hz",
            found: cutoff_hz,
        });
    }
    if frame_rate.per_second() > HIGHEST_RATE {
        return Err(Error::Option {
            option: "frame rate of the motion",
            expected: "at most 10000 frames a second",
            found: frame_rate.per_second(),
        });
    }
    Ok(sigma_hz / cutoff_hz * frame_rate.per_second())
}

/// Weights that add up to 1 on the frames `-reach..=reach`.
fn gaussian(reach: usize, sigma: f64) -> Vec<f64> {
    let mut weights: Vec<_> = frames(reach)
        .map(|k| (-k * k / (2.0 * sigma * sigma)).exp())
        .collect();
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    weights
}

fn frames(reach: usize) -> impl Iterator<Item = f64> {
    (0..=2 * reach).map(move |k| k as f64 - reach as f64)
}

/// Taps of the derivatives at time 0 of the weighted least-squares polynomial of `terms`
/// coefficients: an orthogonal basis by Gram and Schmidt. `unit` is the unit of `times` in seconds.
fn fit(times: &[f64], weights: Vec<f64>, terms: usize, unit: f64) -> [Vec<f64>; 4] {
    let mut taps = std::array::from_fn(|_| vec![0.0; times.len()]);
    let mut basis: Vec<(Vec<f64>, [f64; TERMS], f64)> = Vec::new();
    for degree in 0..terms {
        let mut values: Vec<f64> = times.iter().map(|t| t.powi(degree as i32)).collect();
        let mut coefficients = [0.0; TERMS];
        coefficients[degree] = 1.0;
        // Twice: the second pass removes what rounding left of the first.
        for _ in 0..2 {
            for (other, other_coefficients, norm) in &basis {
                let share = dot(&values, other, &weights) / norm;
                values
                    .iter_mut()
                    .zip(other)
                    .for_each(|(v, o)| *v -= share * o);
                for (c, o) in coefficients.iter_mut().zip(other_coefficients) {
                    *c -= share * o;
                }
            }
        }
        let norm = dot(&values, &values, &weights);
        for (order, taps) in taps.iter_mut().enumerate().take(terms) {
            let scale = coefficients[order] * FACTORIAL[order] / norm / unit.powi(order as i32);
            for ((tap, value), weight) in taps.iter_mut().zip(&values).zip(&weights) {
                *tap += scale * value * weight;
            }
        }
        basis.push((values, coefficients, norm));
    }
    taps
}

fn dot(a: &[f64], b: &[f64], weights: &[f64]) -> f64 {
    let products = a.iter().zip(b).zip(weights).map(|((a, b), w)| a * b * w);
    products.sum()
}
