//! The loss on features: against finite differences, and where the published formula is NaN.

use glam::Vec3;
use physique_motion::FrameRate;
use physique_motion::features::{
    FeatureLayout, FeatureSkeleton, FeatureStatistics, GradientRule, JointPositions,
    MotionFeatures, RotationLayer, extract, recover_from_positions,
    recover_from_positions_gradient, smpl_from_kit_gradient,
};
use physique_proxy::{
    Backend, FeatureBatch, FeatureLoss, Pairs, Penalty, SelfIntersection, SelfIntersectionOptions,
    SphereBody, reference,
};

use crate::support::Random;

/// Features of made-up wriggling joints about a standing body.
fn motion(skeleton: FeatureSkeleton, frames: usize, random: &mut Random) -> MotionFeatures {
    let rate = FrameRate::new(20.0).expect("positive");
    let stance = [
        [0.0, 0.9, 0.0],
        [0.07, 0.8, 0.0],
        [-0.07, 0.8, 0.0],
        [0.0, 1.0, 0.0],
        [0.1, 0.45, 0.0],
        [-0.1, 0.45, 0.0],
        [0.0, 1.15, 0.0],
        [0.09, 0.07, -0.03],
        [-0.09, 0.07, -0.03],
        [0.0, 1.2, 0.0],
        [0.1, 0.0, 0.1],
        [-0.1, 0.0, 0.1],
        [0.0, 1.4, 0.0],
        [0.08, 1.3, 0.0],
        [-0.08, 1.3, 0.0],
        [0.0, 1.5, 0.05],
        [0.17, 1.35, 0.0],
        [-0.17, 1.35, 0.0],
        [0.4, 1.3, 0.0],
        [-0.4, 1.3, 0.0],
        [0.6, 1.25, 0.1],
        [-0.6, 1.25, 0.1],
    ]
    .map(Vec3::from_array);
    let swing: Vec<Vec3> = (0..22).map(|_| 0.08 * random.vector()).collect();
    let mut positions = Vec::new();
    for frame in 0..frames {
        let phase = 0.3 * frame as f32;
        for (joint, &at) in stance.iter().enumerate() {
            positions.push(at + swing[joint] * (phase + joint as f32).sin());
        }
    }
    let positions = JointPositions::new(rate, FeatureSkeleton::HumanMl3d, positions);
    let positions = positions.expect("finite");
    let positions = match skeleton {
        FeatureSkeleton::HumanMl3d => positions,
        FeatureSkeleton::Kit => positions.to_kit_joints().expect("finite"),
    };
    extract(&positions).expect("sound")
}

/// Spheres that touch in every pose.
fn body() -> (SphereBody, Pairs) {
    let mut body = Random(41).body(60);
    body.radii.iter_mut().for_each(|radius| *radius *= 2.0);
    (body, Pairs::all(60).expect("few"))
}

fn loss(skeleton: FeatureSkeleton, rule: GradientRule) -> FeatureLoss {
    loss_of(skeleton, rule, Backend::best())
}

fn loss_of(skeleton: FeatureSkeleton, rule: GradientRule, backend: Backend) -> FeatureLoss {
    let (body, pairs) = body();
    let options = SelfIntersectionOptions {
        backend: Some(backend),
        ..SelfIntersectionOptions::default()
    };
    let loss = SelfIntersection::with_options(&body, &pairs, &options).expect("sound");
    FeatureLoss::new(loss, &RotationLayer::published(skeleton), rule)
}

