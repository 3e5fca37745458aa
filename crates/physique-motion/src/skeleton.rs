//! Any skeleton: named joints in a tree, with the pose that the file calls rest.

use glam::{Quat, Vec3};

use crate::Error;

/// One joint of a [`Skeleton`].
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonJoint {
    /// Name as the file spells it.
    pub name: String,
    /// Index of the parent; `None` for a root.
    pub parent: Option<usize>,
    /// Origin of the joint in its parent's frame at rest, in metres.
    pub rest_translation: Vec3,
    /// `parent_from_joint` at rest: the identity in BVH, the node's own rotation in glTF.
    pub rest_rotation: Quat,
    /// Tips of bones that end here, in the joint's frame, in metres (BVH's `End Site`).
    pub end_sites: Vec<Vec3>,
}

/// A tree (or forest) of named joints, parents before children.
///
/// Nothing here is human: `mapping` finds the body in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skeleton {
    joints: Vec<SkeletonJoint>,
}

impl Skeleton {
    /// A skeleton of `joints`, each after its parent.
    ///
    /// # Errors
    /// [`Error::Skeleton`] when a parent does not come before its child, or when a length or
    /// rotation is not finite.
    pub fn new(joints: Vec<SkeletonJoint>) -> Result<Self, Error> {
        for (index, joint) in joints.iter().enumerate() {
            let problem = |expected| Error::Skeleton {
                joint: joint.name.clone(),
                index,
                expected,
            };
            if joint.parent.is_some_and(|parent| parent >= index) {
                return Err(problem("its parent listed before it"));
            }
            let offsets_finite = joint.rest_translation.is_finite()
                && joint.end_sites.iter().all(|site| site.is_finite());
            if !offsets_finite {
                return Err(problem("finite offsets"));
            }
            if !joint.rest_rotation.is_normalized() {
                return Err(problem("a rest rotation of unit length"));
            }
        }
        Ok(Self { joints })
    }

    /// All joints, parents first.
    pub fn joints(&self) -> &[SkeletonJoint] {
        &self.joints
    }

    /// Number of joints.
    pub fn joint_count(&self) -> usize {
        self.joints.len()
    }

    /// The joint called exactly `name`; the first, where a file repeats names.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }

    /// Indices of the joints whose parent is `joint`.
    pub fn children(&self, joint: usize) -> impl Iterator<Item = usize> + '_ {
        let after = joint + 1..self.joints.len();
        after.filter(move |&child| self.joints[child].parent == Some(joint))
    }

    /// `joint` and its ancestors up to the root, in that order.
    pub fn path_to_root(&self, joint: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(Some(joint), |&at| self.joints[at].parent)
    }

    /// Whether `ancestor` is `joint` or lies above it.
    pub fn is_at_or_below(&self, joint: usize, ancestor: usize) -> bool {
        self.path_to_root(joint).any(|at| at == ancestor)
    }

    /// World pose of the rest pose.
    pub fn rest_pose(&self) -> SkeletonPose {
        let mut pose = SkeletonPose::default();
        pose.set(self, |joint| {
            let joint = &self.joints[joint];
            (joint.rest_rotation, joint.rest_translation)
        });
        pose
    }
}

/// Where every joint of a skeleton is in the world, in one frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkeletonPose {
    /// `world_from_joint` rotations, one a joint.
    pub rotations: Vec<Quat>,
    /// Joint origins in the world, in metres, one a joint.
    pub positions: Vec<Vec3>,
}

impl SkeletonPose {
    /// Turns the world with all in it.
    pub(crate) fn turn(&mut self, turn: Quat) {
        if turn == Quat::IDENTITY {
            return;
        }
        for rotation in &mut self.rotations {
            *rotation = (turn * *rotation).normalize();
        }
        for position in &mut self.positions {
            *position = turn * *position;
        }
    }

    /// Forward kinematics: composes `local(joint)`, the rotation `parent_from_joint` and the
    /// joint's origin in its parent's frame, from the roots down. Reuses the memory of `self`.
    pub(crate) fn set(&mut self, skeleton: &Skeleton, local: impl Fn(usize) -> (Quat, Vec3)) {
        self.rotations.clear();
        self.positions.clear();
        for (index, joint) in skeleton.joints.iter().enumerate() {
            let (rotation, translation) = local(index);
            let (world_rotation, world_position) = match joint.parent {
                None => (rotation, translation),
                Some(parent) => (
                    self.rotations[parent] * rotation,
                    self.positions[parent] + self.rotations[parent] * translation,
                ),
            };
            self.rotations.push(world_rotation.normalize());
            self.positions.push(world_position);
        }
    }
}
