//! What a change costs by itself: the smaller and the smoother over time, the better.

use physique_body::Joint;
use physique_motion::FrameRate;

use super::change::UNKNOWNS;

/// A turn of a joint that costs 1/2 a frame, in radians.
const TURN: f64 = 0.1;
/// A displacement of the root that costs 1/2 a frame, in metres.
const DISPLACEMENT: f64 = 0.03;
/// Changes slower than this cost by their size, faster ones by their speed and acceleration: in
/// seconds.
const TIME: f64 = 0.12;
/// The trunk carries everything: turning it costs as much as turning so many arms.
const TRUNK: f64 = 4.0;
/// Legs carry the body.
const LEGS: f64 = 2.0;

/// The quadratic cost `1/2 sum_k s_k x_k^T A x_k` of a change, where `x_k` is one unknown over
/// time and `A = 1 + (T f)^2 D1^T D1 + (T f)^4 D2^T D2` with first and second differences: the
/// pose, its velocity and its acceleration stay near those of the source.
pub(super) struct Stiffness {
    /// Diagonal and two bands above it.
    matrix: [Vec<f64>; 3],
    /// `L D L^T` of the matrix: the diagonal of `D`, and two bands of `L` below the diagonal.
    factors: [Vec<f64>; 3],
    scales: [f64; UNKNOWNS],
}

impl Stiffness {
    /// For a motion of so many frames; all but arms, neck and head is `bearing` times stiffer, and
    /// changes must be `smooth` times slower.
    pub(super) fn new(frames: usize, rate: FrameRate, bearing: f64, smooth: f64) -> Self {
        let matrix = matrix(frames, smooth * TIME * rate.per_second());
        Self {
            factors: factorise(&matrix),
            matrix,
            scales: std::array::from_fn(|unknown| scale(unknown / 3, bearing)),
        }
    }

    /// The cost; adds its gradient.
    pub(super) fn cost(&self, change: &[f64], gradient: &mut [f64]) -> f64 {
        let [diagonal, near, far] = &self.matrix;
        let frames = diagonal.len();
        let mut cost = 0.0;
        for frame in 0..frames {
            for (unknown, scale) in self.scales.iter().enumerate() {
                let at = |frame: usize| change[frame * UNKNOWNS + unknown];
                let mut product = diagonal[frame] * at(frame);
                for (band, step) in [(near, 1), (far, 2)] {
                    if frame >= step {
                        product += band[frame - step] * at(frame - step);
                    }
                    if frame + step < frames {
                        product += band[frame] * at(frame + step);
                    }
                }
                cost += 0.5 * scale * at(frame) * product;
                gradient[frame * UNKNOWNS + unknown] += scale * product;
            }
        }
        cost
    }

    /// Curvature by an unknown of a frame, and by it and that of the next and the second next.
    pub(super) fn curvature(&self, unknown: usize, frame: usize) -> impl Iterator<Item = f64> {
        let frames = self.matrix[0].len();
        let bands = self.matrix.iter().take(frames - frame);
        bands.map(move |band| self.scales[unknown] * band[frame])
    }

    /// Solves for the change whose gradient this is, in place: the steepest way down when small
    /// and smooth changes are cheap.
    pub(super) fn solve(&self, gradient: &mut [f64]) {
        let [diagonal, near, far] = &self.factors;
        let frames = diagonal.len();
        for (unknown, scale) in self.scales.iter().enumerate() {
            let place = |frame: usize| frame * UNKNOWNS + unknown;
            for frame in 0..frames {
                let mut value = gradient[place(frame)];
                if frame >= 1 {
                    value -= near[frame - 1] * gradient[place(frame - 1)];
                }
                if frame >= 2 {
                    value -= far[frame - 2] * gradient[place(frame - 2)];
                }
                gradient[place(frame)] = value;
            }
            for frame in 0..frames {
                gradient[place(frame)] /= diagonal[frame] * scale;
            }
            for frame in (0..frames).rev() {
                let mut value = gradient[place(frame)];
                if frame + 1 < frames {
                    value -= near[frame] * gradient[place(frame + 1)];
                }
                if frame + 2 < frames {
                    value -= far[frame] * gradient[place(frame + 2)];
                }
                gradient[place(frame)] = value;
            }
        }
    }
}

