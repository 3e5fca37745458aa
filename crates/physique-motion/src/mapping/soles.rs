//! How high ankles and balls of the feet are when the source stands.

use glam::Vec3;
use physique_body::Joint;

use super::{body_rest::BodyRest, foot_tracks::FootTracks};

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
    pub(super) fn measure(feet: &FootTracks, body: &BodyRest) -> Self {
        /// A line from ankle to ball steeper than this belongs to no standing foot.
        const STEEPEST: f32 = 1.0;
        let heights = |tracks: [&[Vec3]; 2]| -> Vec<f32> {
            let positions = tracks.into_iter().flatten();
            positions.map(|position| position.y).collect()
        };
        let [left, right] = &feet.sides;
        let mut ankles = heights([&left.ankles, &right.ankles]);
        let mut balls = heights([&left.balls, &right.balls]);
        let last = |track: &[Vec3]| track.last().copied();
        let foot = feet.sides.iter().rev().find_map(|foot| {
            let (ankle, ball) = (last(&foot.ankles)?, last(&foot.balls)?);
            Some(ankle.distance(ball))
        });
        let ankle_height = low(&mut ankles).unwrap_or(0.0);
        let ball_height = low(&mut balls).unwrap_or(ankle_height);
        let pitch = ((ankle_height - ball_height) / foot.unwrap_or(0.0)).asin();
        let rest = body.bone(Joint::LeftAnkle, Joint::LeftFoot);
        let rest_pitch = (-rest.y).atan2(rest.with_y(0.0).length());
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

    /// Height of a foot's sole over the floor: the lower of heel side and ball is what touches
    /// the ground.
    pub(super) fn over_floor(&self, ankle: Vec3, ball: Option<Vec3>) -> f32 {
        let heel = ankle.y - self.ankle_height;
        ball.map_or(heel, |ball| heel.min(ball.y - self.ball_height))
    }
}

/// The value that 3 of 100 lie below: the floor of noisy heights.
fn low(values: &mut [f32]) -> Option<f32> {
    values.sort_by(f32::total_cmp);
    values.get(values.len() * 3 / 100).copied()
}
