//! The gradient against differences, and the preconditioner against the curvature.

use physique_body::{Body, Sex, open_body};
use physique_motion::{Motion, embedded};
use physique_proxy::open_proxy;

use super::*;

/// Frames of the embedded walk that are looked at.
const FRAMES: usize = 12;

/// Everything that an objective borrows.
struct Setting {
    figure: Figure,
    spheres: SelfIntersection,
    source: Source,
    touches: Touches,
    feet: Feet,
    balance: Balance,
    ground: Ground,
    stiffness: Stiffness,
    preconditioner: Preconditioner,
    self_weights: Vec<f32>,
}

impl Setting {
    /// `mend`: feet that stand should stop sliding.
    fn new(mend: bool, weights: Weights) -> Self {
        let body = Body::mean(open_body().unwrap(), Sex::Neutral).unwrap();
        let proxy = open_proxy().unwrap();
        let sphere_body = proxy.of_body(&body).unwrap();
        let spheres = SelfIntersection::new(&sphere_body, &proxy.pairs().unwrap()).unwrap();
        let walk = embedded::clip("walk").unwrap().load().unwrap().motion;
        let walk = Motion::new(
            walk.frame_rate(),
            None,
            walk.root_translation()[..FRAMES].to_vec(),
            walk.rotations()[..FRAMES * Joint::COUNT].to_vec(),
        )
        .unwrap();
        let figure = Figure::new(&body).unwrap();
        let source = Source::new(&walk);
        let frame_s = walk.frame_rate().frame_seconds();
        let poses = source.poses(&figure, &vec![0.0; source.unknowns()]);
        let feet = Feet::of(&poses, frame_s, mend);
        let balance = Balance::of(&poses, frame_s, &feet, &[]);
        let stiffness = Stiffness::new(FRAMES, walk.frame_rate(), 1.0, 1.0);
        let preconditioner =
            Preconditioner::new(&figure, &poses, &stiffness, (&feet, &balance), weights);
        Self {
            touches: Touches::of(&sphere_body, &poses, frame_s),
            ground: Ground::of(&figure, &poses, vec![true; FRAMES]),
            self_weights: vec![1.0; FRAMES],
            figure,
            spheres,
            source,
            feet,
            balance,
            stiffness,
            preconditioner,
        }
    }

    fn objective(&self, weights: Weights, ground: bool) -> Objective<'_> {
        Objective {
            source: &self.source,
            figure: &self.figure,
            stiffness: &self.stiffness,
            preconditioner: &self.preconditioner,
            spheres: &self.spheres,
            touches: &self.touches,
            feet: &self.feet,
            balance: &self.balance,
            ground: ground.then_some(&self.ground),
            self_weights: &self.self_weights,
            weights,
        }
    }

    /// A change that differs from place to place, of this size.
    fn change(&self, size: f64, seed: f64) -> Vec<f64> {
        let places = 0..self.source.unknowns();
        places
            .map(|place| size * (seed + 12.9898 * place as f64).sin())
            .collect()
    }
}

const NOTHING: Weights = Weights {
    spheres: 0.0,
    ground: 0.0,
    feet: 0.0,
    balance: 0.0,
};

#[test]
fn the_gradient_is_that_of_differences() {
    let single = |weights: Weights| (weights, 1e-6, 2e-6);
    let terms = [
        single(NOTHING),
        single(Weights {
            feet: 1.0,
            ..NOTHING
        }),
        single(Weights {
            balance: 1.0,
            ..NOTHING
        }),
        single(Weights {
            ground: 1.0,
            ..NOTHING
        }),
        // The spheres are f32.
        (
            Weights {
                spheres: 1.0,
                ..NOTHING
            },
            1e-3,
            2e-2,
        ),
    ];
    for (weights, step, tolerance) in terms {
        let setting = Setting::new(true, weights);
        let objective = setting.objective(weights, weights.ground > 0.0);
        let at = setting.change(0.05, 0.3);
        let mut gradient = vec![0.0; at.len()];
        let mut unused = vec![0.0; at.len()];
        objective.evaluate(&at, &mut gradient);
        for seed in [1.0, 2.0, 3.0] {
            let way = setting.change(1.0, seed);
            let mut value = |length: f64| {
                let moved = at.iter().zip(&way).map(|(at, way)| at + length * way);
                objective.evaluate(&moved.collect::<Vec<_>>(), &mut unused)
            };
            let difference = (value(step) - value(-step)) / (2.0 * step);
            let slope: f64 = gradient.iter().zip(&way).map(|(g, w)| g * w).sum();
            assert!(
                (slope - difference).abs() < tolerance * (1.0 + slope.abs()),
                "{weights:?}: {slope}, by differences {difference}"
            );
        }
    }
}

/// Near the source the cost of feet and balance is quadratic, with the curvature assumed.
#[test]
fn the_preconditioner_undoes_the_gradient_of_small_changes() {
    let weights = Weights {
        feet: 1.0,
        balance: 1.0,
        ..NOTHING
    };
    let setting = Setting::new(false, weights);
    let objective = setting.objective(weights, false);
    let mut change = setting.change(1e-6, 0.7);
    for frame in change.chunks_exact_mut(UNKNOWNS) {
        free_of_arms(frame);
    }
    let mut gradient = vec![0.0; change.len()];
    objective.evaluate(&change, &mut gradient);
    let mut found = gradient.clone();
    objective.precondition(&mut found);
    // Gradients are compared, not changes: what hardly costs anything is hardly determined.
    for frame in found.chunks_exact_mut(UNKNOWNS) {
        free_of_arms(frame);
    }
    let mut again = vec![0.0; change.len()];
    objective.evaluate(&found, &mut again);
    for (slopes, again) in gradient
        .chunks_exact_mut(UNKNOWNS)
        .zip(again.chunks_exact_mut(UNKNOWNS))
    {
        free_of_arms(slopes);
        free_of_arms(again);
    }
    let length = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>().sqrt();
    let apart: Vec<_> = gradient.iter().zip(&again).map(|(a, b)| a - b).collect();
    let (apart, whole) = (length(&apart), length(&gradient));
    assert!(whole > 0.0 && apart < 1e-4 * whole, "{apart} of {whole}");
}

/// Arms, neck and head are not tied to the feet.
fn free_of_arms(frame: &mut [f64]) {
    let arms = Joint::ARMS.iter().flatten().copied();
    for joint in arms.chain([Joint::Neck, Joint::Head]) {
        frame[3 * joint.index()..][..3].fill(0.0);
    }
}

/// Points that stood still when nothing was changed, and do, cost nothing.
#[test]
fn the_source_costs_nothing_but_its_faults() {
    let weights = Weights {
        feet: 1.0,
        balance: 1.0,
        ..NOTHING
    };
    let setting = Setting::new(false, weights);
    let nothing = vec![0.0; setting.source.unknowns()];
    let mut gradient = nothing.clone();
    let cost = setting
        .objective(weights, false)
        .evaluate(&nothing, &mut gradient);
    assert!(cost < 1e-12, "{cost}");
    assert!(gradient.iter().all(|slope| slope.abs() < 1e-6));
}