/// Cost of a squared radian or metre at a place of the change.
fn scale(place: usize, bearing: f64) -> f64 {
    let weight = match Joint::from_index(place) {
        None => return 1.0 / (DISPLACEMENT * DISPLACEMENT),
        Some(Joint::Pelvis | Joint::Spine1 | Joint::Spine2 | Joint::Spine3) => TRUNK * bearing,
        Some(joint) if Joint::LEGS.iter().flatten().any(|&leg| leg == joint) => LEGS * bearing,
        Some(_) => 1.0,
    };
    weight / (TURN * TURN)
}

fn matrix(frames: usize, time: f64) -> [Vec<f64>; 3] {
    let mut bands = [vec![1.0; frames], vec![0.0; frames], vec![0.0; frames]];
    let mut add = |frame: usize, stencil: &[f64], weight: f64| {
        for (i, a) in stencil.iter().enumerate() {
            for (j, b) in stencil.iter().enumerate().skip(i) {
                bands[j - i][frame + i] += weight * a * b;
            }
        }
    };
    for (stencil, weight) in [
        (&[-1.0, 1.0][..], time.powi(2)),
        (&[1.0, -2.0, 1.0], time.powi(4)),
    ] {
        for frame in 0..(frames + 1).saturating_sub(stencil.len()) {
            add(frame, stencil, weight);
        }
    }
    bands
}

fn factorise(matrix: &[Vec<f64>; 3]) -> [Vec<f64>; 3] {
    let [mut diagonal, mut near, mut far] = matrix.clone();
    for frame in 0..diagonal.len() {
        let pivot = diagonal[frame];
        let (one, two) = (near[frame], far[frame]);
        if let Some(next) = diagonal.get_mut(frame + 1) {
            *next -= one * one / pivot;
            near[frame + 1] -= one * two / pivot;
        }
        if let Some(next) = diagonal.get_mut(frame + 2) {
            *next -= two * two / pivot;
        }
        near[frame] = one / pivot;
        far[frame] = two / pivot;
    }
    [diagonal, near, far]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solving_undoes_the_gradient() {
        for frames in [1, 2, 3, 40] {
            let rate = FrameRate::new(30.0).unwrap();
            let stiffness = Stiffness::new(frames, rate, 2.5, 1.0);
            let change: Vec<_> = (0..frames * UNKNOWNS)
                .map(|place| (place as f64 * 0.7).sin())
                .collect();
            let mut gradient = vec![0.0; change.len()];
            let cost = stiffness.cost(&change, &mut gradient);
            // Quadratic: x . gradient is twice the cost.
            let twice: f64 = change.iter().zip(&gradient).map(|(x, g)| x * g).sum();
            assert!((twice - 2.0 * cost).abs() < 1e-9 * twice);
            stiffness.solve(&mut gradient);
            for (found, expected) in gradient.iter().zip(&change) {
                assert!((found - expected).abs() < 1e-9, "{found} for {expected}");
            }
        }
    }

    #[test]
    fn a_steady_change_costs_by_its_size_only() {
        let rate = FrameRate::new(60.0).unwrap();
        let stiffness = Stiffness::new(30, rate, 1.0, 1.0);
        let mut change = vec![0.0; 30 * UNKNOWNS];
        let elbow = 3 * Joint::LeftElbow.index();
        for frame in 0..30 {
            change[frame * UNKNOWNS + elbow] = TURN;
        }
        let cost = stiffness.cost(&change, &mut vec![0.0; change.len()]);
        assert!((cost - 15.0).abs() < 1e-9, "{cost}");
    }
}