/// Value and gradient of the weighted loss in 64 bits, by way of the motion's path.
fn slow_gradient(
    features: &MotionFeatures,
    weights: &[f32],
    rule: GradientRule,
) -> (f64, Vec<f64>) {
    let (body, pairs) = body();
    let layer = RotationLayer::published(features.skeleton());
    let positions = recover_from_positions(features).expect("finite");
    let positions = positions.to_smpl_joints().expect("finite");
    let (mut sum, mut by_positions) = (0.0, Vec::new());
    for (joints, &weight) in positions.positions().as_chunks().0.iter().zip(weights) {
        let rotations = layer.rotations(joints);
        let squared = Penalty::Squared;
        let (value, by) = reference::self_intersection(&body, &pairs, squared, 0.0, &rotations);
        sum += value * f64::from(weight);
        let by_rotations = by.rotations.map(|by| by * f64::from(weight));
        let by_joints = layer.gradient(joints, &by_rotations, rule);
        match features.skeleton() {
            FeatureSkeleton::HumanMl3d => by_positions.extend(by_joints),
            FeatureSkeleton::Kit => by_positions.extend(smpl_from_kit_gradient(&by_joints)),
        }
    }
    let by_features = recover_from_positions_gradient(features, &by_positions);
    (sum, by_features.expect("of one length"))
}

/// Both rules, both skeletons, all vector instructions, against 64 bits.
#[test]
fn value_and_gradient_are_those_of_the_slow_layer() {
    for skeleton in [FeatureSkeleton::HumanMl3d, FeatureSkeleton::Kit] {
        let features = motion(skeleton, 21, &mut Random(53));
        let frames = features.frame_count();
        let weights: Vec<_> = (0..frames).map(|frame| 0.2 + 0.1 * frame as f32).collect();
        for rule in [GradientRule::ParentsConstant, GradientRule::Full] {
            let (expected, by_features) = slow_gradient(&features, &weights, rule);
            let all = by_features
                .iter()
                .fold(0.0, |most: f64, by| most.max(by.abs()));
            // Columns of one block are of one size.
            let blocks = FeatureLayout::of(skeleton).blocks();
            for backend in Backend::available() {
                let loss = loss_of(skeleton, rule, backend);
                let found = loss.gradient(&features, &weights).expect("finite");
                let terms = found.losses.iter().zip(&weights);
                let value: f64 = terms.map(|(loss, weight)| f64::from(loss * weight)).sum();
                assert!((value / expected - 1.0).abs() < 1e-5, "{value} {expected}");
                for block in &blocks {
                    let columns = features.skeleton().feature_count();
                    let pairs = (0..frames).flat_map(|frame| {
                        block.clone().map(move |column| frame * columns + column)
                    });
                    let pairs = pairs
                        .map(|index| (by_features[index], f64::from(found.by_features[index])));
                    let (mut most, mut worst) = (0.0_f64, 0.0_f64);
                    for (expected, found) in pairs {
                        most = most.max(expected.abs());
                        worst = worst.max((expected - found).abs());
                    }
                    // A path moves nothing: what is left there is rounding of all others, and a
                    // turn moves joints by their distance.
                    let unit = match block.start {
                        0 => skeleton.metres_per_unit().recip(),
                        _ => 1.0,
                    };
                    let size = most.max(0.1 * all * unit);
                    assert!(
                        worst < 1e-4 * size,
                        "{skeleton:?} {rule:?} {backend} {block:?}: {worst} of {most}"
                    );
                }
            }
        }
    }
}

/// Features of one frame whose joints, as seen in the root's heading, are given.
fn frame_of(joints: &[Vec3; 22]) -> MotionFeatures {
    let skeleton = FeatureSkeleton::HumanMl3d;
    let mut row = vec![0.0; skeleton.feature_count()];
    row[3] = joints[0].y;
    for (place, joint) in row[4..67].chunks_exact_mut(3).zip(&joints[1..]) {
        place.copy_from_slice(&joint.to_array());
    }
    let rate = FrameRate::new(20.0).expect("positive");
    MotionFeatures::new(rate, skeleton, row).expect("finite")
}

