//! Where ankles and balls of the feet are over a clip.

use glam::{Quat, Vec3};

use super::{figure::ball_of_foot, human_joints::HumanJoints};
use crate::{SkeletonClip, SkeletonPose};

/// One foot of the source over a clip, in the source's world, in metres.
#[derive(Clone, Debug, Default)]
pub(super) struct FootTrack {
    /// By frame.
    pub(super) ankles: Vec<Vec3>,
    /// By frame; empty for a foot that ends at its ankle.
    pub(super) balls: Vec<Vec3>,
}

/// Both feet of the source over a clip.
#[derive(Clone, Debug)]
pub(super) struct FootTracks {
    /// Left, right.
    pub(super) sides: [FootTrack; 2],
    /// Frames a second.
    pub(super) frame_rate: f32,
}

impl FootTracks {
    /// Follows the feet through all frames from `first_frame` on.
    pub(super) fn of(clip: &SkeletonClip, human: &HumanJoints, first_frame: usize) -> Self {
        let balls = human
            .sides()
            .map(|limbs| ball_of_foot(clip.skeleton(), limbs));
        let mut sides = [FootTrack::default(), FootTrack::default()];
        let mut pose = SkeletonPose::default();
        for frame in first_frame..clip.frame_count() {
            clip.pose_into(frame, &mut pose);
            for ((track, ball), limbs) in sides.iter_mut().zip(balls).zip(human.sides()) {
                track.ankles.push(pose.positions[limbs.ankle]);
                if let Some((joint, offset)) = ball {
                    let ball = pose.positions[joint] + pose.rotations[joint] * offset;
                    track.balls.push(ball);
                }
            }
        }
        Self {
            sides,
            frame_rate: clip.frame_rate().per_second() as f32,
        }
    }

    /// The feet after the world is turned.
    pub(super) fn turned(mut self, turn: Quat) -> Self {
        for track in &mut self.sides {
            for position in track.ankles.iter_mut().chain(&mut track.balls) {
                *position = turn * *position;
            }
        }
        self
    }

    /// Number of frames.
    pub(super) fn frame_count(&self) -> usize {
        self.sides[0].ankles.len()
    }

    /// Whether a foot bears on its ball in a frame: the ball, or the ankle of a foot without one,
    /// hardly moves for a fifteenth of a second. A heel may rise meanwhile.
    pub(super) fn stands(&self, side: usize, frame: usize) -> bool {
        const METRES_A_SECOND: f32 = 0.15;
        const HALF_WINDOW_SECONDS: f32 = 1.0 / 30.0;
        let track = &self.sides[side];
        let around = ((self.frame_rate * HALF_WINDOW_SECONDS).round() as usize).max(1);
        let first = frame.saturating_sub(around);
        let last = frame.saturating_add(around).min(self.frame_count() - 1);
        let way = track.tip(first).distance(track.tip(last));
        last > first && way * self.frame_rate < METRES_A_SECOND * (last - first) as f32
    }
}

impl FootTrack {
    /// The ball of the foot, or the ankle of a foot without one.
    pub(super) fn tip(&self, frame: usize) -> Vec3 {
        self.balls.get(frame).copied().unwrap_or(self.ankles[frame])
    }
}

/// The side with the lower of two heights, the left of equals.
pub(super) fn lower_of(height: impl Fn(usize) -> f32) -> usize {
    usize::from(height(1) < height(0))
}
