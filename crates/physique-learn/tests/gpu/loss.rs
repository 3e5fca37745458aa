//! Losses of motions and their gradients.

use std::sync::Arc;

use burn::tensor::{Device, Tensor, TensorData};
use physique_learn::motion_loss::{GroundLoss, MotionLoss, SelfIntersectionLoss, losses};
use physique_learn::random::Random;
use physique_motion::features::{FeatureSkeleton, FeatureStatistics, GradientRule};
use physique_proxy::{FeatureLoss, Pairs, Penalty, SelfIntersection, SelfIntersectionOptions};

use crate::golden::golden;
use crate::support::{FRAMES, LENGTHS, batch, difference, gpu, numbers};

/// Losses of a batch, and the gradient of a sum in which each counts differently.
fn run(batch: &[f32], loss: &Arc<dyn MotionLoss>, device: &Device) -> [Vec<f32>; 2] {
    let device = device.clone().autodiff();
    let columns = batch.len() / (LENGTHS.len() * FRAMES);
    let shape = [LENGTHS.len(), FRAMES, columns];
    let leaf = Tensor::<3>::from_data(TensorData::new(batch.to_vec(), shape), &device);
    let leaf = leaf.require_grad();
    // In the middle of a graph.
    let found = losses(leaf.clone() * 1.0, &LENGTHS, loss);
    let weights = Tensor::<1>::from_data([0.5, 2.0, 1.25], &device);
    let gradients = (found.clone() * weights).sum().backward();
    let gradient = leaf.grad(&gradients).expect("it depends on it");
    [numbers(found), numbers(gradient)]
}

fn of_body(
    rule: GradientRule,
    statistics: &FeatureStatistics,
    options: Option<SelfIntersectionOptions>,
) -> Arc<dyn MotionLoss> {
    let mut loss = FeatureLoss::of_open_body(rule).expect("embedded");
    if let Some(options) = options {
        let (body, pairs) = (loss.loss().body(), loss.loss().pairs());
        let spheres = SelfIntersection::with_options(body, pairs, &options).expect("possible");
        loss = FeatureLoss::new(spheres, loss.layer(), rule);
    }
    Arc::new(SelfIntersectionLoss::new(loss, statistics.clone()))
}

/// Rounding differs: units add up in another order, and square roots are their own.
const CLOSE: f32 = 2e-4;

fn assert_close(what: &str, found: &[Vec<f32>; 2], expected: &[Vec<f32>; 2]) {
    let [value, gradient] = [0, 1].map(|part| difference(&found[part], &expected[part]));
    println!("{what}: losses {value:.1e}, gradients {gradient:.1e}");
    assert!(
        value < CLOSE && gradient < CLOSE,
        "{what}: {value} {gradient}"
    );
}

#[test]
fn real_motions_are_those_of_the_processor() {
    let Some(device) = gpu() else { return };
    for skeleton in FeatureSkeleton::ALL {
        let (batch, statistics) = batch(skeleton, f32::NAN);
        for rule in [GradientRule::ParentsConstant, GradientRule::Full] {
            let loss = of_body(rule, &statistics, None);
            let expected = run(&batch, &loss, &Device::flex());
            assert!(
                expected[0].iter().all(|loss| *loss > 1e-5),
                "nothing touches"
            );
            let found = run(&batch, &loss, &device);
            assert_close(&format!("{skeleton:?}, {rule:?}"), &found, &expected);
            // Sums have an order.
            assert_eq!(run(&batch, &loss, &device), found);
        }
    }
}

#[test]
fn golden_poses_are_those_of_the_processor() {
    let Some(device) = gpu() else { return };
    for rule in [GradientRule::ParentsConstant, GradientRule::Full] {
        let (loss, motions, statistics) = golden(rule);
        let loss: Arc<dyn MotionLoss> = Arc::new(SelfIntersectionLoss::new(loss, statistics));
        let expected = run(&motions, &loss, &Device::flex());
        let found = run(&motions, &loss, &device);
        assert_close(&format!("golden, {rule:?}"), &found, &expected);
    }
}

/// Bodies of numbers that nobody has: bones of any length point anywhere.
#[test]
fn random_motions_are_those_of_the_processor() {
    let Some(device) = gpu() else { return };
    let (batch, statistics) = batch(FeatureSkeleton::HumanMl3d, 0.0);
    let mut random = Random::new(&[3]);
    for size in [1.0, 5.0] {
        let mut noise = vec![0.0; batch.len()];
        random.fill_normal(&mut noise);
        noise.iter_mut().for_each(|number| *number *= size);
        let loss = of_body(GradientRule::ParentsConstant, &statistics, None);
        let expected = run(&noise, &loss, &Device::flex());
        let found = run(&noise, &loss, &device);
        assert_close(&format!("noise of {size}"), &found, &expected);
    }
}

