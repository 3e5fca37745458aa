//! The slow reference against PyTorch and against finite differences.

use glam::{DMat3, DVec3, Vec3};
use physique_body::Joint;
use physique_proxy::{Pairs, Penalty, SphereBody, reference};

use crate::golden::Golden;
use crate::support::Random;

#[test]
fn posed_centres_equal_pytorch() {
    let mut golden = Golden::open();
    let (body, poses, expected) = (golden.body(), golden.poses(), golden.posed_centres());
    body.check().expect("a sound body");
    let mut centres = Vec::new();
    for (matrices, expected) in poses.iter().zip(expected.chunks(body.sphere_count())) {
        body.pose(matrices, &mut centres);
        let posed = reference::pose(&body, &reference::rotations(matrices), DVec3::ZERO);
        for ((fast, slow), expected) in centres.iter().zip(&posed.centres).zip(expected) {
            assert!(
                fast.as_dvec3().distance(*expected) < 1e-6,
                "{fast} {expected}"
            );
            assert!(slow.distance(*expected) < 1e-6, "{slow} {expected}");
        }
    }
}

#[test]
fn loss_and_gradient_equal_pytorch() {
    let mut golden = Golden::open();
    let (body, pairs, poses) = (golden.body(), golden.pairs(), golden.poses());
    let squared = golden.array("loss_L2");
    let by_rotations = golden.array("grad_rotmats_of_mean_L2");
    let by_rotations = by_rotations
        .as_chunks::<9>()
        .0
        .as_chunks::<{ Joint::COUNT }>()
        .0;
    let linear = golden.array("loss_L1");
    let tolerant = golden.array("loss_L1_tol001");
    for (frame, matrices) in poses.iter().enumerate() {
        let rotations = reference::rotations(matrices);
        let loss = |penalty, tolerance| {
            reference::self_intersection(&body, &pairs, penalty, tolerance, &rotations)
        };
        let (value, gradient) = loss(Penalty::Squared, 0.0);
        assert!((value - f64::from(squared[frame])).abs() < 2e-6, "{value}");
        let by_mean = gradient
            .rotations
            .map(|by| by.transpose() / poses.len() as f64);
        for (by, expected) in by_mean.iter().zip(&by_rotations[frame]) {
            for (by, expected) in by.to_cols_array().iter().zip(expected) {
                assert!((by - f64::from(*expected)).abs() < 5e-6, "{by} {expected}");
            }
        }
        let value = loss(Penalty::Linear, 0.0).0;
        assert!((value - f64::from(linear[frame])).abs() < 5e-6, "{value}");
        let value = loss(Penalty::Linear, 0.01).0;
        assert!((value - f64::from(tolerant[frame])).abs() < 5e-6, "{value}");
    }
}

/// Central differences of everything that the loss depends on, one number at a time.
#[test]
fn gradient_equals_finite_differences() {
    let mut random = Random(3);
    let body = random.body(30);
    let pairs = Pairs::all(30).expect("few");
    let rotations = reference::rotations(&random.pose(0.9));
    for (penalty, tolerance) in [(Penalty::Squared, 0.0), (Penalty::Linear, 0.01)] {
        let loss = |body: &SphereBody, rotations: &[DMat3; 22]| {
            reference::self_intersection(body, &pairs, penalty, tolerance, rotations).0
        };
        let gradient =
            reference::self_intersection(&body, &pairs, penalty, tolerance, &rotations).1;
        let mut seen = 0.0;
        for joint in 0..Joint::COUNT {
            for (axis, by_axis) in [
                gradient.rotations[joint].x_axis,
                gradient.rotations[joint].y_axis,
                gradient.rotations[joint].z_axis,
            ]
            .into_iter()
            .enumerate()
            {
                for row in 0..3 {
                    let at = |step: f64| {
                        let mut moved = rotations;
                        moved[joint].col_mut(axis)[row] += step;
                        loss(&body, &moved)
                    };
                    let step = 1e-6;
                    let difference = (at(step) - at(-step)) / (2.0 * step);
                    assert!(
                        (difference - by_axis[row]).abs() < 1e-6,
                        "{joint} {axis} {row}"
                    );
                    seen += difference.abs();
                }
            }
        }
        assert!(seen > 0.1, "the pose has contacts");
        // Rest numbers are f32: steps that f32 holds exactly, of numbers rounded to 2^-12.
        let step = 2.0_f32.powi(-9);
        let rounded = |vector: Vec3| (vector * 4096.0).round() / 4096.0;
        let mut body = body.clone();
        body.centres
            .iter_mut()
            .for_each(|centre| *centre = rounded(*centre));
        body.rest_joints = body.rest_joints.map(rounded);
        let gradient =
            reference::self_intersection(&body, &pairs, penalty, tolerance, &rotations).1;
        let check = |change: &dyn Fn(&mut SphereBody, f32), by: f64| {
            let at = |step: f32| {
                let mut moved = body.clone();
                change(&mut moved, step);
                loss(&moved, &rotations)
            };
            // Richardson's extrapolation: the error falls with the fourth power of the step.
            let slope = |step: f32| (at(step) - at(-step)) / (2.0 * f64::from(step));
            let difference = (4.0 * slope(step / 2.0) - slope(step)) / 3.0;
            // Where a pair begins to touch within the step, the linear penalty has a kink.
            let free = 1e-3 + 0.05 * by.abs();
            assert!((difference - by).abs() < free, "{difference} {by}");
        };
        if penalty == Penalty::Linear {
            continue;
        }
        for sphere in 0..body.sphere_count() {
            check(
                &|body, step| body.radii[sphere] += step,
                gradient.radii[sphere],
            );
            for axis in 0..3 {
                let by = gradient.centres[sphere][axis];
                check(&|body, step| body.centres[sphere][axis] += step, by);
            }
        }
        for joint in 0..Joint::COUNT {
            for axis in 0..3 {
                let by = gradient.rest_joints[joint][axis];
                check(&|body, step| body.rest_joints[joint][axis] += step, by);
            }
        }
    }
}
