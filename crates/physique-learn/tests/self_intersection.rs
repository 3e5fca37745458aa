//! Self-intersection of generated motions as a loss: SIA-MDM.

use std::sync::Arc;

use burn::tensor::{Device, Tensor, TensorData};
use physique_learn::Error;
use physique_learn::mdm::{ConditionKind, Mdm, MdmConfig, MdmTask, MdmTraining};
use physique_learn::motion_loss::{
    MotionLoss, SelfIntersectionLoss, SelfIntersectionSettings, SpherePairs, losses,
};
use physique_learn::random::Random;
use physique_learn::trainer::{
    BatchCondition, MotionBatch, MotionSource, Task, Trainer, TrainerConfig,
};
use physique_motion::embedded;
use physique_motion::features::{
    FeatureSkeleton, FeatureStatistics, GradientRule, JointPositions, MotionFeatures,
    StatisticsGatherer, extract,
};
use physique_motion::mapping::BodyRest;
use physique_proxy::FeatureLoss;

const COLUMNS: usize = 263;
const FRAMES: usize = 12;
const LENGTHS: [usize; 3] = [12, 7, 9];

/// Real motions' features, and their statistics.
fn features() -> (Vec<MotionFeatures>, FeatureStatistics) {
    let body = physique::body::open_body().expect("embedded");
    let body = physique::body::Body::new(body, &[]).expect("mean shape");
    let mut gatherer = StatisticsGatherer::new(FeatureSkeleton::HumanMl3d);
    let mut motions = Vec::new();
    for clip in embedded::clips().iter().take(LENGTHS.len()) {
        let motion = clip.load().expect("embedded").motion;
        let positions = JointPositions::from_motion(&motion, &BodyRest::from(&body));
        let features = extract(&positions.expect("finite")).expect("frames");
        gatherer.add(&features).expect("of one skeleton");
        motions.push(features);
    }
    (motions, gatherer.finish().expect("they move"))
}

/// Normalised motions `[3][FRAMES][COLUMNS]`, with `padding` behind their ends. Arms are pressed
/// into the body, so that there is something to lose.
fn batch(padding: f32) -> (Vec<f32>, FeatureStatistics) {
    let (motions, statistics) = features();
    let mut batch = vec![padding; LENGTHS.len() * FRAMES * COLUMNS];
    let places = batch.chunks_exact_mut(FRAMES * COLUMNS);
    for ((place, motion), length) in places.zip(&motions).zip(LENGTHS) {
        let within = &mut place[..length * COLUMNS];
        within.copy_from_slice(&motion.values()[..length * COLUMNS]);
        for row in within.chunks_exact_mut(COLUMNS) {
            for joint in [18, 19, 20, 21] {
                row[4 + 3 * (joint - 1)] *= 0.2;
            }
        }
        statistics.normalise(within);
    }
    (batch, statistics)
}

fn loss(rule: GradientRule, statistics: &FeatureStatistics) -> SelfIntersectionLoss {
    let loss = FeatureLoss::of_open_body(rule).expect("embedded");
    SelfIntersectionLoss::new(loss, statistics.clone())
}

/// The mean over a motion's own frames, of features out of their normalisation.
#[test]
fn value_and_gradient_are_those_of_features() {
    for gradient in [GradientRule::Full, GradientRule::ParentsConstant] {
        are_those_of_features(gradient);
    }
}

fn are_those_of_features(gradient: GradientRule) {
    let (batch, statistics) = batch(0.0);
    let settings = SelfIntersectionSettings {
        gradient,
        ..SelfIntersectionSettings::default()
    };
    let found = SelfIntersectionLoss::embedded(&statistics, settings).expect("embedded");
    let found = found.evaluate(&batch, FRAMES, &LENGTHS).expect("finite");
    let features = FeatureLoss::of_open_body(gradient).expect("embedded");
    let rate = physique_motion::FrameRate::new(20.0).expect("positive");
    let motions = batch.chunks_exact(FRAMES * COLUMNS);
    let by_motions = found.gradient.chunks_exact(FRAMES * COLUMNS);
    for (index, ((motion, by_motion), length)) in motions.zip(by_motions).zip(LENGTHS).enumerate() {
        let mut values = motion[..length * COLUMNS].to_vec();
        statistics.denormalise(&mut values);
        let motion = MotionFeatures::new(rate, statistics.skeleton(), values).expect("finite");
        let weights = vec![1.0 / length as f32; length];
        let expected = features.gradient(&motion, &weights).expect("finite");
        let mean = expected.losses.iter().sum::<f32>() / length as f32;
        assert!(mean > 1e-5, "nothing touches: {mean}");
        let close = (found.losses[index] / mean - 1.0).abs() < 1e-5;
        assert!(close, "{} {mean}", found.losses[index]);
        let deviations = statistics.deviation().iter().cycle();
        let expected = expected.by_features.iter().zip(deviations);
        let expected: Vec<_> = expected.map(|(by, deviation)| by * deviation).collect();
        let size = expected
            .iter()
            .fold(0.0, |most: f32, by| most.max(by.abs()));
        let (within, behind) = by_motion.split_at(expected.len());
        for (found, expected) in within.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-4 * size, "{found} {expected}");
        }
        assert!(behind.iter().all(|by| *by == 0.0));
    }
}