#[test]
fn other_penalties_and_tolerances_are_those_of_the_processor() {
    let Some(device) = gpu() else { return };
    let (batch, statistics) = batch(FeatureSkeleton::HumanMl3d, 0.0);
    for penalty in [Penalty::Squared, Penalty::Linear] {
        let options = SelfIntersectionOptions {
            penalty,
            tolerance: 0.01,
            backend: None,
        };
        let loss = of_body(GradientRule::Full, &statistics, Some(options));
        let expected = run(&batch, &loss, &Device::flex());
        assert_close(
            &format!("{penalty:?} beyond 1 cm"),
            &run(&batch, &loss, &device),
            &expected,
        );
    }
}

/// More spheres than a cube's memory holds: on the processor.
#[test]
fn bodies_of_many_spheres_are_those_of_the_processor() {
    let Some(device) = gpu() else { return };
    let (batch, statistics) = batch(FeatureSkeleton::HumanMl3d, 0.0);
    let embedded = FeatureLoss::of_open_body(GradientRule::Full).expect("embedded");
    let mut body = embedded.loss().body().clone();
    for copy in 1..4 {
        for sphere in 0..embedded.loss().body().sphere_count() {
            let centre = body.centres[sphere] + glam::Vec3::splat(0.01 * copy as f32);
            body.centres.push(centre);
            body.radii.push(body.radii[sphere]);
            body.blend_weights.push(body.blend_weights[sphere]);
        }
    }
    let pairs = Pairs::all(body.sphere_count()).expect("few");
    let pairs = pairs.filtered(|i, j| body.dominant_joint(i) != body.dominant_joint(j));
    let spheres = SelfIntersection::new(&body, &pairs).expect("possible");
    let loss = FeatureLoss::new(spheres, embedded.layer(), GradientRule::Full);
    let loss: Arc<dyn MotionLoss> = Arc::new(SelfIntersectionLoss::new(loss, statistics));
    let expected = run(&batch, &loss, &Device::flex());
    assert_eq!(run(&batch, &loss, &device), expected);
}

/// Bones without length, bones folded straight back, and bodies without a heading.
#[test]
fn poses_without_a_derivative_are_those_of_the_processor() {
    let Some(device) = gpu() else { return };
    let (mut batch, statistics) = batch(FeatureSkeleton::HumanMl3d, 0.0);
    let columns = statistics.mean().len();
    statistics.denormalise(&mut batch);
    for (frame, row) in batch.chunks_exact_mut(columns).enumerate() {
        let positions = &mut row[3..67];
        match frame % 3 {
            // All joints in one place.
            0 => positions.fill(0.0),
            // Upside down: legs folded back, arms across.
            1 => positions[1..]
                .chunks_exact_mut(3)
                .for_each(|at| at[1] = -at[1]),
            // Hips and shoulders one above the other.
            _ => positions[1..]
                .chunks_exact_mut(3)
                .for_each(|at| at[0] = 0.0),
        }
    }
    statistics.normalise(&mut batch);
    let loss = of_body(GradientRule::Full, &statistics, None);
    let expected = run(&batch, &loss, &Device::flex());
    assert_close("degenerate", &run(&batch, &loss, &device), &expected);
}

/// What is no number costs one: training stops at it.
#[test]
fn what_is_no_number_is_found() {
    let Some(device) = gpu() else { return };
    let (batch, statistics) = batch(FeatureSkeleton::HumanMl3d, 0.0);
    let columns = statistics.mean().len();
    let loss = of_body(GradientRule::ParentsConstant, &statistics, None);
    for (column, number) in [
        (0, f32::NAN),
        (3, f32::INFINITY),
        (40, f32::NAN),
        (66, 1e30),
    ] {
        let mut broken = batch.clone();
        broken[(FRAMES + 2) * columns + column] = number;
        let [losses, _] = run(&broken, &loss, &device);
        let finite: Vec<_> = losses.iter().map(|loss| loss.is_finite()).collect();
        assert_eq!(finite, [true, false, true], "{number} in column {column}");
    }
}

/// Those without kernels: on the processor, to the bit.
#[test]
fn losses_without_kernels_work() {
    let Some(device) = gpu() else { return };
    let (batch, statistics) = batch(FeatureSkeleton::HumanMl3d, 0.0);
    let loss: Arc<dyn MotionLoss> = Arc::new(GroundLoss::new(statistics));
    let expected = run(&batch, &loss, &Device::flex());
    let found = run(&batch, &loss, &device);
    assert_eq!(found[0], expected[0]);
    assert!(difference(&found[1], &expected[1]) < 1e-6);
}
