//! A T-pose put before the motion for the sake of importers.

use glam::Vec3;

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
    match frames_of_whole_pose(clip, human) {
        0 => frames_of_held_arms(clip, human),
        frames => frames,
    }
}

/// A person in T-pose who rushes out of it.
fn frames_of_whole_pose(clip: &SkeletonClip, human: &HumanJoints) -> usize {
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

/// Arms that keep a T-pose to a fraction of a degree while the legs already move, and drop out of
/// it at once: a converter that had no arms for these frames. CMU 03_02 for iClone begins so.
fn frames_of_held_arms(clip: &SkeletonClip, human: &HumanJoints) -> usize {
    const LEVEL_DEGREES: f32 = 10.0;
    /// No living arm keeps so still, in degrees a frame.
    const STILL_DEGREES: f32 = 0.3;
    /// The drop: degrees within so many frames.
    const DROP_DEGREES: f32 = 30.0;
    const DROP_FRAMES: usize = 4;
    let level = |pose: &SkeletonPose| {
        let [left, right] = human.shoulders().map(|shoulder| pose.positions[shoulder]);
        arm_bones(human).all(|(is_left, from, to)| {
            let outward = if is_left { left - right } else { right - left };
            degrees_between(outward, pose.positions[to] - pose.positions[from]) < LEVEL_DEGREES
        })
    };
    let frames = clip.frame_count();
    let mut before = clip.pose(0);
    let mut held = 0;
    while held < frames && level(&before) {
        held += 1;
        if held == frames {
            return 0;
        }
        let after = clip.pose(held);
        if largest_turn(human, &before, &after) > STILL_DEGREES {
            break;
        }
        before = after;
    }
    // One level frame is a dancer's.
    if held < 2 {
        return 0;
    }
    let dropped = (held..frames.min(held + DROP_FRAMES))
        .find(|&frame| largest_turn(human, &before, &clip.pose(frame)) > DROP_DEGREES);
    dropped.unwrap_or(0)
}

/// Bones of both arms: whether of the left, upper and lower joint.
fn arm_bones(human: &HumanJoints) -> impl Iterator<Item = (bool, usize, usize)> {
    let sides = [(true, human.left), (false, human.right)];
    sides.into_iter().flat_map(|(is_left, limbs)| {
        let upper = (is_left, limbs.shoulder, limbs.elbow);
        let fore = limbs.wrist.map(|wrist| (is_left, limbs.elbow, wrist));
        [Some(upper), fore].into_iter().flatten()
    })
}

/// Largest turn of an arm bone against the trunk between two poses, in degrees.
fn largest_turn(human: &HumanJoints, before: &SkeletonPose, after: &SkeletonPose) -> f32 {
    let chest = human.chest();
    let turns = arm_bones(human).map(|(_, from, to)| {
        let seen = |pose: &SkeletonPose| -> Vec3 {
            let bone = pose.positions[to] - pose.positions[from];
            pose.rotations[chest].inverse() * bone
        };
        degrees_between(seen(before), seen(after))
    });
    turns.fold(0.0, f32::max)
}