/// What the paper's table 2 compares: other numbers of spheres, and pairs that always touch.
#[test]
fn ablations_compare_other_spheres() {
    let (batch, statistics) = batch(0.0);
    let losses = |spheres, pairs| {
        let settings = SelfIntersectionSettings {
            spheres,
            pairs,
            ..SelfIntersectionSettings::default()
        };
        let loss = SelfIntersectionLoss::embedded(&statistics, settings);
        let found = loss.expect("embedded").evaluate(&batch, FRAMES, &LENGTHS);
        found.expect("finite").losses
    };
    let default = SelfIntersectionLoss::embedded(&statistics, SelfIntersectionSettings::default())
        .expect("embedded");
    let default = default.evaluate(&batch, FRAMES, &LENGTHS).expect("finite");
    let reduced = losses(192, SpherePairs::Reduced);
    assert_eq!(reduced, default.losses);
    for spheres in [128, 192, 256] {
        let of_size = losses(spheres, SpherePairs::Reduced);
        let all = losses(spheres, SpherePairs::All);
        for ((of_size, all), reduced) in of_size.iter().zip(&all).zip(&reduced) {
            assert!(
                *of_size > 0.0 && all > of_size,
                "{spheres}: {of_size} {all}"
            );
            // All sizes stand for one body.
            assert!(
                (0.25..4.0).contains(&(of_size / reduced)),
                "{spheres}: {of_size} {reduced}"
            );
            assert!(spheres == 192 || of_size != reduced, "{spheres}: {of_size}");
        }
    }
    let error = SelfIntersectionLoss::embedded(
        &statistics,
        SelfIntersectionSettings {
            spheres: 191,
            ..SelfIntersectionSettings::default()
        },
    );
    assert!(error.unwrap_err().to_string().contains("191"));
}

#[test]
fn padding_does_not_matter() {
    let of = |padding: f32| {
        let (batch, statistics) = batch(padding);
        let loss = SelfIntersectionLoss::embedded(&statistics, SelfIntersectionSettings::default())
            .expect("embedded");
        loss.evaluate(&batch, FRAMES, &LENGTHS).expect("finite")
    };
    assert_eq!(of(0.0), of(1e3));
    assert_eq!(of(0.0), of(f32::NAN));
}

/// Through a layer that adds to the motions, along random directions of its weights.
#[test]
fn gradient_through_a_network_equals_finite_differences() {
    const INPUTS: usize = 5;
    let (batch, statistics) = batch(0.0);
    let device = Device::flex().autodiff();
    let loss: Arc<dyn MotionLoss> = Arc::new(loss(GradientRule::Full, &statistics));
    let mut random = Random::new(&[71]);
    let mut normal = |count: usize| {
        let mut values = vec![0.0; count];
        random.fill_normal(&mut values);
        values
    };
    let shape = [LENGTHS.len(), FRAMES, COLUMNS];
    let inputs = normal(LENGTHS.len() * FRAMES * INPUTS);
    let inputs = TensorData::new(inputs, [LENGTHS.len(), FRAMES, INPUTS]);
    let inputs = Tensor::<3>::from_data(inputs, &device);
    let batch = Tensor::<3>::from_data(TensorData::new(batch, shape), &device);
    let mean = |weight: Tensor<2>| {
        let moved = inputs.clone().matmul(weight.unsqueeze::<3>()).tanh() * 0.1;
        losses(batch.clone() + moved, &LENGTHS, &loss).mean()
    };
    let of = |values: &[f32]| {
        let data = TensorData::new(values.to_vec(), [INPUTS, COLUMNS]);
        Tensor::<2>::from_data(data, &device)
    };
    let number = |tensor: Tensor<1>| f64::from(tensor.into_scalar::<f32>());
    let weight = normal(INPUTS * COLUMNS);
    let leaf = of(&weight).require_grad();
    let gradients = mean(leaf.clone()).backward();
    let gradient = leaf.grad(&gradients).expect("it depends on it");
    let gradient = gradient.into_data().try_into_vec::<f32>().expect("floats");
    for _ in 0..6 {
        let direction = normal(INPUTS * COLUMNS);
        let at = |step: f32| {
            let moved = weight.iter().zip(&direction);
            let moved: Vec<_> = moved.map(|(value, along)| value + step * along).collect();
            number(mean(of(&moved)))
        };
        let step = 2.0_f32.powi(-8);
        let difference = (at(step) - at(-step)) / (2.0 * f64::from(step));
        let along = gradient.iter().zip(&direction);
        let along: f64 = along.map(|(by, along)| f64::from(by * along)).sum();
        let size = gradient
            .iter()
            .map(|by| f64::from(by * by))
            .sum::<f64>()
            .sqrt();
        let far = (difference - along).abs();
        assert!(
            far < 0.02 * size,
            "{difference} {along}, gradient of {size}"
        );
    }
}

