//! Arms and legs.

use glam::{Quat, Vec3};
use physique_body::Joint::{self, *};

use super::{pose::SolvedPose, rigid::aim, source_bones::SourceBones, twist::Twist};

/// A limb: an upper bone that twists, a hinge, a lower bone, and a foot or nothing known.
pub(super) struct Limb {
    upper: Joint,
    hinge: Joint,
    end: Joint,
    foot: Option<Joint>,
    /// Axis at rest about which the hinge bends, positive for flexion.
    axis: Vec3,
}

const fn leg(upper: Joint, hinge: Joint, end: Joint, foot: Joint) -> Limb {
    let (foot, axis) = (Some(foot), Vec3::X);
    Limb {
        upper,
        hinge,
        end,
        foot,
        axis,
    }
}

const fn arm(upper: Joint, hinge: Joint, end: Joint, axis: Vec3) -> Limb {
    Limb {
        upper,
        hinge,
        end,
        foot: None,
        axis,
    }
}

/// Both arms and legs: shins go back, forearms to the front.
pub(super) const LIMBS: [Limb; 4] = [
    leg(LeftHip, LeftKnee, LeftAnkle, LeftFoot),
    leg(RightHip, RightKnee, RightAnkle, RightFoot),
    arm(LeftShoulder, LeftElbow, LeftWrist, Vec3::NEG_Y),
    arm(RightShoulder, RightElbow, RightWrist, Vec3::Y),
];

/// Weight of a foot against a knee bent at a right angle, for a straight leg.
const TRUST_IN_FOOT: f32 = 0.05;
/// Weight of no twist: that of a hinge bent by 15 degrees; below, elbows may well bend backwards.
const TRUST_IN_HABIT: f32 = 0.005;

impl Limb {
    /// What a frame says about the twist of the upper bone.
    pub(super) fn twist(
        &self,
        bones: &SourceBones,
        pose: &SolvedPose,
        wanted: &[Vec3; Joint::COUNT],
    ) -> Twist {
        let untwisted = self.untwisted(bones, pose, wanted);
        let upper = untwisted * bones.offset(self.hinge);
        let hinge = pose.positions[self.upper.index()] + upper;
        let lower = wanted[self.end.index()] - hinge;
        let mut twist = Twist::default();
        twist.add_none(TRUST_IN_HABIT);
        if let Some(axis) = upper.try_normalize() {
            // Where the lower bone goes when the hinge bends, across it.
            let flexed = untwisted * self.axis.cross(bones.offset(self.end));
            twist.add(axis, flexed, lower, 1.0);
            if let Some(foot) = self.foot {
                let rest = untwisted * bones.offset(foot);
                let now = wanted[foot.index()] - wanted[self.end.index()];
                // Seen along the thigh, a foot below a bent knee says nothing.
                let straight = axis.dot(lower.normalize_or_zero()).max(0.0);
                twist.add(axis, rest, now, TRUST_IN_FOOT * straight * straight);
            }
        }
        twist
    }

    /// Turns and places the limb with this twist of its upper bone, in radians.
    pub(super) fn place(
        &self,
        bones: &SourceBones,
        pose: &mut SolvedPose,
        wanted: &[Vec3; Joint::COUNT],
        twist: f32,
    ) {
        let untwisted = self.untwisted(bones, pose, wanted);
        let axis = (untwisted * bones.offset(self.hinge)).normalize_or_zero();
        let upper = Quat::from_scaled_axis(axis * twist) * untwisted;
        let upper = upper.normalize();
        pose.world[self.upper.index()] = upper;
        pose.put(bones, self.hinge);
        let lower = wanted[self.end.index()] - pose.positions[self.hinge.index()];
        let rest = bones.offset(self.end);
        let bent = upper * self.bend(rest, upper.inverse() * lower);
        let lower = aim(bent, rest, lower);
        pose.world[self.hinge.index()] = lower;
        pose.put(bones, self.end);
        pose.world[self.end.index()] = lower;
        if let Some(foot) = self.foot {
            let bone = wanted[foot.index()] - pose.positions[self.end.index()];
            let sole = aim(lower, bones.offset(foot), bone);
            pose.world[self.end.index()] = sole;
            pose.put(bones, foot);
            pose.world[foot.index()] = sole;
        }
    }

    /// The turn about the hinge's axis that brings a bone at rest closest to where it is now. What
    /// is left to aim is small, where the shortest way for a knee bent to the full would twist.
    fn bend(&self, rest: Vec3, now: Vec3) -> Quat {
        let rest = rest.reject_from_normalized(self.axis);
        let angle = self.axis.dot(rest.cross(now)).atan2(rest.dot(now));
        Quat::from_axis_angle(self.axis, angle)
    }

    /// The upper joint swung the shortest way from its parent's rotation.
    fn untwisted(
        &self,
        bones: &SourceBones,
        pose: &SolvedPose,
        wanted: &[Vec3; Joint::COUNT],
    ) -> Quat {
        let parent = self.upper.parent();
        let above = parent.map_or(Quat::IDENTITY, |parent| pose.world[parent.index()]);
        let bone = wanted[self.hinge.index()] - pose.positions[self.upper.index()];
        aim(above, bones.offset(self.hinge), bone)
    }
}
