//! What must not change the loss: threads, where a body faces, and which side is left.

use glam::{Mat3, Quat, Vec3};
use physique_body::Joint;
use physique_proxy::{
    Backend, Pairs, PoseMatrices, SelfIntersection, SelfIntersectionOptions, ShapeGradient,
    SphereBody,
};

use crate::real;
use crate::support::Random;

struct Evaluated {
    losses: Vec<f32>,
    by_poses: Vec<PoseMatrices>,
    shape: ShapeGradient,
}

fn evaluate(
    body: &SphereBody,
    pairs: &Pairs,
    backend: Backend,
    poses: &[PoseMatrices],
) -> Evaluated {
    let options = SelfIntersectionOptions {
        backend: Some(backend),
        ..Default::default()
    };
    let loss = SelfIntersection::with_options(body, pairs, &options).expect("sound");
    let mut losses = vec![0.0; poses.len()];
    let mut by_poses = vec![[[0.0; 9]; 22]; poses.len()];
    let weights = vec![1.0; poses.len()];
    let shape = loss.shape_gradient(poses, &weights, &mut losses, &mut by_poses);
    Evaluated {
        losses,
        by_poses,
        shape: shape.expect("finite"),
    }
}

/// To the bit, also for sums over frames.
#[test]
fn threads_change_nothing() {
    let mut random = Random(17);
    let body = random.body(48);
    let pairs = Pairs::all(48).expect("few");
    let poses: Vec<_> = (0..1003).map(|_| random.pose(1.5)).collect();
    for backend in Backend::available() {
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads")
                .install(|| evaluate(&body, &pairs, backend, &poses))
        };
        let alone = with(1);
        assert!(alone.losses.iter().sum::<f32>() > 1.0);
        for threads in [2, 3, 7] {
            let together = with(threads);
            assert_eq!(alone.losses, together.losses);
            assert_eq!(alone.by_poses, together.by_poses);
            assert_eq!(alone.shape, together.shape);
        }
    }
}

/// A frame's loss does not depend on its neighbours.
#[test]
fn frames_are_independent() {
    let mut random = Random(23);
    let body = random.body(48);
    let pairs = Pairs::all(48).expect("few");
    let poses: Vec<_> = (0..61).map(|_| random.pose(1.5)).collect();
    for backend in Backend::available() {
        let whole = evaluate(&body, &pairs, backend, &poses);
        for frame in [0, 15, 16, 60] {
            let one = evaluate(&body, &pairs, backend, &poses[frame..=frame]);
            assert!((one.losses[0] - whole.losses[frame]).abs() < 1e-6);
            let differences = one.by_poses[0].iter().flatten();
            for (one, whole) in differences.zip(whole.by_poses[frame].iter().flatten()) {
                assert!((one - whole).abs() < 1e-5, "{one} {whole}");
            }
        }
    }
}

fn rotation(matrix: &[f32; 9]) -> Mat3 {
    Mat3::from_cols_array(matrix).transpose()
}

#[test]
fn turning_the_whole_body_changes_nothing() {
    let (body, pairs) = real::body_and_pairs();
    let mut poses = real::poses();
    poses.truncate(200);
    let turn = Mat3::from_quat(Quat::from_euler(glam::EulerRot::YXZ, 2.0, 0.7, -0.4));
    let mut turned = poses.clone();
    for pose in &mut turned {
        pose[0] = (turn * rotation(&pose[0])).transpose().to_cols_array();
    }
    for backend in Backend::available() {
        let (first, second) = (
            evaluate(&body, &pairs, backend, &poses),
            evaluate(&body, &pairs, backend, &turned),
        );
        assert!(first.losses.iter().sum::<f32>() > 0.1);
        for (first, second) in first.losses.iter().zip(&second.losses) {
            assert!((first - second).abs() < 1e-5, "{first} {second}");
        }
        for (first, second) in first.by_poses.iter().zip(&second.by_poses) {
            for joint in 1..Joint::COUNT {
                for (first, second) in first[joint].iter().zip(&second[joint]) {
                    assert!((first - second).abs() < 2e-5, "{first} {second}");
                }
            }
        }
    }
}

/// A mirrored body in mirrored poses.
#[test]
fn mirrors_change_nothing() {
    let (body, pairs) = real::body_and_pairs();
    let poses = real::poses();
    let flip = Vec3::new(-1.0, 1.0, 1.0);
    let mirror = |joint: usize| Joint::ALL[joint].mirrored().index();
    let mirrored_body = SphereBody {
        rest_joints: std::array::from_fn(|joint| body.rest_joints[mirror(joint)] * flip),
        centres: body.centres.iter().map(|&centre| centre * flip).collect(),
        radii: body.radii.clone(),
        blend_weights: body
            .blend_weights
            .iter()
            .map(|row| row.map(|(joint, weight)| (mirror(joint.into()) as u8, weight)))
            .collect(),
    };
    let flip = Mat3::from_diagonal(flip);
    let mirrored: Vec<PoseMatrices> = poses
        .iter()
        .map(|pose| {
            std::array::from_fn(|joint| {
                let rotation = flip * rotation(&pose[mirror(joint)]) * flip;
                rotation.transpose().to_cols_array()
            })
        })
        .collect();
    for backend in Backend::available() {
        let first = evaluate(&body, &pairs, backend, &poses);
        let second = evaluate(&mirrored_body, &pairs, backend, &mirrored);
        for (first, second) in first.losses.iter().zip(&second.losses) {
            assert!((first - second).abs() < 1e-5, "{first} {second}");
        }
    }
}