/// The body at rest, facing +Z exactly.
fn rest() -> [Vec3; 22] {
    let layer = RotationLayer::published(FeatureSkeleton::HumanMl3d);
    let mut joints = [Vec3::Y; 22];
    for joint in physique_body::Joint::ALL {
        if let Some(parent) = joint.parent() {
            let bone = layer.rest_directions()[parent.index()];
            let bone = bone.map_or(
                FeatureSkeleton::HumanMl3d.offsets()[joint.index()],
                |bone| 0.3 * bone.as_vec3(),
            );
            joints[joint.index()] = joints[parent.index()] + bone;
        }
    }
    joints
}

/// A shin folded onto the thigh: exactly, where any axis is as good as another, and nearly.
#[test]
fn folded_bones_are_those_of_the_slow_layer() {
    let [knee, ankle] = [4, 7];
    let layer = RotationLayer::published(FeatureSkeleton::HumanMl3d);
    let shin = layer.rest_directions()[knee]
        .expect("it has a bone")
        .as_vec3();
    for (angle, tolerance) in [(0.0, 1e-4), (1e-3, 1e-2), (1e-2, 1e-3), (0.1, 1e-4)] {
        let mut joints = rest();
        let aside = angle * shin.any_orthonormal_vector();
        joints[ankle] = joints[knee] - 0.3 * shin + 0.3 * aside;
        let features = frame_of(&joints);
        for rule in [GradientRule::ParentsConstant, GradientRule::Full] {
            let (expected, by_features) = slow_gradient(&features, &[1.0], rule);
            for backend in Backend::available() {
                let loss = loss_of(FeatureSkeleton::HumanMl3d, rule, backend);
                let found = loss.gradient(&features, &[1.0]).expect("finite");
                let value = f64::from(found.losses[0]);
                let close = (value / expected - 1.0).abs() < tolerance;
                assert!(close, "{angle} {backend}: {value} {expected}");
                let size = by_features
                    .iter()
                    .fold(0.0, |most: f64, by| most.max(by.abs()));
                for (by, expected) in found.by_features.iter().zip(&by_features) {
                    let far = (f64::from(*by) - expected).abs();
                    assert!(far < tolerance * size, "{angle} {backend}: {by} {expected}");
                }
            }
        }
    }
}

/// All joints in one place: no heading, no bones. The body rests.
#[test]
fn joints_in_one_place_rest() {
    let (body, pairs) = body();
    let rest = [glam::DMat3::IDENTITY; 22];
    let rest = reference::self_intersection(&body, &pairs, Penalty::Squared, 0.0, &rest).0;
    let features = frame_of(&[Vec3::ZERO; 22]);
    for rule in [GradientRule::ParentsConstant, GradientRule::Full] {
        for backend in Backend::available() {
            let loss = loss_of(FeatureSkeleton::HumanMl3d, rule, backend);
            let found = loss.gradient(&features, &[1.0]).expect("finite");
            assert!((f64::from(found.losses[0]) / rest - 1.0).abs() < 1e-5);
            assert!(found.by_features.iter().all(|by| *by == 0.0));
        }
    }
}

/// Deviations of a normalisation are factors of the gradient.
#[test]
fn normalised_features_are_the_features() {
    let skeleton = FeatureSkeleton::HumanMl3d;
    let mut random = Random(61);
    let features = motion(skeleton, 9, &mut random);
    let columns = skeleton.feature_count();
    let mean = (0..columns).map(|_| random.next()).collect();
    let deviation: Vec<_> = (0..columns).map(|_| 1.5 + random.next()).collect();
    let statistics = FeatureStatistics::new(skeleton, mean, deviation.clone()).expect("possible");
    let mut normalised = features.values().to_vec();
    statistics.normalise(&mut normalised);
    let weights = vec![0.5; features.frame_count()];
    let loss = loss(skeleton, GradientRule::ParentsConstant);
    let expected = loss.gradient(&features, &weights).expect("finite");
    let found = loss.batch(&FeatureBatch {
        skeleton,
        statistics: Some(&statistics),
        features: &normalised,
        frames: features.frame_count(),
        lengths: &[features.frame_count()],
        weights: &weights,
    });
    let found = found.expect("finite");
    let most = |values: &[f32]| values.iter().fold(0.0, |most: f32, by| most.max(by.abs()));
    for (found, expected) in found.losses.iter().zip(&expected.losses) {
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
    }
    let size = most(&expected.by_features);
    let rows = expected.by_features.chunks_exact(columns);
    let expected = rows.flat_map(|row| row.iter().zip(&deviation).map(|(by, d)| by * d));
    for (found, expected) in found.by_features.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-3 * size, "{found} {expected}");
    }
}

