//! The loss on features: against finite differences, and where the published formula is NaN.

use glam::Vec3;
use physique_motion::FrameRate;
use physique_motion::features::{
    FeatureSkeleton, GradientRule, JointPositions, MotionFeatures, RotationLayer, extract,
    recover_from_positions,
};
use physique_proxy::{FeatureLoss, Pairs, Penalty, SelfIntersection, SphereBody, reference};

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
    let (body, pairs) = body();
    let loss = SelfIntersection::new(&body, &pairs).expect("sound");
    FeatureLoss::new(loss, RotationLayer::published(skeleton), rule)
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
            let along: f64 = by.map(|(by, along)| by * f64::from(*along)).sum();
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

#[test]
fn a_batch_is_its_motions() {
    let mut random = Random(47);
    let skeleton = FeatureSkeleton::HumanMl3d;
    let batch: Vec<_> = [9, 2, 33]
        .map(|frames| {
            let features = motion(skeleton, frames, &mut random);
            let weights = vec![0.1; features.frame_count()];
            (features, weights)
        })
        .to_vec();
    let loss = loss(skeleton, GradientRule::ParentsConstant);
    let together = loss.batch(&batch).expect("finite");
    for ((features, weights), together) in batch.iter().zip(together) {
        assert_eq!(loss.gradient(features, weights).expect("finite"), together);
    }
    let wrong = loss
        .gradient(&batch[0].0, &[1.0])
        .expect_err("one weight a frame");
    assert!(wrong.to_string().contains("Weights"), "{wrong}");
}
