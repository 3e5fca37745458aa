//! Devices, motions and numbers.

use burn::tensor::{Device, Tensor};
use physique_learn::DeviceChoice;
use physique_motion::embedded;
use physique_motion::features::{
    FeatureSkeleton, FeatureStatistics, JointPositions, MotionFeatures, StatisticsGatherer, extract,
};
use physique_motion::mapping::BodyRest;

/// Frames that motions are padded to.
pub(crate) const FRAMES: usize = 12;
pub(crate) const LENGTHS: [usize; 3] = [12, 7, 9];

/// The device to compare with, where the machine has one.
pub(crate) fn gpu() -> Option<Device> {
    match DeviceChoice::Wgpu(None).open() {
        Ok(device) => Some(device),
        Err(problem) => {
            let required = std::env::var_os("PHYSIQUE_REQUIRE_GPU").is_some();
            assert!(!required, "PHYSIQUE_REQUIRE_GPU is set, but: {problem}");
            eprintln!("skipped: {problem}");
            None
        }
    }
}

pub(crate) fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_into_vec::<f32>().expect("floats")
}

/// Largest difference, as a share of the largest number.
pub(crate) fn difference(found: &[f32], expected: &[f32]) -> f32 {
    assert_eq!(found.len(), expected.len());
    let size = expected.iter().fold(0.0, |most: f32, x| most.max(x.abs()));
    assert!(size > 0.0, "nothing but zeros");
    let pairs = found.iter().zip(expected);
    let far = pairs.map(|(found, expected)| (found - expected).abs());
    far.fold(0.0, |most: f32, far| match far.is_nan() {
        true => f32::INFINITY,
        false => most.max(far),
    }) / size
}

/// Real motions' features, and their statistics.
fn features(skeleton: FeatureSkeleton) -> (Vec<MotionFeatures>, FeatureStatistics) {
    let body = physique::body::open_body().expect("embedded");
    let body = physique::body::Body::new(body, &[]).expect("mean shape");
    let mut gatherer = StatisticsGatherer::new(skeleton);
    let mut motions = Vec::new();
    for clip in embedded::clips().iter().take(LENGTHS.len()) {
        let motion = clip.load().expect("embedded").motion;
        let positions = JointPositions::from_motion(&motion, &BodyRest::from(&body));
        let positions = positions.expect("finite");
        let positions = match skeleton {
            FeatureSkeleton::HumanMl3d => positions,
            FeatureSkeleton::Kit => positions.to_kit_joints().expect("all joints"),
        };
        let features = extract(&positions).expect("frames");
        gatherer.add(&features).expect("of one skeleton");
        motions.push(features);
    }
    (motions, gatherer.finish().expect("they move"))
}

/// Normalised motions `[3][FRAMES][columns]`, with `padding` behind their ends. Bodies are pressed
/// together, so that there is something to lose.
pub(crate) fn batch(skeleton: FeatureSkeleton, padding: f32) -> (Vec<f32>, FeatureStatistics) {
    let (motions, statistics) = features(skeleton);
    let columns = skeleton.feature_count();
    let mut batch = vec![padding; LENGTHS.len() * FRAMES * columns];
    let places = batch.chunks_exact_mut(FRAMES * columns);
    for ((place, motion), length) in places.zip(&motions).zip(LENGTHS) {
        let within = &mut place[..length * columns];
        within.copy_from_slice(&motion.values()[..length * columns]);
        for row in within.chunks_exact_mut(columns) {
            for joint in 1..skeleton.joint_count() {
                row[4 + 3 * (joint - 1)] *= 0.2;
            }
        }
        statistics.normalise(within);
    }
    (batch, statistics)
}