/// The batch above, at every step.
#[derive(Debug)]
struct Motions {
    features: Vec<f32>,
}

impl MotionSource for Motions {
    fn columns(&self) -> usize {
        COLUMNS
    }

    fn batch(&self, _size: usize, _seed: u64, _step: u64) -> Result<MotionBatch, Error> {
        Ok(MotionBatch {
            frames: FRAMES,
            features: self.features.clone(),
            lengths: LENGTHS.to_vec(),
            condition: BatchCondition::Nothing,
        })
    }
}

fn network(device: &Device) -> Mdm {
    let config = MdmConfig {
        width: 16,
        layers: 1,
        heads: 2,
        feed_forward: 32,
        condition: ConditionKind::Unconditioned,
        mask_frames: true,
        frames_per_token: 1,
        ..MdmConfig::default()
    };
    Mdm::new(&config, 5, device).expect("possible")
}

fn task(weight: f64) -> MdmTask<Motions> {
    let (features, statistics) = batch(0.0);
    let training = MdmTraining {
        batch: LENGTHS.len(),
        diffusion_steps: 20,
        self_intersection_weight: weight,
        ..MdmTraining::default()
    };
    MdmTask::new(Motions { features }, &statistics, training).expect("it fits")
}

/// The total is the squared error and the weighted loss, whose gradient reaches the network.
#[test]
fn the_task_adds_it_by_its_weight() {
    let device = Device::flex().autodiff();
    let network = network(&device);
    let of = |weight: f64| task(weight).loss(&network, 3, 0).expect("finite");
    let number = |tensor: &Tensor<1>| f64::from(tensor.clone().into_scalar::<f32>());
    let (without, with) = (of(0.0), of(0.5));
    let names = |loss: &physique_learn::trainer::Loss| -> Vec<&str> {
        loss.parts.iter().map(|(name, _)| *name).collect()
    };
    assert_eq!(names(&without), ["squared_error"]);
    assert_eq!(names(&with), ["squared_error", "self_intersection"]);
    let part = number(&with.parts[1].1);
    assert!(part > 0.0);
    let expected = number(&without.total) + 0.5 * part;
    let found = number(&with.total);
    assert!(
        (found - expected).abs() < 1e-5 * expected,
        "{found} {expected}"
    );
}

#[test]
fn a_weight_that_is_none_is_refused() {
    let (features, statistics) = batch(0.0);
    for weight in [-0.01, f64::NAN, f64::INFINITY] {
        let training = MdmTraining {
            self_intersection_weight: weight,
            ..MdmTraining::default()
        };
        let features = features.clone();
        let refused = MdmTask::new(Motions { features }, &statistics, training);
        let told = refused.expect_err("no weight").to_string();
        assert!(told.contains("self_intersection_weight"), "{told}");
    }
}

/// Features that no network learns from, but that are no numbers once they are squared.
#[test]
fn motions_that_are_none_stop_the_run() {
    let device = Device::flex().autodiff();
    let folder = tempfile::tempdir().expect("a folder");
    let (_, statistics) = batch(0.0);
    let mut task = task(0.01);
    let huge = FeatureStatistics::new(
        statistics.skeleton(),
        statistics.mean().to_vec(),
        vec![1e30; COLUMNS],
    );
    let loss = loss(GradientRule::ParentsConstant, &huge.expect("possible"));
    let loss = physique_learn::motion_loss::WeightedLoss::new("loss of giants", 1.0, loss);
    task = task.with_loss(loss.expect("a weight"));
    let config = TrainerConfig {
        steps: 3,
        ..TrainerConfig::default()
    };
    let mut trainer =
        Trainer::open(task, network(&device), config, folder.path()).expect("a new run");
    let told = trainer.run(|_| true).expect_err("no number").to_string();
    assert!(
        told.starts_with("Training, step 1: the loss of giants is NaN"),
        "{told}"
    );
}
