//! Every loss against its slow reference, and its gradient against finite differences.

use glam::{DMat3, DQuat, DVec3};
use physique_body::{Body, Joint, Sex, open_body_low};
use physique_motion::FrameRate;
use physique_physics::loss::reference::{self, PosedMotion};
use physique_physics::loss::{
    Floating, FrameLoss, LossBody, MotionGradient, MotionSlices, Penetration, PressureBalance,
    Sliding, SupportedBalance, evaluate,
};
use physique_physics::{Error, PressureModel, TimeFilter};

const FRAMES: usize = 16;
const SOLES: usize = 12;

/// A body that sways, bobs and shuffles about its standing height.
struct Scene {
    body: LossBody,
    rate: FrameRate,
    rotations: Vec<DMat3>,
    root: Vec<DVec3>,
    betas: Vec<f64>,
    contacts: Vec<f64>,
}

impl Scene {
    fn new() -> Self {
        let body = Body::mean(open_body_low().unwrap(), Sex::Neutral).unwrap();
        let rate = FrameRate::new(20.0).unwrap();
        let wave = |frame: usize, k: usize| (0.35 * frame as f64 + 1.7 * k as f64).sin();
        let turn = |frame, joint: usize| {
            let axis = DVec3::new(1.0, 0.3 * joint as f64, 0.5).normalize();
            DMat3::from_quat(DQuat::from_axis_angle(axis, 0.12 * wave(frame, joint)))
        };
        let standing = -f64::from(body.rest_ground());
        Self {
            body: LossBody::new(&body, 60).unwrap(),
            rate,
            rotations: (0..FRAMES)
                .flat_map(|frame| (0..Joint::COUNT).map(move |joint| turn(frame, joint)))
                .collect(),
            root: (0..FRAMES)
                .map(|frame| {
                    let height = standing + 0.02 + 0.04 * wave(frame, 50);
                    DVec3::new(0.1 * wave(frame, 51), height, 0.05 * wave(frame, 52))
                })
                .collect(),
            betas: vec![0.3, -0.2],
            contacts: (0..FRAMES * SOLES)
                .map(|i| 0.5 + 0.5 * wave(i, 3))
                .collect(),
        }
    }

    fn slices(&self) -> MotionSlices<'_> {
        MotionSlices {
            frame_rate: self.rate,
            rotations: &self.rotations,
            root: &self.root,
            betas: &self.betas,
        }
    }

    fn value(&self, loss: &dyn FrameLoss) -> f64 {
        evaluate(&self.body, &self.slices(), loss, None).unwrap()
    }

    /// The loss against `expected`, its gradient against central differences.
    fn check(&mut self, loss: &dyn FrameLoss, expected: f64) {
        let mut gradient = MotionGradient::default();
        let value = evaluate(&self.body, &self.slices(), loss, Some(&mut gradient)).unwrap();
        assert!(value > 0.0, "the scene must cost something");
        assert!(
            (value - expected).abs() < 1e-10 * expected,
            "{value} {expected}"
        );
        assert_eq!(value, self.value(loss), "with and without gradient");

        let scale = gradient.root.iter().map(|g| g.length()).fold(0.0, f64::max);
        let close = |found: f64, difference: f64, what: String| {
            let error = (found - difference).abs();
            assert!(
                error < 2e-5 * (scale + difference.abs()),
                "{what}: {found} {difference}"
            );
        };
        const STEP: f64 = 1e-6;
        for frame in 0..FRAMES {
            for axis in 0..3 {
                let at = |scene: &mut Self, step: f64| {
                    scene.root[frame][axis] += step;
                    let value = scene.value(loss);
                    scene.root[frame][axis] -= step;
                    value
                };
                let difference = (at(self, STEP) - at(self, -STEP)) / (2.0 * STEP);
                close(
                    gradient.root[frame][axis],
                    difference,
                    format!("root {frame} {axis}"),
                );
            }
        }
        let turns = gradient.rotation_vectors(&self.rotations);
        for index in (0..self.rotations.len()).step_by(7) {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let rotation = self.rotations[index];
                let at = |scene: &mut Self, step: f64| {
                    scene.rotations[index] = DMat3::from_axis_angle(axis, step) * rotation;
                    let value = scene.value(loss);
                    scene.rotations[index] = rotation;
                    value
                };
                let difference = (at(self, STEP) - at(self, -STEP)) / (2.0 * STEP);
                close(
                    turns[index].dot(axis),
                    difference,
                    format!("rotation {index} {axis}"),
                );
            }
        }
        for beta in 0..2 {
            let at = |scene: &mut Self, step: f64| {
                scene.betas[beta] += step;
                let value = scene.value(loss);
                scene.betas[beta] -= step;
                value
            };
            let difference = (at(self, STEP) - at(self, -STEP)) / (2.0 * STEP);
            close(gradient.betas[beta], difference, format!("beta {beta}"));
        }
    }
}

