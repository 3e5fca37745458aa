//! What position channels mean, which BVH does not say.

use glam::Vec3;

use super::{channel::position, frames::BvhFrames, hierarchy::BvhJoint};
use crate::{SkeletonClip, SkeletonPose, UpAxis, clip::spread};

/// What position channels do to a joint's `OFFSET`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PositionChannels {
    /// They are the joint's place; the offset says nothing (Bandai Namco's files).
    Replace,
    /// They are added to the offset (iClone's files).
    Add,
}

/// Votes of the joints below the roots; `None` when none of them has position channels and a
/// sizeable offset.
pub(super) fn vote_position_channels(
    joints: &[BvhJoint],
    frames: &BvhFrames,
) -> Option<PositionChannels> {
    let (mut replace, mut add) = (0, 0);
    let longest = joints
        .iter()
        .filter(|joint| joint.parent.is_some())
        .map(|joint| joint.offset.length())
        .fold(0.0, f32::max);
    for joint in joints.iter().filter(|joint| joint.parent.is_some()) {
        let offset = joint.offset;
        if !joint.has_position() || offset.length() <= 0.01 * longest {
            continue;
        }
        // How much of the offset the channels hold already, in the median frame.
        let mut shares: Vec<f32> = spread(frames.frame_count, 33)
            .map(|frame| {
                let values = joint.values(frames.frame(frame));
                let value = position(&joint.channels, values, Vec3::ZERO);
                value.dot(offset) / offset.length_squared()
            })
            .collect();
        if shares.is_empty() {
            return None;
        }
        shares.sort_by(f32::total_cmp);
        if shares[shares.len() / 2] > 0.5 {
            replace += 1;
        } else {
            add += 1;
        }
    }
    match (replace, add) {
        (0, 0) => None,
        _ if replace >= add => Some(PositionChannels::Replace),
        _ => Some(PositionChannels::Add),
    }
}

/// Whether adding the root's offset brings the lowest joint nearer to height zero. `clip` has
/// the offset added.
pub(super) fn root_offset_adds(clip: &SkeletonClip, root_offset: Vec3, up: UpAxis) -> bool {
    let height = |position: Vec3| match up {
        UpAxis::Y => position.y,
        UpAxis::Z => position.z,
    };
    let mut pose = SkeletonPose::default();
    let mut lowest = f32::INFINITY;
    for frame in spread(clip.frame_count(), 64) {
        clip.pose_into(frame, &mut pose);
        lowest = pose
            .positions
            .iter()
            .copied()
            .map(height)
            .fold(lowest, f32::min);
    }
    lowest.abs() <= (lowest - height(root_offset)).abs()
}
