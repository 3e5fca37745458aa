//! How high ankles and balls of the feet are when the source stands.

use physique_body::Joint;

use super::{body_rest::BodyRest, figure::ball_of_foot, human_joints::HumanJoints};
use crate::{SkeletonClip, SkeletonPose, clip::spread};

/// Heights of a standing foot of the source, in its own size and world, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Soles {
    /// Height of the ankles of a standing foot.
    pub(super) ankle_height: f32,
    /// Height of the balls of a standing foot.
    pub(super) ball_height: f32,
    /// How far the line from ankle to ball points down when the sole is level, in radians.
    pub(super) pitch: f32,
}

impl Soles {
    /// Measures over both feet: they stand in the lowest few of a hundred frames.
    pub(super) fn measure(clip: &SkeletonClip, human: &HumanJoints, body: &BodyRest) -> Self {
        const MOST_FRAMES: usize = 4000;
        /// A line from ankle to ball steeper than this belongs to no standing foot.
        const STEEPEST: f32 = 1.0;
        let balls = human
            .sides()
            .map(|limbs| ball_of_foot(clip.skeleton(), limbs));
        let (mut ankles, mut tips, mut length) = (Vec::new(), Vec::new(), 0.0);
        let mut pose = SkeletonPose::default();
        for frame in spread(clip.frame_count(), MOST_FRAMES) {
            clip.pose_into(frame, &mut pose);
            for (limbs, ball) in human.sides().into_iter().zip(balls) {
                let ankle = pose.positions[limbs.ankle];
                ankles.push(ankle.y);
                if let Some((joint, offset)) = ball {
                    let tip = pose.positions[joint] + pose.rotations[joint] * offset;
                    tips.push(tip.y);
                    length = tip.distance(ankle);
                }
            }
        }
        let ankle_height = low(&mut ankles).unwrap_or(0.0);
        let rest = body.bone(Joint::LeftAnkle, Joint::LeftFoot);
        let rest_pitch = (-rest.y).atan2(rest.with_y(0.0).length());
        let ball_height = low(&mut tips).unwrap_or(ankle_height);
        let pitch = ((ankle_height - ball_height) / length).asin();
        Self {
            ankle_height,
            ball_height,
            // NaN for a foot without length is in no range.
            pitch: if (0.0..STEEPEST).contains(&pitch) {
                pitch
            } else {
                rest_pitch
            },
        }
    }
}

/// The value that 3 of 100 lie below: the floor of noisy heights.
fn low(values: &mut [f32]) -> Option<f32> {
    values.sort_by(f32::total_cmp);
    values.get(values.len() * 3 / 100).copied()
}
