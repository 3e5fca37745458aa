//! Which limbs are the left ones.

use glam::Vec3;

use super::{figure::Figure, human_joints::HumanJoints};
use crate::{SkeletonClip, SkeletonPose, clip::spread};

/// How surely toes and trunk say that the joints called left are the body's left: 1 when they say
/// so in every frame, -1 when they say the opposite, 0 where there are no toes.
///
/// A body's left is up cross forward, where toes point forward from the ankles and the shoulders
/// stand above them.
pub(super) fn agreement(clip: &SkeletonClip, human: &HumanJoints) -> f32 {
    let mut pose = SkeletonPose::default();
    let (mut votes, mut frames) = (0.0, 0.0);
    for frame in spread(clip.frame_count(), 200) {
        clip.pose_into(frame, &mut pose);
        let figure = Figure {
            human,
            skeleton: clip.skeleton(),
            pose: &pose,
        };
        let [left_hip, right_hip] = human.hips().map(|hip| figure.at(hip));
        let [left, right] = human.shoulders().map(|shoulder| figure.at(shoulder));
        let up = (left + right - left_hip - right_hip).normalize_or_zero();
        let toes: Vec3 = human
            .sides()
            .into_iter()
            .filter_map(|limbs| Some(figure.ball(limbs)? - figure.at(limbs.ankle)))
            .map(|toes| toes - up * toes.dot(up))
            .sum();
        let across = left_hip - right_hip + left - right;
        let says = up
            .cross(toes.normalize_or_zero())
            .dot(across.normalize_or_zero());
        if says.abs() > 0.3 {
            votes += says.signum();
            frames += 1.0;
        }
    }
    if frames > 0.0 { votes / frames } else { 0.0 }
}

/// The joints with left and right exchanged.
pub(super) fn exchanged(mut human: HumanJoints) -> HumanJoints {
    std::mem::swap(&mut human.left, &mut human.right);
    human
}
