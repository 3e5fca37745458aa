//! A pose, and the rigid transforms that it gives every joint.

use glam::{Affine3A, Quat, Vec3};

/// One moment of a body: 22 local rotations and where the root is.
#[derive(Clone, Copy, Debug)]
pub struct Pose<'a> {
    /// Added to the posed body, as SMPL's `trans`: the pelvis stands at its rest position plus
    /// this. In metres.
    pub root_translation: Vec3,
    /// Local rotations (`parent_from_joint`) relative to the rest pose, in [`crate::Joint`]'s
    /// order. Joints of the model beyond those given stay at rest.
    pub rotations: &'a [Quat],
}

impl Pose<'static> {
    /// The rest pose at the origin.
    pub const REST: Self = Self {
        root_translation: Vec3::ZERO,
        rotations: &[Quat::IDENTITY; crate::Joint::COUNT],
    };
}

/// Rigid transforms of all joints in the world, parents first.
///
/// Each joint's frame sits at the joint and, at rest, has the world's axes. `world_from_joint` is
/// overwritten.
pub(crate) fn pose_joints(
    pose: &Pose<'_>,
    rest_joints: &[Vec3],
    parents: &[Option<usize>],
    world_from_joint: &mut Vec<Affine3A>,
) {
    world_from_joint.clear();
    for (joint, (&rest, &parent)) in rest_joints.iter().zip(parents).enumerate() {
        let rotation = pose.rotations.get(joint).copied().unwrap_or(Quat::IDENTITY);
        world_from_joint.push(match parent {
            None => Affine3A::from_rotation_translation(rotation, rest + pose.root_translation),
            Some(parent) => {
                let offset = rest - rest_joints[parent];
                world_from_joint[parent] * Affine3A::from_rotation_translation(rotation, offset)
            }
        });
    }
}
