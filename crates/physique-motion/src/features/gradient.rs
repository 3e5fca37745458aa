//! Gradients of the rotation layer and of the way from features to positions, by hand.

use glam::{DMat3, DVec3, Vec3};
use physique_body::Joint;
use serde::{Deserialize, Serialize};

use super::{
    MotionFeatures, RotationLayer,
    quaternion::rotate,
    recover::root_path,
    rotation_layer::{FOLDED, Swing, bones, outer},
};
use crate::Error;

/// How far a rotation's gradient reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GradientRule {
    /// As published: a joint's rotation is moved by its own bones only; those of its parents count
    /// as constants.
    ParentsConstant,
    /// The derivative of what is computed: a joint's rotation also follows its parents'.
    Full,
}

impl RotationLayer {
    /// The gradient by one frame's joint positions, from the one by its 22 local rotation matrices.
    ///
    /// Exactly zero where the rotation has no derivative: bones folded straight back or without
    /// length, bodies without a heading.
    pub fn gradient(
        &self,
        joints: &[Vec3; Joint::COUNT],
        by_rotations: &[DMat3; Joint::COUNT],
        rule: GradientRule,
    ) -> [DVec3; Joint::COUNT] {
        let joints = joints.map(|joint| joint.as_dvec3());
        let frame = self.frame(&joints);
        let mut by_local = *by_rotations;
        let mut by_world = [DMat3::ZERO; Joint::COUNT];
        let mut by_sum = [DVec3::ZERO; Joint::COUNT];
        // Children first: what reaches a joint's world rotation comes from below.
        for (joint, parent) in bones().rev() {
            let world_from_parent = frame.world[parent];
            by_local[joint] += world_from_parent.transpose() * by_world[joint];
            let through_child = by_world[joint] * frame.local[joint].transpose();
            let mut by_parent = through_child;
            if let Some(swing) = &frame.swings[joint] {
                let by_direction = swing.gradient(&by_local[joint]);
                let by_now = world_from_parent * by_direction;
                by_sum[joint] = (by_now - swing.now * swing.now.dot(by_now)) / swing.sum_length;
                by_parent += outer(swing.now, by_direction);
            }
            if rule == GradientRule::Full {
                by_world[parent] += by_parent;
            }
        }
        let root = Joint::Pelvis.index();
        let by_across = heading_gradient(frame.across, &(by_local[root] + by_world[root]));

        let mut by_joints = [DVec3::ZERO; Joint::COUNT];
        for (joint, parent) in bones() {
            let bone = joints[joint] - joints[parent];
            let by_bone = unit_gradient(bone, by_sum[parent]);
            by_joints[joint] += by_bone;
            by_joints[parent] -= by_bone;
        }
        for (joint, sign) in [
            (Joint::LeftHip, -1.0),
            (Joint::RightHip, 1.0),
            (Joint::LeftShoulder, -1.0),
            (Joint::RightShoulder, 1.0),
        ] {
            by_joints[joint.index()] += sign * by_across;
        }
        by_joints
    }
}

impl Swing {
    /// The gradient by the direction in the parent's frame: of c I + [n]x + n n^T / (1 + c) with
    /// c = u . w and n = u x w.
    fn gradient(&self, by_rotation: &DMat3) -> DVec3 {
        let (axis, cosine) = (
            self.rest.cross(self.in_parent),
            self.rest.dot(self.in_parent),
        );
        if 1.0 + cosine < FOLDED {
            return DVec3::ZERO;
        }
        let share = 1.0 / (1.0 + cosine);
        let [x, y, z] = [by_rotation.x_axis, by_rotation.y_axis, by_rotation.z_axis];
        let by_cosine = x.x + y.y + z.z - share * share * axis.dot(*by_rotation * axis);
        let skew_part = DVec3::new(y.z - z.y, z.x - x.z, x.y - y.x);
        let by_axis = skew_part + share * ((*by_rotation + by_rotation.transpose()) * axis);
        by_cosine * self.rest + by_axis.cross(self.rest)
    }
}

/// The gradient by a vector from the one by its direction.
fn unit_gradient(vector: DVec3, by_unit: DVec3) -> DVec3 {
    vector.try_normalize().map_or(DVec3::ZERO, |unit| {
        (by_unit - unit * unit.dot(by_unit)) / vector.length()
    })
}

/// The gradient by the line across the body from the one by the heading's matrix.
fn heading_gradient(across: DVec3, by_rotation: &DMat3) -> DVec3 {
    let [x, z] = [by_rotation.x_axis, by_rotation.z_axis];
    let by_front = DVec3::new(z.x - x.z, 0.0, x.x + z.z);
    let by_forward = unit_gradient(DVec3::new(across.z, 0.0, -across.x), by_front);
    DVec3::new(-by_forward.z, 0.0, by_forward.x)
}

/// The gradient by features, `[frames][columns]` flat, from the one by the positions that
/// [`super::recover_from_positions`] gives. Zero for the columns that it does not read.
///
/// # Errors
/// [`Error::PositionCount`] unless `by_positions` has a vector for every joint of every frame.
pub fn recover_from_positions_gradient(
    features: &MotionFeatures,
    by_positions: &[DVec3],
) -> Result<Vec<f64>, Error> {
    let (skeleton, layout) = (features.skeleton(), features.layout());
    let (joints, columns) = (skeleton.joint_count(), skeleton.feature_count());
    if by_positions.len() != features.frame_count() * joints {
        return Err(Error::PositionCount {
            joints,
            found: by_positions.len(),
        });
    }
    let mut by_features = vec![0.0; features.values().len()];
    // Sums over this frame and all later ones: a step moves, and a turn turns, all that follows.
    let (mut by_place, mut by_half_turn) = (DVec3::ZERO, 0.0);
    let roots = root_path(features);
    for frame in (0..features.frame_count()).rev() {
        let row = &features.values()[frame * columns..][..columns];
        let by_joints = &by_positions[frame * joints..][..joints];
        let towards_z = roots[frame].towards_z;
        let from_root = towards_z.conjugate();
        let by_row = &mut by_features[frame * columns..][..columns];
        by_row[layout.root_height] += by_joints[0].y;
        let by_ric = by_row[layout.positions.clone()].as_chunks_mut::<3>().0;
        let ric = row[layout.positions.clone()].as_chunks::<3>().0;
        for ((by_ric, ric), &by_joint) in by_ric.iter_mut().zip(ric).zip(&by_joints[1..]) {
            *by_ric = (towards_z.as_dquat() * by_joint).to_array();
            let turned = rotate(from_root, Vec3::from_array(*ric)).as_dvec3();
            by_half_turn += half_turn_gradient(turned, by_joint);
        }
        by_place += by_joints.iter().sum::<DVec3>();
        let Some(last) = frame.checked_sub(1) else {
            break;
        };
        let velocity = layout.root_velocity.clone();
        let step = &features.values()[last * columns..][velocity.clone()];
        let step = rotate(from_root, Vec3::new(step[0], 0.0, step[1])).as_dvec3();
        let by_place = DVec3::new(by_place.x, 0.0, by_place.z);
        by_half_turn += half_turn_gradient(step, by_place);
        let by_step = towards_z.as_dquat() * by_place;
        let by_last = &mut by_features[last * columns..][..columns];
        by_last[velocity].copy_from_slice(&[by_step.x, by_step.z]);
        by_last[layout.root_turn] = by_half_turn;
    }
    Ok(by_features)
}

/// A vector was turned back by twice the half turn about +Y.
fn half_turn_gradient(turned: DVec3, by_turned: DVec3) -> f64 {
    -2.0 * turned.cross(by_turned).y
}
