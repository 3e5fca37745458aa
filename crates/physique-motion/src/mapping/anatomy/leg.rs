//! Legs: knees bend about their left, soles lie flat when the foot is lowest.

use glam::{Quat, Vec3};

use super::{Anatomy, SNAP_DEGREES, Side};
use crate::mapping::{
    axes::{mean_rotation, reject, snapped},
    figure::ball_of_foot,
    human_joints::Limbs,
};

impl Anatomy<'_> {
    pub(super) fn leg(&mut self, side: Side) {
        let limbs = *side.limbs(self.human);
        let (hip, knee, ankle) = (limbs.hip, limbs.knee, limbs.ankle);
        let bones = [hip, knee, ankle];
        let thigh = self.bone(hip, knee);
        let mut hinge = self.hinge(hip, bones);
        if hinge == Vec3::ZERO {
            // A knee that never bends: its hinge lies across the body on the whole.
            let pelvis = self.human.pelvis;
            let left = self.joint_from_body[pelvis] * Vec3::X;
            let left = self.seen_from(hip, |pose| pose.rotations[pelvis] * left);
            hinge = snapped(left, SNAP_DEGREES);
        }
        self.set(
            hip,
            [self.body.bone(side.hip, side.knee), Vec3::X],
            [thigh, hinge],
        );

        let shin = self.bone(knee, ankle);
        let shin_hinge = self.carried_if_straight(thigh, hinge, [hip, knee], shin, bones);
        self.set(
            knee,
            [self.body.bone(side.knee, side.ankle), Vec3::X],
            [shin, shin_hinge],
        );
        self.foot(side, &limbs, self.carried(shin_hinge, knee, ankle));
    }

    /// The ankle hinges about the knee's axis; its sole is level when the foot is lowest.
    fn foot(&mut self, side: Side, limbs: &Limbs, left: Vec3) {
        let ankle = limbs.ankle;
        let Some((ball, offset)) = ball_of_foot(self.skeleton, limbs) else {
            self.carry(limbs.knee, ankle);
            return;
        };
        let toward_ball = self.seen_from(ankle, |pose| {
            pose.positions[ball] + pose.rotations[ball] * offset - pose.positions[ankle]
        });
        let Some(left) = reject(left, toward_ball) else {
            self.carry(limbs.knee, ankle);
            return;
        };
        let pitch = self.soles.pitch;
        let forward = Quat::from_axis_angle(left, -pitch) * toward_ball;
        let heading = self.body.foot_heading(side.ankle);
        let across = Vec3::Y.cross(heading);
        self.set(ankle, [across, heading], [left, forward]);
        if let Some(foot) = limbs.foot {
            self.toes(foot, ankle, self.soles.ankle_height);
        }
    }

    /// Toes are level with the sole when the foot stands: their mean turn in the lowest frames.
    fn toes(&mut self, foot: usize, ankle: usize, ankle_height: f32) {
        const STANDS_WITHIN_METRES: f32 = 0.02;
        let standing = self
            .poses
            .iter()
            .filter(|pose| (pose.positions[ankle].y - ankle_height).abs() < STANDS_WITHIN_METRES);
        let foot_from_ankle = mean_rotation(
            standing.map(|pose| (1.0, pose.rotations[foot].inverse() * pose.rotations[ankle])),
        );
        match foot_from_ankle {
            Some(foot_from_ankle) => {
                self.joint_from_body[foot] =
                    (foot_from_ankle * self.joint_from_body[ankle]).normalize();
            }
            None => self.carry(ankle, foot),
        }
    }
}