/// The weighted loss by the slow reference.
fn slow(features: &MotionFeatures, weights: &[f32]) -> f64 {
    let (body, pairs) = body();
    let layer = RotationLayer::published(features.skeleton());
    let positions = recover_from_positions(features).expect("finite");
    let positions = positions.to_smpl_joints().expect("finite");
    let frames = positions.positions().as_chunks().0.iter().zip(weights);
    let terms = frames.map(|(joints, weight)| {
        let rotations = layer.rotations(joints);
        let squared = Penalty::Squared;
        reference::self_intersection(&body, &pairs, squared, 0.0, &rotations).0 * f64::from(*weight)
    });
    terms.sum()
}

/// With the full rule the gradient is the derivative of what is computed.
#[test]
fn full_gradient_equals_finite_differences() {
    for skeleton in [FeatureSkeleton::HumanMl3d, FeatureSkeleton::Kit] {
        let mut random = Random(43);
        let features = motion(skeleton, 6, &mut random);
        let frames = features.frame_count();
        let weights: Vec<_> = (0..frames).map(|frame| 0.2 + 0.1 * frame as f32).collect();
        let loss = loss(skeleton, GradientRule::Full);
        let gradient = loss.gradient(&features, &weights).expect("finite");
        assert_eq!(gradient.losses, loss.losses(&features).expect("finite"));
        let value: f64 = gradient
            .losses
            .iter()
            .zip(&weights)
            .map(|(l, w)| f64::from(l * w))
            .sum();
        let expected = slow(&features, &weights);
        assert!((value / expected - 1.0).abs() < 1e-5, "{value} {expected}");
        // Along directions, not columns: features are f32, and one alone moves too little.
        let unit = match skeleton {
            FeatureSkeleton::HumanMl3d => 1.0,
            FeatureSkeleton::Kit => 600.0,
        };
        let rate = features.frame_rate();
        for _ in 0..8 {
            let direction: Vec<f32> = features.values().iter().map(|_| random.next()).collect();
            let at = |step: f32| {
                let values = features.values().iter().zip(&direction);
                let moved = values.map(|(value, along)| value + step * along).collect();
                slow(
                    &MotionFeatures::new(rate, skeleton, moved).expect("finite"),
                    &weights,
                )
            };
            let step = 2.0_f32.powi(-13) * unit;
            let difference = (at(step) - at(-step)) / (2.0 * f64::from(step));
            let by = gradient.by_features.iter().zip(&direction);
            let along: f64 = by.map(|(by, along)| f64::from(by * along)).sum();
            let size = along.abs().max(0.5 / f64::from(unit));
            assert!(
                (difference - along).abs() < 0.01 * size,
                "{skeleton:?}: {difference} {along}"
            );
        }
    }
}

/// A body that faces +Z exactly, with bones along their rest directions: 0/0 in the published form.
#[test]
fn rest_has_a_finite_gradient() {
    for rule in [GradientRule::ParentsConstant, GradientRule::Full] {
        let skeleton = FeatureSkeleton::HumanMl3d;
        let rate = FrameRate::new(20.0).expect("positive");
        let offsets = skeleton.offsets();
        let mut joints = [Vec3::Y; 22];
        for joint in physique_body::Joint::ALL {
            if let Some(parent) = joint.parent() {
                joints[joint.index()] = joints[parent.index()] + offsets[joint.index()];
            }
        }
        let positions = JointPositions::new(rate, skeleton, [joints; 4].as_flattened().to_vec());
        let features = extract(&positions.expect("finite")).expect("sound");
        let frames = features.frame_count();
        let gradient = loss(skeleton, rule).gradient(&features, &vec![1.0; frames]);
        let gradient = gradient.expect("finite");
        assert!(
            gradient
                .losses
                .iter()
                .all(|loss| loss.is_finite() && *loss > 0.0)
        );
        assert!(gradient.by_features.iter().all(|by| by.is_finite()));
    }
}

