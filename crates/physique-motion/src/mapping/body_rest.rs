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
        let bones = [
            Joint::LeftKnee,
            Joint::LeftAnkle,
            Joint::RightKnee,
            Joint::RightAnkle,
        ];
        bones
            .into_iter()
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

#[cfg(test)]
impl BodyRest {
    /// A plain figure of 1.7 m in T-pose for tests, with feet that point outwards a little.
    pub(crate) fn figure() -> Self {
        #[rustfmt::skip]
        let half = [
            (Joint::Pelvis, [0.0, 0.95, 0.0]), (Joint::LeftHip, [0.08, 0.86, 0.0]),
            (Joint::Spine1, [0.0, 1.06, -0.02]), (Joint::LeftKnee, [0.1, 0.48, 0.005]),
            (Joint::Spine2, [0.0, 1.18, 0.0]), (Joint::LeftAnkle, [0.09, 0.07, -0.03]),
            (Joint::Spine3, [0.0, 1.24, 0.01]), (Joint::LeftFoot, [0.11, 0.02, 0.09]),
            (Joint::Neck, [0.0, 1.44, -0.03]), (Joint::LeftCollar, [0.07, 1.36, -0.02]),
            (Joint::Head, [0.0, 1.53, 0.02]), (Joint::LeftShoulder, [0.18, 1.4, -0.03]),
            (Joint::LeftElbow, [0.44, 1.39, -0.05]), (Joint::LeftWrist, [0.69, 1.4, -0.055]),
        ];
        let mut joints = [Vec3::ZERO; Joint::COUNT];
        for (joint, position) in half {
            let position = Vec3::from_array(position);
            joints[joint.mirrored().index()] = position * Vec3::new(-1.0, 1.0, 1.0);
            joints[joint.index()] = position;
        }
        Self {
            joints,
            ground: 0.0,
        }
    }
}
