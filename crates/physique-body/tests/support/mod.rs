//! The slow readable reference of posing, and makers of poses. Each test uses some of it.
#![allow(dead_code)]

use glam::{DMat4, DQuat, DVec3, Quat, Vec3};
use physique_body::{Body, Joint, Pose};
use proptest::prelude::*;

/// Posing as the SMPL paper writes it, in f64 and over all joints: chain the joints' rigid
/// transforms, take the rest pose off, blend 4x4 matrices by dense weights.
pub(crate) fn reference_vertices(body: &Body, pose: &Pose<'_>) -> Vec<DVec3> {
    let model = body.model();
    let joints = model.joint_count();
    let rest_joint = |joint: usize| body.rest_joints()[joint].as_dvec3();
    let rotation = |joint: usize| {
        let rotation = pose.rotations.get(joint).copied();
        rotation.unwrap_or(Quat::IDENTITY).as_dquat().normalize()
    };

    let mut world_from_joint: Vec<DMat4> = Vec::new();
    for joint in 0..joints {
        let (parent, offset) = match model.parents()[joint] {
            Some(parent) => (
                world_from_joint[parent],
                rest_joint(joint) - rest_joint(parent),
            ),
            None => (
                DMat4::from_translation(pose.root_translation.as_dvec3()),
                rest_joint(joint),
            ),
        };
        world_from_joint.push(parent * DMat4::from_rotation_translation(rotation(joint), offset));
    }
    let world_from_rest: Vec<DMat4> = (0..joints)
        .map(|joint| world_from_joint[joint] * DMat4::from_translation(-rest_joint(joint)))
        .collect();

    let features: Vec<f64> = (1..joints)
        .flat_map(|joint| {
            let matrix = glam::DMat3::from_quat(rotation(joint)) - glam::DMat3::IDENTITY;
            (0..9).map(move |entry| matrix.row(entry / 3)[entry % 3])
        })
        .collect();
    let mut dense = vec![vec![0.0; joints]; model.vertex_count()];
    for (vertex, row) in dense.iter_mut().enumerate() {
        for (joint, weight) in model.blend_weights().row(vertex) {
            row[joint] += f64::from(weight);
        }
    }
    body.rest_vertices()
        .iter()
        .enumerate()
        .map(|(vertex, rest)| {
            let mut rest = rest.as_dvec3();
            for (feature, direction) in features.iter().zip(model.pose_directions()) {
                rest += direction[vertex].as_dvec3() * *feature;
            }
            let blended = world_from_rest
                .iter()
                .zip(&dense[vertex])
                .fold(DMat4::ZERO, |sum, (transform, weight)| {
                    sum + *transform * *weight
                });
            blended.transform_point3(rest)
        })
        .collect()
}

/// Largest distance between two meshes, in metres.
pub(crate) fn largest_distance(a: &[DVec3], b: &[Vec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(a, b)| a.distance(b.as_dvec3()))
        .fold(0.0, f64::max)
}

/// Any rotation at every joint.
pub(crate) fn any_rotations() -> impl Strategy<Value = Vec<Quat>> {
    prop::collection::vec(any_rotation(), Joint::COUNT)
}

/// A rotation about any axis by any angle.
pub(crate) fn any_rotation() -> impl Strategy<Value = Quat> {
    ([-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0], -3.1_f32..3.1).prop_filter_map(
        "an axis needs a length",
        |(axis, angle)| {
            let axis = Vec3::from_array(axis).try_normalize()?;
            Some(Quat::from_axis_angle(axis, angle))
        },
    )
}

/// The quaternion of the mirror image (x to -x) of a rotation.
pub(crate) fn mirrored(rotation: Quat) -> Quat {
    Quat::from_xyzw(rotation.x, -rotation.y, -rotation.z, rotation.w)
}

/// A rotation in double precision, for references.
pub(crate) fn double(rotation: Quat) -> DQuat {
    rotation.as_dquat().normalize()
}
