//! Posing: equal to the slow reference, and indifferent to where the world's axes lie.

mod support;

use std::sync::Arc;

use glam::{Quat, Vec3};
use physique_body::{
    BlendWeights, Body, BodyArrays, BodyModel, Error, Joint, JointRegressor, Pose, open_body_low,
};
use proptest::prelude::*;
use support::{
    any_rotation, any_rotations, double, largest_distance, mirrored, reference_vertices,
};

/// f32 arithmetic over chains of up to 9 joints and 2 m: a few units in the last place each.
const ROUNDING: f64 = 5e-6;

fn low_body(betas: &[f32]) -> Body {
    Body::new(open_body_low().unwrap(), betas).unwrap()
}

fn posed_vertices(body: &Body, pose: &Pose<'_>) -> Vec<Vec3> {
    let mut posed = body.posed();
    body.pose(pose, &mut posed).unwrap();
    posed.vertices().to_vec()
}

#[test]
fn rest_pose_gives_the_rest_mesh() {
    let body = low_body(&[1.0, -2.0, 0.5]);
    let rest: Vec<_> = body.rest_vertices().iter().map(|v| v.as_dvec3()).collect();
    assert!(largest_distance(&rest, &posed_vertices(&body, &Pose::REST)) < ROUNDING);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn equals_the_reference(
        rotations in any_rotations(),
        betas in prop::collection::vec(-3.0_f32..3.0, 10),
        root in [-5.0_f32..5.0, 0.0_f32..2.0, -5.0_f32..5.0],
    ) {
        let body = low_body(&betas);
        let pose = Pose { root_translation: root.into(), rotations: &rotations };
        let expected = reference_vertices(&body, &pose);
        prop_assert!(largest_distance(&expected, &posed_vertices(&body, &pose)) < ROUNDING);
    }

    #[test]
    fn a_rigid_motion_of_the_root_moves_the_mesh_rigidly(
        mut rotations in any_rotations(),
        turn in any_rotation(),
        shift in [-3.0_f32..3.0, -3.0_f32..3.0, -3.0_f32..3.0],
    ) {
        let body = low_body(&[]);
        let before = posed_vertices(&body, &Pose { root_translation: Vec3::ZERO, rotations: &rotations });
        rotations[0] = turn * rotations[0];
        let after = posed_vertices(&body, &Pose { root_translation: shift.into(), rotations: &rotations });
        let pelvis = body.rest_joint(Joint::Pelvis).as_dvec3();
        let expected: Vec<_> = before
            .iter()
            .map(|v| double(turn) * (v.as_dvec3() - pelvis) + pelvis + Vec3::from(shift).as_dvec3())
            .collect();
        prop_assert!(largest_distance(&expected, &after) < 2.0 * ROUNDING);
    }

    #[test]
    fn a_mirrored_pose_gives_the_mirrored_mesh(rotations in any_rotations()) {
        let body = low_body(&[0.5, 1.0, -1.0]);
        let original = posed_vertices(&body, &Pose { root_translation: Vec3::ZERO, rotations: &rotations });
        let swapped: Vec<_> = Joint::ALL.iter().map(|joint| mirrored(rotations[joint.mirrored().index()])).collect();
        let mirror = posed_vertices(&body, &Pose { root_translation: Vec3::ZERO, rotations: &swapped });
        let expected: Vec<_> = body.model().mirror_vertices().iter().map(|&vertex| {
            let v = original[vertex as usize].as_dvec3();
            glam::DVec3::new(-v.x, v.y, v.z)
        }).collect();
        // The embedded mesh is symmetric to the bit; the regressed joints only to rounding.
        prop_assert!(largest_distance(&expected, &mirror) < 4.0 * ROUNDING);
    }
}

/// A small model with hands, pose directions and up to 7 influences: what SMPL-family files have.
fn model_with_everything() -> BodyModel {
    let (vertices, joints) = (40, 24);
    let noise = |seed: usize| {
        let x = (seed as f32 * 12.9898).sin() * 43758.547;
        x.fract()
    };
    let vector = |seed: usize| Vec3::new(noise(seed), noise(seed + 7), noise(seed + 13));
    let mut parents: Vec<_> = Joint::ALL
        .iter()
        .map(|joint| joint.parent().map(Joint::index))
        .collect();
    parents.extend([Some(20), Some(21)]);
    BodyModel::new(BodyArrays {
        name: "synthetic".into(),
        template: (0..vertices).map(|v| vector(31 * v)).collect(),
        shape_directions: vec![(0..vertices).map(|v| vector(v + 500)).collect()],
        pose_directions: (0..9 * (joints - 1))
            .map(|d| {
                (0..vertices)
                    .map(|v| vector(1000 + 41 * d + v) * 0.01)
                    .collect()
            })
            .collect(),
        joint_regressor: JointRegressor::from_rows(
            (0..joints as u32).map(|j| [(j, 0.25), (j + 1, 0.75)]),
        )
        .unwrap(),
        blend_weights: BlendWeights::from_rows((0..vertices).map(|v| {
            let influences = 1 + v % 7;
            (0..influences).map(move |i| (((v + 3 * i) % joints) as u8, 1.0 + i as f32))
        }))
        .unwrap(),
        triangles: vec![[0, 1, 2]],
        parents,
        mirror_vertices: Vec::new(),
        attributes: None,
    })
    .unwrap()
}

proptest! {
    #[test]
    fn pose_directions_and_many_influences_equal_the_reference(
        rotations in prop::collection::vec(any_rotation(), 24),
        beta in -2.0_f32..2.0,
    ) {
        let body = Body::new(Arc::new(model_with_everything()), &[beta]).unwrap();
        let pose = Pose { root_translation: Vec3::ONE, rotations: &rotations };
        let expected = reference_vertices(&body, &pose);
        prop_assert!(largest_distance(&expected, &posed_vertices(&body, &pose)) < 4.0 * ROUNDING);
    }
}

#[test]
fn joints_that_a_pose_leaves_out_stay_at_rest() {
    let body = Body::new(Arc::new(model_with_everything()), &[]).unwrap();
    let bend = Quat::from_rotation_x(0.7);
    let short = [bend; Joint::COUNT];
    let mut long = short.to_vec();
    long.extend([Quat::IDENTITY; 2]);
    let vertices = |rotations: &[Quat]| {
        let root_translation = Vec3::ZERO;
        posed_vertices(
            &body,
            &Pose {
                root_translation,
                rotations,
            },
        )
    };
    assert_eq!(vertices(&short), vertices(&long));
}

#[test]
fn fingers_count_as_the_wrist() {
    let model = model_with_everything();
    let dominant = |vertex: &usize| model.blend_weights().dominant_joint(*vertex);
    let part_of_joint = |joint| {
        let vertex = (0..model.vertex_count()).find(|vertex| dominant(vertex) == joint);
        model.vertex_parts()[vertex.unwrap()]
    };
    assert_eq!(part_of_joint(22), Joint::LeftWrist);
    assert_eq!(part_of_joint(23), Joint::RightWrist);
    assert_eq!(part_of_joint(15), Joint::Head);
}

#[test]
fn a_pose_for_another_body_is_refused() {
    let body = low_body(&[]);
    for count in [0, 21, 23] {
        let rotations = vec![Quat::IDENTITY; count];
        let pose = Pose {
            root_translation: Vec3::ZERO,
            rotations: &rotations,
        };
        let outcome = body.pose(&pose, &mut body.posed());
        assert!(
            matches!(outcome, Err(Error::RotationCount { joints: 22, found }) if found == count)
        );
    }
}