#[test]
fn penetration() {
    let mut scene = Scene::new();
    let loss = Penetration { ground: 0.02 };
    let expected = reference::penetration(&posed(&scene), &loss);
    scene.check(&loss, expected);
}

#[test]
fn floating() {
    let mut scene = Scene::new();
    let grounded: Vec<_> = (0..FRAMES)
        .map(|frame| if frame == 3 { 0.0 } else { 0.8 })
        .collect();
    let loss = Floating {
        ground: -0.05,
        grounded: &grounded,
        ..Floating::default()
    };
    let expected = reference::floating(&posed(&scene), &loss);
    scene.check(&loss, expected);
}

#[test]
fn sliding() {
    let mut scene = Scene::new();
    let contacts = scene.contacts.clone();
    let loss = Sliding {
        contacts: &contacts,
        softness: 0.01,
    };
    let expected = reference::sliding(&posed(&scene), &loss);
    scene.check(&loss, expected);
}

#[test]
fn balance_towards_the_support() {
    let mut scene = Scene::new();
    let contacts = scene.contacts.clone();
    let loss = SupportedBalance {
        ground: 0.0,
        filter: TimeFilter::savitzky_golay_5(scene.rate),
        contacts: &contacts,
        margin: 0.02,
        softness: 0.05,
    };
    let expected = reference::supported_balance(&posed(&scene), &loss);
    scene.check(&loss, expected);
}

#[test]
fn balance_towards_the_centre_of_pressure() {
    let mut scene = Scene::new();
    let loss = PressureBalance {
        ground: 0.0,
        filter: TimeFilter::savitzky_golay_5(scene.rate),
        pressure: PressureModel::HUMOS,
        rho: 0.1,
    };
    let expected = reference::pressure_balance(&posed(&scene), &loss);
    scene.check(&loss, expected);
}

fn posed(scene: &Scene) -> PosedMotion {
    PosedMotion::new(&scene.body, &scene.slices())
}

#[test]
fn slices_that_disagree_are_refused() {
    let scene = Scene::new();
    let loss = Penetration::default();
    let evaluate = |slices: MotionSlices<'_>| evaluate(&scene.body, &slices, &loss, None);
    let mut short = scene.slices();
    short.rotations = &scene.rotations[1..];
    assert!(matches!(evaluate(short), Err(Error::Length { .. })));
    let mut empty = scene.slices();
    (empty.rotations, empty.root) = (&[], &[]);
    assert!(matches!(evaluate(empty), Err(Error::NoFrames)));
    let betas = vec![0.0; scene.body.beta_count() + 1];
    let mut many = scene.slices();
    many.betas = &betas;
    assert!(matches!(evaluate(many), Err(Error::Length { .. })));
}

#[test]
fn clips_shorter_than_the_filter_cost_nothing() {
    let scene = Scene::new();
    let loss = PressureBalance {
        ground: 0.0,
        filter: TimeFilter::new(scene.rate, 4.0).unwrap(),
        pressure: PressureModel::IPMAN,
        rho: 30.0,
    };
    let slices = MotionSlices {
        rotations: &scene.rotations[..3 * Joint::COUNT],
        root: &scene.root[..3],
        ..scene.slices()
    };
    let mut gradient = MotionGradient::default();
    assert_eq!(
        evaluate(&scene.body, &slices, &loss, Some(&mut gradient)).unwrap(),
        0.0
    );
    assert_eq!(gradient.root, [DVec3::ZERO; 3]);
    assert_eq!(gradient.rotations.len(), 3 * Joint::COUNT);
}
