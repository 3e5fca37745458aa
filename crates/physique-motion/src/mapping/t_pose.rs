//! A T-pose put before the motion for the sake of importers.

use super::{
    axes::degrees_between,
    figure::{Arms, Figure},
    human_joints::HumanJoints,
};
use crate::{SkeletonClip, SkeletonPose};

/// Whether the first frame is a T-pose that has nothing to do with the second: arms jump by more
/// than 20 degrees and three times as far as in the step after.
pub(super) fn leads(clip: &SkeletonClip, human: &HumanJoints) -> bool {
    if clip.frame_count() < 3 {
        return false;
    }
    let poses = [clip.pose(0), clip.pose(1), clip.pose(2)];
    let first = Figure {
        human,
        skeleton: clip.skeleton(),
        pose: &poses[0],
    };
    let step = |before: &SkeletonPose, after: &SkeletonPose| {
        let turns = human.sides().map(|limbs| {
            let arm =
                |pose: &SkeletonPose| pose.positions[limbs.elbow] - pose.positions[limbs.shoulder];
            degrees_between(arm(before), arm(after))
        });
        turns[0].max(turns[1])
    };
    let jump = step(&poses[0], &poses[1]);
    first.standing(Arms::Level).is_some() && jump > 20.0 && jump > 3.0 * step(&poses[1], &poses[2])
}