/// Motions of three lengths in one batch, with NaN behind their ends.
#[test]
fn a_batch_is_its_motions() {
    let mut random = Random(47);
    let skeleton = FeatureSkeleton::HumanMl3d;
    let (columns, frames) = (skeleton.feature_count(), 40);
    let motions = [9, 2, 33].map(|frames| motion(skeleton, frames, &mut random));
    let lengths = motions.each_ref().map(MotionFeatures::frame_count);
    let mut features = vec![f32::NAN; 3 * frames * columns];
    for (padded, motion) in features.chunks_exact_mut(frames * columns).zip(&motions) {
        padded[..motion.values().len()].copy_from_slice(motion.values());
    }
    let weights: Vec<_> = (0..lengths.iter().sum())
        .map(|frame: usize| 0.1 + frame as f32)
        .collect();
    let batch = FeatureBatch {
        skeleton,
        statistics: None,
        features: &features,
        frames,
        lengths: &lengths,
        weights: &weights,
    };
    let loss = loss(skeleton, GradientRule::ParentsConstant);
    let together = loss.batch(&batch).expect("finite");
    let mut first = 0;
    let by_motions = together.by_features.chunks_exact(frames * columns);
    for (motion, by_motion) in motions.iter().zip(by_motions) {
        let within = first..first + motion.frame_count();
        first = within.end;
        let alone = loss
            .gradient(motion, &weights[within.clone()])
            .expect("finite");
        assert_eq!(alone.losses, together.losses[within]);
        let (by_motion, behind) = by_motion.split_at(motion.values().len());
        assert_eq!(alone.by_features, by_motion);
        assert!(behind.iter().all(|by| *by == 0.0));
    }
    let wrong = loss.gradient(&motions[0], &[1.0]);
    let wrong = wrong.expect_err("one weight a frame").to_string();
    assert!(wrong.contains("Weights"), "{wrong}");
    let shorter = FeatureBatch {
        frames: 39,
        ..batch
    };
    let wrong = loss.batch(&shorter).expect_err("more numbers").to_string();
    assert!(
        wrong.starts_with("Features: expected 3 motions of up to 39 x 263"),
        "{wrong}"
    );
}

/// Numbers that are none, and numbers that cannot be squared, are refused with their frame.
#[test]
fn features_that_are_none_are_refused() {
    let skeleton = FeatureSkeleton::HumanMl3d;
    let features = motion(skeleton, 30, &mut Random(67));
    let (columns, frames) = (skeleton.feature_count(), features.frame_count());
    let weights = vec![1.0; frames];
    let loss = loss(skeleton, GradientRule::ParentsConstant);
    let told = |column: usize, number: f32| {
        let mut values = features.values().to_vec();
        values[17 * columns + column] = number;
        let batch = FeatureBatch {
            skeleton,
            statistics: None,
            features: &values,
            frames,
            lengths: &[frames],
            weights: &weights,
        };
        loss.batch(&batch).expect_err("no number").to_string()
    };
    assert!(told(1, f32::NAN).starts_with("Frame 17: expected finite numbers for pelvis"));
    let elbow = 4 + 3 * 17;
    assert!(
        told(elbow, f32::INFINITY).starts_with("Frame 17: expected finite numbers for left_elbow")
    );
    assert!(told(elbow, 3e30).starts_with("Frame 17: the posed spheres are too far away"));
}
