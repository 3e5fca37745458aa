//! Limited-memory BFGS with a preconditioner.
//!
//! Nocedal and Wright, "Numerical Optimization", algorithm 7.4, where the first guess of the inverse
//! Hessian is not a multiple of the identity but given: the part of the cost that is quadratic is
//! known exactly, and only the rest has to be learnt.

use std::collections::VecDeque;

/// Steps that are remembered.
const MEMORY: usize = 12;
/// A step must gain this part of what its slope promises (Armijo).
const SUFFICIENT: f64 = 1e-4;
/// Halvings of a step before the search gives up.
const HALVINGS: usize = 20;

/// What to minimise.
pub(super) trait Cost {
    /// The cost; `gradient` is overwritten.
    fn evaluate(&self, at: &[f64], gradient: &mut [f64]) -> f64;

    /// Applies a positive definite guess of the inverse Hessian, in place.
    fn precondition(&self, gradient: &mut [f64]);
}

/// Goes down from `at` for so many steps, or until a step gains less than `tolerance` of the cost.
/// The cost never rises. Returns the cost reached.
pub(super) fn minimise(cost: &impl Cost, at: &mut [f64], steps: usize, tolerance: f64) -> f64 {
    let mut gradient = vec![0.0; at.len()];
    let mut value = cost.evaluate(at, &mut gradient);
    let mut memory: VecDeque<Curvature> = VecDeque::new();
    let (mut next, mut next_gradient) = (at.to_vec(), gradient.clone());
    for _ in 0..steps {
        let mut direction = direction(cost, &gradient, &memory);
        let mut slope = -dot(&gradient, &direction);
        if slope >= 0.0 {
            memory.clear();
            direction.copy_from_slice(&gradient);
            cost.precondition(&mut direction);
            slope = -dot(&gradient, &direction);
        }
        if slope >= 0.0 || slope.is_nan() {
            break;
        }
        let mut length = 1.0;
        let mut found = None;
        for _ in 0..HALVINGS {
            for ((next, at), direction) in next.iter_mut().zip(&*at).zip(&direction) {
                *next = at - length * direction;
            }
            let reached = cost.evaluate(&next, &mut next_gradient);
            if reached <= value + SUFFICIENT * length * slope {
                found = Some(reached);
                break;
            }
            length /= 2.0;
        }
        let Some(reached) = found else {
            break;
        };
        if let Some(curvature) = Curvature::between(at, &next, &gradient, &next_gradient) {
            if memory.len() == MEMORY {
                memory.pop_front();
            }
            memory.push_back(curvature);
        }
        at.copy_from_slice(&next);
        std::mem::swap(&mut gradient, &mut next_gradient);
        let gain = value - reached;
        value = reached;
        if gain <= tolerance * value.abs() {
            break;
        }
    }
    value
}

/// One step and how the gradient changed along it.
struct Curvature {
    step: Vec<f64>,
    change: Vec<f64>,
    inverse: f64,
}

impl Curvature {
    /// `None` where the cost does not bend upwards along the step.
    fn between(from: &[f64], to: &[f64], before: &[f64], after: &[f64]) -> Option<Self> {
        let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
        let (step, change) = (minus(to, from), minus(after, before));
        let bend = dot(&step, &change);
        (bend > 1e-12 * dot(&change, &change).sqrt() * dot(&step, &step).sqrt()).then(|| Self {
            step,
            change,
            inverse: 1.0 / bend,
        })
    }
}

/// The two-loop recursion: the direction to subtract.
fn direction(cost: &impl Cost, gradient: &[f64], memory: &VecDeque<Curvature>) -> Vec<f64> {
    let mut direction = gradient.to_vec();
    let mut shares = Vec::with_capacity(memory.len());
    for curvature in memory.iter().rev() {
        let share = curvature.inverse * dot(&curvature.step, &direction);
        add(&mut direction, -share, &curvature.change);
        shares.push(share);
    }
    cost.precondition(&mut direction);
    for (curvature, share) in memory.iter().zip(shares.into_iter().rev()) {
        let back = curvature.inverse * dot(&curvature.change, &direction);
        add(&mut direction, share - back, &curvature.step);
    }
    direction
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += factor * from;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley.
    struct Valley;

    impl Cost for Valley {
        fn evaluate(&self, at: &[f64], gradient: &mut [f64]) -> f64 {
            let (x, y) = (at[0], at[1]);
            gradient[0] = -2.0 * (1.0 - x) - 400.0 * x * (y - x * x);
            gradient[1] = 200.0 * (y - x * x);
            (1.0 - x).powi(2) + 100.0 * (y - x * x).powi(2)
        }

        fn precondition(&self, gradient: &mut [f64]) {
            gradient.iter_mut().for_each(|slope| *slope *= 1e-3);
        }
    }

    #[test]
    fn finds_the_end_of_the_valley() {
        let mut at = [-1.2, 1.0];
        let value = minimise(&Valley, &mut at, 200, 0.0);
        assert!(value < 1e-12, "{value} at {at:?}");
        assert!(
            (at[0] - 1.0).abs() < 1e-5 && (at[1] - 1.0).abs() < 1e-5,
            "{at:?}"
        );
    }
}
