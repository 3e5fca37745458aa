//! Who moves where.

use glam::{Vec2, Vec3};
use physique_body::Joint;
use physique_motion::features::JointPositions;
use schemars::JsonSchema;
use serde::Serialize;

use super::Warning;

/// The pelvis's way over the ground, in metres of the person recorded.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Movement {
    /// Length of the way.
    pub path_m: f64,
    /// From its start to its end.
    pub displacement_m: f64,
    /// The way over the time.
    pub mean_speed_m_s: f64,
    /// Sides of the rectangle around the way, along X and Z.
    pub floor_m: [f64; 2],
    /// Lowest and highest place of the pelvis over the ground.
    pub pelvis_height_m: [f64; 2],
    /// Where the body faces in the first frame: degrees from +Z towards +X.
    pub facing_degrees: f64,
    /// Sum of all turning, left positive.
    pub turned_degrees: f64,
    /// Heights over the ground at which the lower foot's ball stands still while the person is
    /// upright: those that 5 and 95 of 100 such frames stay above; null where it never stands.
    pub standing_height_m: Option<[f64; 2]>,
}

impl Movement {
    /// Of at least one frame; `scale` is the body's size over the person's.
    pub(super) fn of(positions: &JointPositions, scale: f64) -> Self {
        let pelvis: Vec<Vec3> = positions.frames().map(|joints| joints[0]).collect();
        let way = smooth(&pelvis, positions.frame_rate().per_second());
        let metres = |length: f32| f64::from(length) / scale;
        let steps = way.windows(2).map(|pair| pair[0].distance(pair[1]));
        let path = metres(steps.sum());
        let (low, high) = way
            .iter()
            .fold((Vec2::MAX, Vec2::MIN), |(low, high), place| {
                (low.min(*place), high.max(*place))
            });
        let (lowest, highest) = pelvis
            .iter()
            .fold((f32::MAX, f32::MIN), |(low, high), place| {
                (low.min(place.y), high.max(place.y))
            });
        let seconds = (pelvis.len() - 1) as f64 / positions.frame_rate().per_second();
        let headings: Vec<f32> = positions.frames().filter_map(heading).collect();
        let turns = headings.windows(2).map(|pair| wrapped(pair[1] - pair[0]));
        let ends = way.first().zip(way.last());
        Self {
            path_m: path,
            displacement_m: ends.map_or(0.0, |(first, last)| metres(first.distance(*last))),
            mean_speed_m_s: if seconds > 0.0 { path / seconds } else { 0.0 },
            floor_m: [metres(high.x - low.x), metres(high.y - low.y)],
            pelvis_height_m: [metres(lowest), metres(highest)],
            facing_degrees: f64::from(headings.first().copied().unwrap_or(0.0)).to_degrees(),
            turned_degrees: f64::from(turns.sum::<f32>()).to_degrees(),
            standing_height_m: standing_height(positions, scale),
        }
    }

    /// Ground that is not level.
    pub(super) fn warnings(&self) -> Option<Warning> {
        /// Shoes, tiptoes and the errors of a recording stay below, in metres.
        const UNEVEN: f64 = 0.15;
        let [low, high] = self.standing_height_m?;
        (high - low > UNEVEN).then(|| {
            let message = format!(
                "The feet stand at heights that differ by {:.0} cm: steps, a slope or furniture, or \
                 the recording drifts.",
                100.0 * (high - low)
            );
            Warning::new("uneven-ground", message)
        })
    }
}

/// See [`Movement::standing_height_m`].
fn standing_height(positions: &JointPositions, scale: f64) -> Option<[f64; 2]> {
    /// Slower feet stand, in metres a second.
    const STILL: f64 = 0.1;
    /// The pelvis of an upright person is so high above the foot, in metres.
    const UPRIGHT: f64 = 0.6;
    let frame_rate = positions.frame_rate().per_second();
    let reach = (0.05 * frame_rate).round().max(1.0) as usize;
    let mut heights = Vec::new();
    for frame in reach..positions.frame_count().saturating_sub(reach) {
        let joints = positions.frame(frame);
        let [left, right] = [Joint::LeftFoot, Joint::RightFoot].map(Joint::index);
        let foot = if joints[left].y < joints[right].y {
            left
        } else {
            right
        };
        let before = positions.frame(frame - reach)[foot];
        let after = positions.frame(frame + reach)[foot];
        let seconds = 2.0 * reach as f64 / frame_rate;
        let speed = f64::from(before.distance(after)) / scale / seconds;
        let pelvis = f64::from(joints[0].y - joints[foot].y) / scale;
        if speed < STILL && pelvis > UPRIGHT {
            heights.push(f64::from(joints[foot].y) / scale);
        }
    }
    heights.sort_by(f64::total_cmp);
    let last = heights.len().checked_sub(1)?;
    Some([heights[last * 5 / 100], heights[last * 95 / 100]])
}

/// Places on the ground, mean over a quarter of a second: swaying is no walking.
fn smooth(pelvis: &[Vec3], per_second: f64) -> Vec<Vec2> {
    let reach = (0.125 * per_second).round() as usize;
    let mean = |frame: usize| {
        // The same reach to both sides keeps the ends where they are.
        let reach = reach.min(frame).min(pelvis.len() - 1 - frame);
        let around = &pelvis[frame - reach..=frame + reach];
        let sum: Vec3 = around.iter().sum();
        let mean = sum / around.len() as f32;
        Vec2::new(mean.x, mean.z)
    };
    (0..pelvis.len()).map(mean).collect()
}

/// Angle from +Z towards +X of where hips and shoulders face; `None` where they lie level.
fn heading(joints: &[Vec3]) -> Option<f32> {
    let across = |left: Joint, right: Joint| joints[left.index()] - joints[right.index()];
    let left =
        across(Joint::LeftHip, Joint::RightHip) + across(Joint::LeftShoulder, Joint::RightShoulder);
    let forward = left.cross(Vec3::Y);
    (forward.length() > 0.05).then(|| forward.x.atan2(forward.z))
}

/// An angle within half a turn.
fn wrapped(angle: f32) -> f32 {
    use std::f32::consts::{PI, TAU};
    (angle + PI).rem_euclid(TAU) - PI
}
