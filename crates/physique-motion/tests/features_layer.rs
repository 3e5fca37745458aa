//! The rotation layer's gradients against finite differences, and its behaviour where the published
//! formula is not a number.

#![allow(clippy::unwrap_used)]

use glam::{DMat3, DVec3, Vec3};
use physique_body::Joint;
use physique_motion::FrameRate;
use physique_motion::features::{
    FeatureSkeleton, GradientRule, MotionFeatures, RotationLayer, recover_from_positions,
    recover_from_positions_gradient, smpl_from_kit, smpl_from_kit_gradient,
};
use proptest::prelude::*;

mod support;

/// Positions up to an eighth of a metre around the standing figure's, exactly representable
/// after a step of [`STEP`].
fn joints() -> impl Strategy<Value = [Vec3; 22]> {
    prop::collection::vec(-64_i8..=64, 66).prop_map(|numbers| {
        let figure = support::figure().joints;
        std::array::from_fn(|joint| {
            let near = |axis: usize| f32::from(numbers[3 * joint + axis]) / 512.0;
            let grid = (figure[joint] * 256.0).round() / 256.0;
            grid + Vec3::new(near(0), near(1), near(2))
        })
    })
}

fn weights() -> impl Strategy<Value = [DMat3; 22]> {
    prop::collection::vec(-1.0..1.0_f64, 198).prop_map(|numbers| {
        std::array::from_fn(|joint| {
            let columns = numbers[9 * joint..9 * joint + 9].try_into().unwrap();
            DMat3::from_cols_array(columns)
        })
    })
}

const STEP: f32 = 1.0 / 4096.0;

fn dot(a: &[DMat3; 22], b: &[DMat3; 22]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs
        .map(|(a, b)| (0..3).map(|axis| a.col(axis).dot(b.col(axis))).sum::<f64>())
        .sum()
}

/// Richardson's extrapolation of central differences: error of the fourth order.
fn difference(loss: impl Fn(f32) -> f64) -> f64 {
    let central = |step: f32| (loss(step) - loss(-step)) / f64::from(2.0 * step);
    (4.0 * central(STEP) - central(2.0 * STEP)) / 3.0
}

/// Whether a step across the joints stays far from folded bones and bones without length, where
/// there is no derivative or a huge one.
fn is_smooth(layer: &RotationLayer, joints: &[Vec3; 22]) -> bool {
    let long = Joint::ALL.iter().all(|joint| {
        joint
            .parent()
            .is_none_or(|parent| joints[joint.index()].distance(joints[parent.index()]) > 0.05)
    });
    let chest = [Joint::Neck, Joint::LeftCollar, Joint::RightCollar]
        .map(|joint| (joints[joint.index()] - joints[Joint::Spine3.index()]).normalize());
    let local = layer.rotations(joints);
    let trace = |matrix: &DMat3| matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z;
    long && chest.iter().sum::<Vec3>().length() > 0.5
        && local[1..].iter().all(|matrix| trace(matrix) > -0.5)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_full_gradient_is_the_derivative(joints in joints(), weights in weights()) {
        let layer = RotationLayer::published(FeatureSkeleton::HumanMl3d);
        prop_assume!(is_smooth(&layer, &joints));
        let gradient = layer.gradient(&joints, &weights, GradientRule::Full);
        for joint in 0..22 {
            for axis in 0..3 {
                let slope = difference(|step| {
                    let mut moved = joints;
                    moved[joint][axis] += step;
                    dot(&layer.rotations(&moved), &weights)
                });
                let ours = gradient[joint][axis];
                prop_assert!((ours - slope).abs() < 1e-4 * (1.0 + slope.abs()), "joint {joint} axis {axis}: {ours} {slope}");
            }
        }
    }

    /// Under the published rule the derivative is of a rotation whose parents are held: so much of
    /// the loss as comes from one joint, with the parents' rotations put back.
    #[test]
    fn the_published_gradient_holds_parents(joints in joints(), weights in weights()) {
        let layer = RotationLayer::published(FeatureSkeleton::Kit);
        prop_assume!(is_smooth(&layer, &joints));
        let gradient = layer.gradient(&joints, &weights, GradientRule::ParentsConstant);
        let held = layer.rotations(&joints);
        for joint in 0..22 {
            for axis in 0..3 {
                let slope = difference(|step| {
                    let mut moved = joints;
                    moved[joint][axis] += step;
                    dot(&with_parents_held(&layer.rotations(&moved), &moved, &held), &weights)
                });
                let ours = gradient[joint][axis];
                prop_assert!((ours - slope).abs() < 1e-4 * (1.0 + slope.abs()), "joint {joint} axis {axis}: {ours} {slope}");
            }
        }
    }

    #[test]
    fn rotations_are_rotations_that_point_the_bones_and_never_nan(joints in joints()) {
        let layer = RotationLayer::published(FeatureSkeleton::HumanMl3d);
        for rotation in layer.rotations(&joints) {
            prop_assert!((rotation.determinant() - 1.0).abs() < 1e-9);
            prop_assert!((rotation * rotation.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-9));
        }
    }

    #[test]
    fn the_gradient_of_recovery_is_the_derivative(
        values in prop::collection::vec(-8_i8..=8, 263 * 4),
        weights in prop::collection::vec(-1.0..1.0_f64, 22 * 3 * 4),
    ) {
        let rate = FrameRate::new(20.0).unwrap();
        let skeleton = FeatureSkeleton::HumanMl3d;
        let values: Vec<f32> = values.into_iter().map(|value| f32::from(value) / 16.0).collect();
        let weights: Vec<DVec3> = weights.as_chunks().0.iter().copied().map(DVec3::from_array).collect();
        let loss = |values: &[f32]| {
            let features = MotionFeatures::new(rate, skeleton, values.to_vec()).unwrap();
            let positions = recover_from_positions(&features).unwrap();
            let terms = positions.positions().iter().zip(&weights);
            terms.map(|(position, weight)| position.as_dvec3().dot(*weight)).sum::<f64>()
        };
        let features = MotionFeatures::new(rate, skeleton, values.clone()).unwrap();
        let gradient = recover_from_positions_gradient(&features, &weights).unwrap();
        for index in (0..values.len()).filter(|index| index % 263 < 6 || index % 29 == 0) {
            // Positions are 32-bit: a large step against their rounding, twice for the curvature.
            let central = |step: f32| {
                let at = |sign: f32| {
                    let mut moved = values.clone();
                    moved[index] += sign * step;
                    loss(&moved)
                };
                (at(1.0) - at(-1.0)) / f64::from(2.0 * step)
            };
            let slope = (4.0 * central(1.0 / 32.0) - central(1.0 / 16.0)) / 3.0;
            let ours = gradient[index];
            prop_assert!((ours - slope).abs() < 2e-3 * (1.0 + slope.abs()), "column {}: {ours} {slope}", index % 263);
        }
    }

    #[test]
    fn kits_joints_and_their_gradient_are_transposes(
        joints in prop::collection::vec(-64_i8..=64, 63),
        weights in prop::collection::vec(-1.0..1.0_f64, 66),
    ) {
        let joints: Vec<f32> = joints.into_iter().map(f32::from).collect();
        let joints: Vec<Vec3> = joints.as_chunks().0.iter().copied().map(Vec3::from_array).collect();
        let weights: [DVec3; 22] = std::array::from_fn(|joint| DVec3::from_slice(&weights[3 * joint..]));
        let smpl = smpl_from_kit(&joints).unwrap();
        let forward: f64 = smpl.iter().zip(weights).map(|(joint, weight)| joint.as_dvec3().dot(weight)).sum();
        let back = smpl_from_kit_gradient(&weights);
        let backward: f64 = joints.iter().zip(back).map(|(joint, weight)| joint.as_dvec3().dot(weight)).sum();
        prop_assert!((forward - backward).abs() < 1e-9 * (1.0 + forward.abs()));
    }
}

