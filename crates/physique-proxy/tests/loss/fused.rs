//! The fused kernels of every backend against the slow reference.

use glam::{DVec3, Vec3};
use physique_proxy::{
    Backend, Pairs, Penalty, PoseMatrices, SelfIntersection, SelfIntersectionOptions,
    ShapeGradient, SphereBody, reference,
};

use crate::golden::Golden;
use crate::real;
use crate::support::Random;

/// Largest differences of losses and gradients between a backend and the reference.
fn compare(
    body: &SphereBody,
    pairs: &Pairs,
    options: &SelfIntersectionOptions,
    poses: &[PoseMatrices],
) -> (f64, f64) {
    let loss = SelfIntersection::with_options(body, pairs, options).expect("sound");
    let weights: Vec<_> = (0..poses.len())
        .map(|frame| 0.5 + 0.25 * (frame % 4) as f32)
        .collect();
    let mut losses = vec![f32::NAN; poses.len()];
    let mut by_poses = vec![[[f32::NAN; 9]; 22]; poses.len()];
    loss.gradient(poses, &weights, &mut losses, &mut by_poses)
        .expect("finite");
    let mut by_poses_too = by_poses.clone();
    let mut losses_too = losses.clone();
    let shape = loss.shape_gradient(poses, &weights, &mut losses_too, &mut by_poses_too);
    let shape = shape.expect("finite");
    assert_eq!((&losses, &by_poses), (&losses_too, &by_poses_too));
    let mut by_shape = Reference::new(body.sphere_count());
    let mut only_losses = vec![f32::NAN; poses.len()];
    loss.losses(poses, &mut only_losses).expect("finite");
    assert_eq!(losses, only_losses);
    let (mut by_value, mut by_gradient) = (0.0_f64, 0.0_f64);
    for (frame, pose) in poses.iter().enumerate() {
        let rotations = reference::rotations(pose);
        let tolerance = f64::from(options.tolerance);
        let (value, gradient) =
            reference::self_intersection(body, pairs, options.penalty, tolerance, &rotations);
        by_value = by_value.max((f64::from(losses[frame]) - value).abs());
        for (by, expected) in by_poses[frame].iter().zip(&gradient.rotations) {
            let expected = expected.transpose().to_cols_array();
            for (by, expected) in by.iter().zip(expected) {
                let expected = expected * f64::from(weights[frame]);
                by_gradient = by_gradient.max((f64::from(*by) - expected).abs());
            }
        }
        by_shape.add(&gradient, f64::from(weights[frame]));
    }
    by_shape.compare(&shape);
    (by_value, by_gradient)
}

/// Sums of the reference's derivatives by the shape.
struct Reference {
    rest_joints: [DVec3; 22],
    centres: Vec<DVec3>,
    radii: Vec<f64>,
}

impl Reference {
    fn new(spheres: usize) -> Self {
        Self {
            rest_joints: [DVec3::ZERO; 22],
            centres: vec![DVec3::ZERO; spheres],
            radii: vec![0.0; spheres],
        }
    }

    fn add(&mut self, gradient: &reference::Gradient, weight: f64) {
        for (sum, by) in self.rest_joints.iter_mut().zip(&gradient.rest_joints) {
            *sum += weight * by;
        }
        for (sum, by) in self.centres.iter_mut().zip(&gradient.centres) {
            *sum += weight * by;
        }
        for (sum, by) in self.radii.iter_mut().zip(&gradient.radii) {
            *sum += weight * by;
        }
    }

    /// Within rounding of the largest of each kind: sums over frames grow.
    fn compare(&self, shape: &ShapeGradient) {
        let vectors = |sums: &[DVec3], found: &[Vec3]| {
            let largest = sums.iter().map(|sum| sum.length()).fold(1.0, f64::max);
            for (sum, found) in sums.iter().zip(found) {
                assert!(
                    sum.distance(found.as_dvec3()) < 1e-5 * largest,
                    "{sum} {found}"
                );
            }
        };
        vectors(&self.rest_joints, &shape.rest_joints);
        vectors(&self.centres, &shape.centres);
        let largest = self.radii.iter().copied().fold(1.0, f64::max);
        for (sum, found) in self.radii.iter().zip(&shape.radii) {
            assert!(
                (sum - f64::from(*found)).abs() < 1e-5 * largest,
                "{sum} {found}"
            );
        }
    }
}

fn options(backend: Backend) -> SelfIntersectionOptions {
    SelfIntersectionOptions {
        backend: Some(backend),
        ..Default::default()
    }
}

#[test]
fn golden_poses() {
    let mut golden = Golden::open();
    let (body, pairs, poses) = (golden.body(), golden.pairs(), golden.poses());
    for backend in Backend::available() {
        let (value, gradient) = compare(&body, &pairs, &options(backend), &poses);
        assert!(
            value < 1e-5 && gradient < 1e-5,
            "{backend}: {value:e} {gradient:e}"
        );
    }
}

#[test]
fn real_poses() {
    let (body, pairs) = real::body_and_pairs();
    let poses = real::poses();
    assert!(pairs.len() > 10_000, "{}", pairs.len());
    for backend in Backend::available() {
        for (penalty, tolerance) in [(Penalty::Squared, 0.0), (Penalty::Linear, 0.005)] {
            let options = SelfIntersectionOptions {
                penalty,
                tolerance,
                backend: Some(backend),
            };
            let (value, gradient) = compare(&body, &pairs, &options, &poses);
            println!("{backend} {penalty:?}: {value:e} {gradient:e}");
            assert!(
                value < 1e-5 && gradient < 1e-5,
                "{backend}: {value:e} {gradient:e}"
            );
        }
    }
}

/// Any number of frames, any body, any pairs: tails of tiles, quads and groups.
#[test]
fn random_bodies_and_lengths() {
    let mut random = Random(11);
    for spheres in [1, 2, 3, 7, 30, 64] {
        let body = random.body(spheres);
        let all = Pairs::all(spheres).expect("few");
        let some = all.filtered(|i, j| (i + 3 * j) % 4 != 0);
        for frames in [0, 1, 2, 15, 16, 17, 37] {
            let poses: Vec<_> = (0..frames).map(|_| random.pose(2.5)).collect();
            for backend in Backend::available() {
                for pairs in [&all, &some] {
                    let (value, gradient) = compare(&body, pairs, &options(backend), &poses);
                    assert!(
                        value < 1e-5 && gradient < 1e-5,
                        "{backend} {spheres} {frames}: {value:e} {gradient:e}"
                    );
                }
            }
        }
    }
}
