//! Is a pose of a foreign skeleton a person who stands, and where do they face?

use glam::{Mat3, Quat, Vec3};

use super::{
    axes::{degrees_between, reject, snapped},
    human_joints::{HumanJoints, Limbs},
};
use crate::{Skeleton, SkeletonPose};

/// World positions of the human joints of a pose.
#[derive(Clone, Copy)]
pub(super) struct Figure<'a> {
    pub(super) human: &'a HumanJoints,
    pub(super) skeleton: &'a Skeleton,
    pub(super) pose: &'a SkeletonPose,
}

/// How the arms must be for a pose to count.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Arms {
    /// Anywhere from hanging to a little above level, in the body's plane.
    Straight,
    /// Level: a T-pose.
    Level,
}

impl Figure<'_> {
    /// Position of a joint.
    pub(super) fn at(&self, joint: usize) -> Vec3 {
        self.pose.positions[joint]
    }

    fn middle(&self, [a, b]: [usize; 2]) -> Vec3 {
        (self.at(a) + self.at(b)) / 2.0
    }

    /// From the right of the body to its left: hips and shoulders together.
    fn left(&self) -> Vec3 {
        let across = |[left, right]: [usize; 2]| self.at(left) - self.at(right);
        across(self.human.hips()) + across(self.human.shoulders())
    }

    /// Where the ball of a foot is: the toe joint, or where the ankle's bone ends.
    pub(super) fn ball(&self, limbs: &Limbs) -> Option<Vec3> {
        ball_of_foot(self.skeleton, limbs)
            .map(|(joint, local)| self.at(joint) + self.pose.rotations[joint] * local)
    }

    /// `world_from_figure`: left, up and forward of a standing person; near a world axis, the
    /// axis itself, for rest poses are authored.
    pub(super) fn world_from_figure(&self) -> Option<Quat> {
        const AUTHORED_DEGREES: f32 = 12.0;
        let up = self.middle(self.human.shoulders()) - self.middle(self.human.ankles());
        let up = snapped(up.try_normalize()?, AUTHORED_DEGREES);
        let left = snapped(reject(self.left(), up)?, AUTHORED_DEGREES);
        let left = reject(left, up)?;
        let axes = Mat3::from_cols(left, up, left.cross(up));
        Some(Quat::from_mat3(&axes).normalize())
    }

    /// `world_from_figure` if the pose is a person who stands straight, feet forward, with such
    /// arms.
    pub(super) fn standing(&self, arms: Arms) -> Option<Quat> {
        let world_from_figure = self.world_from_figure()?;
        let figure_from_world = world_from_figure.inverse();
        let bone = |from: usize, to: usize| figure_from_world * (self.at(to) - self.at(from));
        let trunk = bone(self.human.pelvis, self.human.chest());
        let trunk = trunk + bone(self.human.chest(), self.human.left.shoulder);
        let trunk = trunk + bone(self.human.chest(), self.human.right.shoulder);
        let mut human = degrees_between(trunk, Vec3::Y) < 40.0;
        for (limbs, outward) in self.human.sides().into_iter().zip([Vec3::X, Vec3::NEG_X]) {
            let [thigh, shin] = [bone(limbs.hip, limbs.knee), bone(limbs.knee, limbs.ankle)];
            human &= degrees_between(thigh, Vec3::NEG_Y) < 30.0;
            human &= degrees_between(shin, Vec3::NEG_Y) < 30.0;
            if let Some(ball) = self.ball(limbs) {
                let foot = figure_from_world * (ball - self.at(limbs.ankle));
                human &= foot.length() < 1e-4 || degrees_between(foot, Vec3::Z) < 75.0;
            }
            let upper = bone(limbs.shoulder, limbs.elbow);
            let fore = limbs.wrist.map_or(upper, |wrist| bone(limbs.elbow, wrist));
            human &= degrees_between(upper, fore) < 40.0;
            human &= match arms {
                Arms::Straight => {
                    let flat = Vec3::new(upper.x, upper.y, 0.0);
                    degrees_between(upper, flat) < 35.0
                        && degrees_between(flat, outward - Vec3::Y) < 75.0
                }
                Arms::Level => degrees_between(upper, outward) < 25.0,
            };
        }
        human.then_some(world_from_figure)
    }
}

/// The joint and the place in its frame where the ball of the foot is: the toe joint, the end
/// site of the ankle, or that of a nameless child.
pub(super) fn ball_of_foot(skeleton: &Skeleton, limbs: &Limbs) -> Option<(usize, Vec3)> {
    if let Some(foot) = limbs.foot {
        return Some((foot, Vec3::ZERO));
    }
    let joint = &skeleton.joints()[limbs.ankle];
    let longest = |a: &&Vec3, b: &&Vec3| a.length_squared().total_cmp(&b.length_squared());
    let site = joint.end_sites.iter().max_by(longest)?;
    (site.length() > 1e-4).then_some((limbs.ankle, *site))
}