/// Rotations of `moved` as they would be if every parent still had the rotation of `held`: what a
/// joint's bones ask for in the parent's old frame.
fn with_parents_held(
    moved_local: &[DMat3; 22],
    moved: &[Vec3; 22],
    held: &[DMat3; 22],
) -> [DMat3; 22] {
    // An independent way: turn the joint's bones into the held parent's frame, then swing the rest
    // direction there with a quaternion.
    let (mut held_world, mut moved_world) = (*held, *moved_local);
    let mut result = *moved_local;
    for joint in &Joint::ALL[1..] {
        let (joint, parent) = (joint.index(), joint.parent().unwrap().index());
        let (held_parent, moved_parent) = (held_world[parent], moved_world[parent]);
        held_world[joint] = held_parent * held[joint];
        moved_world[joint] = moved_parent * moved_local[joint];
        let children = Joint::ALL
            .into_iter()
            .filter(|child| child.parent().is_some_and(|parent| parent.index() == joint));
        let bones =
            children.map(|child| (moved[child.index()] - moved[joint]).as_dvec3().normalize());
        let sum: DVec3 = bones.sum();
        if sum != DVec3::ZERO {
            let now = sum.normalize();
            // The layer turns `rest` to `now`: `rest` is what its own rotation takes there.
            let rest = moved_world[joint].transpose() * now;
            let swing = glam::DQuat::from_rotation_arc(rest, held_parent.transpose() * now);
            result[joint] = DMat3::from_quat(swing);
        }
    }
    result
}

#[test]
fn a_body_at_rest_that_faces_z_is_all_identities() {
    let figure = support::figure();
    let layer = RotationLayer::for_body(&figure);
    for rotation in layer.rotations(&figure.joints) {
        assert!(rotation.abs_diff_eq(DMat3::IDENTITY, 1e-6), "{rotation:?}");
    }
}

#[test]
fn folded_bones_missing_bones_and_no_heading_stay_finite() {
    let figure = support::figure();
    let layer = RotationLayer::for_body(&figure);
    let weights = [DMat3::from_cols_array(&[0.3; 9]); 22];

    let mut folded = figure.joints;
    let elbow = Joint::LeftElbow.index();
    let upper_arm = folded[elbow] - folded[Joint::LeftShoulder.index()];
    folded[elbow] -= 2.0 * upper_arm;
    let in_one_place = [Vec3::ONE; 22];
    let mut backwards = figure.joints;
    for joint in &mut backwards {
        *joint *= Vec3::new(-1.0, 1.0, -1.0);
    }
    for joints in [folded, in_one_place, backwards] {
        assert!(
            layer
                .rotations(&joints)
                .iter()
                .all(|rotation| rotation.is_finite())
        );
        for rule in [GradientRule::ParentsConstant, GradientRule::Full] {
            let gradient = layer.gradient(&joints, &weights, rule);
            assert!(gradient.iter().all(|vector| vector.is_finite()));
        }
    }
    let turned = layer.rotations(&backwards)[0];
    assert!(turned.abs_diff_eq(DMat3::from_rotation_y(std::f64::consts::PI), 1e-6));
}
