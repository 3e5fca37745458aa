//! Forward kinematics in `f64`, and its gradient.
//!
//! Second derivatives divide by the square of a frame's duration: at 120 fps a rounding of `f32`
//! at 10 m from the origin would become 0.01 m/s2. So physics poses joints in `f64`.

use glam::{DMat3, DMat4, DVec3};
use physique_body::Body;

/// The skeleton of one body: rest joints and parents.
#[derive(Clone, Debug, PartialEq)]
pub struct Rig {
    parents: Vec<Option<usize>>,
    rest_joints: Vec<DVec3>,
}

/// Gradient of a loss to the inputs of [`Rig::pose`] in one frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoseGradient {
    /// `[rotations]`: derivative to each entry of the local rotation matrices.
    pub rotations: Vec<DMat3>,
    /// Derivative to the root translation.
    pub root: DVec3,
}

impl Rig {
    /// The skeleton of a body, hands included where the model has them.
    pub fn new(body: &Body) -> Self {
        Self {
            parents: body.model().parents().to_vec(),
            rest_joints: body.rest_joints().iter().map(|j| j.as_dvec3()).collect(),
        }
    }

    /// The same tree with other rest joints.
    pub(crate) fn with_rest_joints(&self, rest_joints: Vec<DVec3>) -> Self {
        Self {
            parents: self.parents.clone(),
            rest_joints,
        }
    }

    /// `[joints]` rest positions, in metres.
    pub fn rest_joints(&self) -> &[DVec3] {
        &self.rest_joints
    }

    /// `[joints]` parents; `None` for the root. Parents come before their children.
    pub fn parents(&self) -> &[Option<usize>] {
        &self.parents
    }

    /// Number of joints.
    pub fn joint_count(&self) -> usize {
        self.rest_joints.len()
    }

    /// `[joints]` transforms that carry rest points into the world, `world_from_rest`: a skinned
    /// point is the blend of these, applied to its rest position. Joints beyond the rotations given
    /// stay at rest relative to their parent. `world_from_rest` is overwritten.
    pub fn pose(
        &self,
        rotations: impl IntoIterator<Item = DMat3>,
        root: DVec3,
        world_from_rest: &mut Vec<DMat4>,
    ) {
        world_from_rest.clear();
        let mut rotations = rotations.into_iter();
        for (&rest, &parent) in self.rest_joints.iter().zip(&self.parents) {
            let local = rotations.next().unwrap_or(DMat3::IDENTITY);
            let (rotation, position) = match parent {
                None => (local, rest + root),
                Some(parent) => {
                    let world = world_from_rest[parent];
                    (
                        DMat3::from_mat4(world) * local,
                        world.transform_point3(rest),
                    )
                }
            };
            world_from_rest.push(rotation_then_translation(
                rotation,
                position - rotation * rest,
            ));
        }
    }

    /// Carries a gradient to the transforms of [`Rig::pose`] back to its inputs; adds the part of
    /// the rest joints to `rest_joints`.
    ///
    /// `world_from_rest` are the transforms that the rotations gave. Entry `(row, column)` of
    /// `transform_gradient[joint]` is the derivative to that entry of the transform.
    pub(crate) fn pose_backward(
        &self,
        local_rotations: &[DMat3],
        world_from_rest: &[DMat4],
        transform_gradient: &mut [DMat4],
        gradient: &mut PoseGradient,
        rest_joints: &mut [DVec3],
    ) {
        gradient.rotations.clear();
        gradient
            .rotations
            .resize(local_rotations.len(), DMat3::ZERO);
        for joint in (0..self.joint_count()).rev() {
            let rest = self.rest_joints[joint];
            let translation = transform_gradient[joint].w_axis.truncate();
            let world = DMat3::from_mat4(world_from_rest[joint]);
            // translation = position - rotation * rest
            let rotation = DMat3::from_mat4(transform_gradient[joint]) - outer(translation, rest);
            rest_joints[joint] -= world.transpose() * translation;
            let local = local_rotations.get(joint).copied();
            let Some(parent) = self.parents[joint] else {
                gradient.root = translation;
                rest_joints[joint] += translation;
                if let Some(slot) = gradient.rotations.get_mut(joint) {
                    *slot = rotation;
                }
                continue;
            };
            // rotation = parent's rotation * local; position = parent's transform of `rest`
            let parent_rotation = DMat3::from_mat4(world_from_rest[parent]);
            if let Some(slot) = gradient.rotations.get_mut(joint) {
                *slot = parent_rotation.transpose() * rotation;
            }
            let from_local = rotation * local.unwrap_or(DMat3::IDENTITY).transpose();
            transform_gradient[parent] +=
                linear_and_translation(from_local + outer(translation, rest), translation);
            rest_joints[joint] += parent_rotation.transpose() * translation;
        }
    }
}

/// A homogeneous transform.
fn rotation_then_translation(rotation: DMat3, translation: DVec3) -> DMat4 {
    let mut transform = DMat4::from_mat3(rotation);
    transform.w_axis = translation.extend(1.0);
    transform
}

/// A gradient to the upper three rows of a transform: the last row is constant.
fn linear_and_translation(linear: DMat3, translation: DVec3) -> DMat4 {
    DMat4::from_cols(
        linear.x_axis.extend(0.0),
        linear.y_axis.extend(0.0),
        linear.z_axis.extend(0.0),
        translation.extend(0.0),
    )
}

/// The matrix `column * row^T`.
pub(crate) fn outer(column: DVec3, row: DVec3) -> DMat3 {
    DMat3::from_cols(column * row.x, column * row.y, column * row.z)
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use physique_body::{Joint, Pose, Sex, open_body_low};

    use super::*;

    #[test]
    fn agrees_with_the_body_to_single_precision() {
        let body = Body::mean(open_body_low().unwrap(), Sex::Female).unwrap();
        let rig = Rig::new(&body);
        let rotations: Vec<_> = (0..Joint::COUNT)
            .map(|j| Quat::from_scaled_axis(Vec3::new(0.3, -0.2, 0.1) * (j as f32).sin()))
            .collect();
        let root_translation = Vec3::new(0.3, 0.1, -2.0);
        let mut expected = Vec::new();
        let pose = Pose {
            root_translation,
            rotations: &rotations,
        };
        body.pose_joints(&pose, &mut expected).unwrap();
        let mut found = Vec::new();
        rig.pose(
            rotations.iter().map(|q| DMat3::from_quat(q.as_dquat())),
            root_translation.as_dvec3(),
            &mut found,
        );
        for ((expected, found), &rest) in expected.iter().zip(&found).zip(rig.rest_joints()) {
            let position = found.transform_point3(rest);
            assert!((position - expected.translation.as_dvec3()).length() < 2e-6);
        }
    }
}
