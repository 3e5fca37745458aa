//! What mapping needs to know of the body: its joints at rest and its soles.

use glam::Vec3;
use physique_body::{Body, Joint};

/// The body's rest pose, facing +Z with its left at +X.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyRest {
    /// Rest positions of the 22 joints, in metres.
    pub joints: [Vec3; Joint::COUNT],
    /// Height of the ground under the soles: the lowest vertex, in metres.
    pub ground: f32,
}

impl From<&Body> for BodyRest {
    fn from(body: &Body) -> Self {
        Self {
            joints: Joint::ALL.map(|joint| body.rest_joint(joint)),
            ground: body.rest_ground(),
        }
    }
}

impl BodyRest {
    /// Rest position of a joint.
    pub const fn joint(&self, joint: Joint) -> Vec3 {
        self.joints[joint.index()]
    }

    /// From one joint to another, in metres.
    pub fn bone(&self, from: Joint, to: Joint) -> Vec3 {
        self.joint(to) - self.joint(from)
    }

    /// From a joint's parent to the joint, in metres; zero for the pelvis.
    pub fn offset(&self, joint: Joint) -> Vec3 {
        joint
            .parent()
            .map_or(Vec3::ZERO, |parent| self.bone(parent, joint))
    }

    /// Height of a joint over the soles at rest, in metres.
    pub fn height(&self, joint: Joint) -> f32 {
        self.joint(joint).y - self.ground
    }

    /// Hip to knee to ankle, mean of both legs, in metres.
    pub fn leg_length(&self) -> f32 {
        let bones = Joint::LEGS.map(|[_, knee, ankle, _]| [knee, ankle]);
        bones
            .into_iter()
            .flatten()
            .map(|joint| self.offset(joint).length())
            .sum::<f32>()
            / 2.0
    }

    /// Middle of the hip joints.
    pub fn middle_of_hips(&self) -> Vec3 {
        (self.joint(Joint::LeftHip) + self.joint(Joint::RightHip)) / 2.0
    }

    /// Horizontal direction from an ankle to its ball of the foot.
    pub(super) fn foot_heading(&self, ankle: Joint) -> Vec3 {
        let foot = if ankle == Joint::LeftAnkle {
            Joint::LeftFoot
        } else {
            Joint::RightFoot
        };
        let bone = self.bone(ankle, foot);
        Vec3::new(bone.x, 0.0, bone.z)
            .try_normalize()
            .unwrap_or(Vec3::Z)
    }
}
