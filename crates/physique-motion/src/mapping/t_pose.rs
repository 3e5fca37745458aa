//! A T-pose put before the motion for the sake of importers.

use super::{
    axes::degrees_between,
    figure::{Arms, Figure},
    human_joints::HumanJoints,
};
use crate::{SkeletonClip, SkeletonPose};

/// Frames that are looked at: the T-pose, at most a quarter of them to leave it, and the rest to
/// know the motion's own pace.
const LOOKED_AT: usize = 64;

/// Number of frames to drop at the start: a first frame in T-pose and those in which the body
/// rushes from it into the motion. 0 for a motion that begins in a T-pose and leaves it at its
/// own pace.
///
/// The 43-joint files of CMU's dances begin so; a smoothing filter of their converter spread the
/// jump over the first eight frames.
pub(super) fn leading_frames(clip: &SkeletonClip, human: &HumanJoints) -> usize {
    let poses: Vec<SkeletonPose> = (0..clip.frame_count().min(LOOKED_AT))
        .map(|frame| clip.pose(frame))
        .collect();
    let Some((first, rest)) = poses.split_first() else {
        return 0;
    };
    let figure = Figure {
        human,
        skeleton: clip.skeleton(),
        pose: first,
    };
    if rest.is_empty() || figure.standing(Arms::Level).is_none() {
        return 0;
    }
    let steps: Vec<f32> = poses
        .windows(2)
        .map(|pair| largest_turn(human, &pair[0], &pair[1]))
        .collect();
    let longest_way_out = steps.len() / 4;
    let mut own_pace = steps[longest_way_out..].to_vec();
    own_pace.sort_by(f32::total_cmp);
    let pace = own_pace[own_pace.len() / 2].max(0.5);
    if steps[0] < 8.0 || steps[0] < 5.0 * pace {
        return 0;
    }
    // Two ordinary steps in a row end the rush: a filter may stand still for one in between.
    let settled = |at: usize| steps[at..].iter().take(2).all(|&step| step <= 2.5 * pace);
    (1..=longest_way_out)
        .find(|&frame| settled(frame))
        .unwrap_or(longest_way_out.max(1))
}

/// Largest turn of an arm bone against the trunk between two poses, in degrees.
fn largest_turn(human: &HumanJoints, before: &SkeletonPose, after: &SkeletonPose) -> f32 {
    let chest = human.chest();
    let mut largest = 0.0f32;
    for limbs in human.sides() {
        let bones = [(limbs.shoulder, limbs.elbow)].into_iter();
        for (from, to) in bones.chain(limbs.wrist.map(|wrist| (limbs.elbow, wrist))) {
            let seen = |pose: &SkeletonPose| {
                let bone = pose.positions[to] - pose.positions[from];
                pose.rotations[chest].inverse() * bone
            };
            largest = largest.max(degrees_between(seen(before), seen(after)));
        }
    }
    largest
}
