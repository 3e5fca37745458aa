//! The T-pose of a family of rigs whose files do not show one.

use std::path::Path;

use glam::Quat;

use super::{human_joints::HumanJoints, name::NamedJoints};
use crate::{Error, SkeletonClip, SkeletonPose};

/// How the joints of a rig are turned when a person stands in a T-pose, facing +Z with Y up.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct KnownTPose {
    /// `world_from_joint` by the rig's own names.
    world_from_joint: Vec<(String, Quat)>,
}

impl KnownTPose {
    /// From a TOML table of quaternions `(x, y, z, w)`; `path` only names it in errors.
    pub(super) fn parse(table: &toml::Table, path: &Path) -> Result<Self, Error> {
        let rotation = |(name, value): (&String, &toml::Value)| {
            let number = |value: &toml::Value| match value {
                toml::Value::Float(number) => Some(*number as f32),
                toml::Value::Integer(number) => Some(*number as f32),
                _ => None,
            };
            let numbers = value.as_array().filter(|numbers| numbers.len() == 4);
            let numbers: Option<Vec<f32>> =
                numbers.and_then(|numbers| numbers.iter().map(number).collect());
            let quaternion = numbers.map(|numbers| Quat::from_slice(&numbers));
            // Wide enough for hand-rounded numbers; a NaN is in no range.
            match quaternion.filter(|rotation| (0.99..1.01).contains(&rotation.length())) {
                Some(rotation) => Ok((name.clone(), rotation.normalize())),
                None => Err(Error::Format {
                    path: path.into(),
                    place: format!("t_pose, {name}"),
                    expected: "a quaternion of unit length, [x, y, z, w]".into(),
                    found: quaternion.map_or("not four numbers".into(), |found| found.to_string()),
                }),
            }
        };
        Ok(Self {
            world_from_joint: table.iter().map(rotation).collect::<Result<_, _>>()?,
        })
    }

    /// The clip's skeleton, with its own bones, in this pose. Joints without a rotation stay with
    /// their parents as at rest.
    ///
    /// # Errors
    /// The name of a human joint without a rotation.
    pub(super) fn pose(
        &self,
        clip: &SkeletonClip,
        human: &HumanJoints,
    ) -> Result<SkeletonPose, String> {
        let joints = clip.skeleton().joints();
        let named = NamedJoints::new(clip.skeleton());
        let mut known = vec![None; joints.len()];
        for (name, rotation) in &self.world_from_joint {
            if let Some(joint) = named.find(name) {
                known[joint] = Some(*rotation);
            }
        }
        if let Some(joint) = human.all().find(|&joint| known[joint].is_none()) {
            return Err(joints[joint].name.clone());
        }
        let mut parent_from_joint: Vec<Quat> = Vec::with_capacity(joints.len());
        let mut world_from_joint: Vec<Quat> = Vec::with_capacity(joints.len());
        for (joint, known) in joints.iter().zip(known) {
            let parent = joint.parent.map(|parent| world_from_joint[parent]);
            let parent = parent.unwrap_or(Quat::IDENTITY);
            let world = known.unwrap_or(parent * joint.rest_rotation);
            parent_from_joint.push(parent.inverse() * world);
            world_from_joint.push(world);
        }
        let mut pose = SkeletonPose::default();
        pose.set(clip.skeleton(), |joint| {
            (parent_from_joint[joint], clip.translation(0, joint))
        });
        Ok(pose)
    }

    /// Whether there is a rotation for the joint of that name.
    #[cfg(test)]
    pub(super) fn turns(&self, name: &str) -> bool {
        let mut names = self.world_from_joint.iter().map(|(name, _)| name);
        names.any(|known| known == name)
    }
}
