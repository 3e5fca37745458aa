//! How far each joint turns over a motion.

use glam::{Quat, Vec3};
use physique_body::Joint;
use physique_motion::Motion;
use schemars::JsonSchema;
use serde::Serialize;

use super::Warning;
use super::human_range;

/// The turns of one joint against the T-pose, in degrees.
///
/// A turn is split into the twist about the bone and the swing of the bone; the swing's rotation
/// vector has two parts. Both sides of the body have the same signs.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct JointRange {
    /// SMPL's name.
    pub joint: &'static str,
    /// Trunk, neck and hips: forwards. Knees and elbows: flexion. Ankles: toes up. Arms: forwards
    /// from the T-pose. Wrists: towards the palm.
    pub bend: AxisRange,
    /// Trunk and neck: to the left. Legs: outwards. Arms: upwards. Wrists: towards the thumb.
    pub side: AxisRange,
    /// About the bone. Trunk and neck: to the left. Legs: toes outwards. Arms: palm upwards.
    pub twist: AxisRange,
}

/// The range of one angle over a motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct AxisRange {
    /// Smallest angle.
    pub min: f32,
    /// Largest angle.
    pub max: f32,
    /// 95 of 100 frames are nearer to the T-pose.
    pub percentile_95: f32,
    /// What people reach: from and to, wide.
    pub human: [f32; 2],
    /// Frames beyond what people reach, in per cent.
    pub beyond_percent: f32,
}

impl AxisRange {
    fn of(angles: &mut [f32], human: [f32; 2]) -> Self {
        let beyond = angles
            .iter()
            .filter(|a| **a < human[0] || **a > human[1])
            .count();
        let (min, max) = angles
            .iter()
            .fold((f32::MAX, f32::MIN), |(min, max), angle| {
                (min.min(*angle), max.max(*angle))
            });
        angles.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        Self {
            min,
            max,
            percentile_95: angles[(angles.len() - 1) * 95 / 100].abs(),
            human,
            beyond_percent: 100.0 * beyond as f32 / angles.len() as f32,
        }
    }
}

/// How a joint's turn is told apart: axes in the T-pose, for the left side.
struct Axes {
    bend: Vec3,
    side: Vec3,
    twist: Vec3,
}

/// Axes about which positive angles are those of [`JointRange`].
fn axes(joint: Joint) -> Axes {
    let axes = |bend, side, twist| Axes { bend, side, twist };
    match joint {
        Joint::LeftHip | Joint::RightHip => axes(Vec3::NEG_X, Vec3::Z, Vec3::Y),
        Joint::LeftKnee | Joint::RightKnee => axes(Vec3::X, Vec3::Z, Vec3::Y),
        Joint::LeftAnkle | Joint::RightAnkle | Joint::LeftFoot | Joint::RightFoot => {
            axes(Vec3::NEG_X, Vec3::Y, Vec3::Z)
        }
        Joint::LeftCollar
        | Joint::RightCollar
        | Joint::LeftShoulder
        | Joint::RightShoulder
        | Joint::LeftElbow
        | Joint::RightElbow => axes(Vec3::NEG_Y, Vec3::Z, Vec3::NEG_X),
        Joint::LeftWrist | Joint::RightWrist => axes(Vec3::NEG_Z, Vec3::NEG_Y, Vec3::NEG_X),
        _ => axes(Vec3::X, Vec3::NEG_Z, Vec3::Y),
    }
}

const fn is_right(joint: Joint) -> bool {
    matches!(
        joint,
        Joint::RightHip
            | Joint::RightKnee
            | Joint::RightAnkle
            | Joint::RightFoot
            | Joint::RightCollar
            | Joint::RightShoulder
            | Joint::RightElbow
            | Joint::RightWrist
    )
}

/// Bend, side and twist in degrees.
fn angles(joint: Joint, rotation: Quat) -> [f32; 3] {
    let axes = axes(joint);
    // Seen in a mirror at x = 0, the right side is a left one.
    let [x, y, z, w] = rotation.to_array();
    let rotation = if is_right(joint) {
        Quat::from_xyzw(x, -y, -z, w)
    } else {
        rotation
    };
    let along = rotation.xyz().dot(axes.twist);
    let twist = 2.0 * along.atan2(rotation.w);
    let swing = rotation * Quat::from_axis_angle(axes.twist, twist).conjugate();
    let swing = if swing.w < 0.0 { -swing } else { swing }.to_scaled_axis();
    let half_turn = std::f32::consts::PI;
    let twist = (twist + half_turn).rem_euclid(2.0 * half_turn) - half_turn;
    [swing.dot(axes.bend), swing.dot(axes.side), twist].map(f32::to_degrees)
}

/// All joints but the pelvis, which turns with the person; none for a motion without frames.
pub(super) fn of(motion: &Motion) -> Vec<JointRange> {
    let joints = Joint::ALL.into_iter().skip(1);
    if motion.frame_count() == 0 {
        return Vec::new();
    }
    let range = |joint: Joint| {
        let mut by_axis = [const { Vec::new() }; 3];
        for frame in 0..motion.frame_count() {
            let turns = angles(joint, motion.frame_rotations(frame)[joint.index()]);
            for (all, angle) in by_axis.iter_mut().zip(turns) {
                all.push(angle);
            }
        }
        let human = human_range::of(joint);
        let [bend, side, twist] = &mut by_axis;
        JointRange {
            joint: joint.name(),
            bend: AxisRange::of(bend, human[0]),
            side: AxisRange::of(side, human[1]),
            twist: AxisRange::of(twist, human[2]),
        }
    };
    joints.map(range).collect()
}

/// Knees and elbows that bend the wrong way: the joints whose axes any mapping gets right.
pub(super) fn warnings(ranges: &[JointRange]) -> Vec<Warning> {
    /// In so many frames, in per cent.
    const OFTEN: f32 = 5.0;
    let wrong = ranges.iter().filter(|range| {
        let hinge = range.joint.ends_with("knee") || range.joint.ends_with("elbow");
        hinge && range.bend.min < range.bend.human[0] && range.bend.beyond_percent > OFTEN
    });
    let warning = |range: &JointRange| {
        Warning::new(
            "beyond-human-range",
            format!(
                "The {} bends backwards by up to {:.0} degrees, by more than people do in {:.0} % of frames.",
                range.joint.replace('_', " "),
                -range.bend.min,
                range.bend.beyond_percent
            ),
        )
    };
    wrong.map(warning).collect()
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use physique_body::Joint;

    use super::angles;

    fn assert_angles(joint: Joint, rotation: Quat, expected: [f32; 3]) {
        let found = angles(joint, rotation);
        for (found, expected) in found.into_iter().zip(expected) {
            assert!(
                (found - expected).abs() < 0.01,
                "{joint}: {found} for {expected}"
            );
        }
    }

    #[test]
    fn anatomical_movements_have_their_names_and_signs() {
        let toward = |from: Vec3, to: Vec3| Quat::from_rotation_arc(from, to);
        let (up, down, left, right) = (Vec3::Y, Vec3::NEG_Y, Vec3::X, Vec3::NEG_X);
        let forward = Vec3::Z;
        // Thighs forwards, shins backwards, trunk forwards.
        for hip in [Joint::LeftHip, Joint::RightHip] {
            assert_angles(hip, toward(down, forward), [90.0, 0.0, 0.0]);
        }
        assert_angles(Joint::LeftKnee, toward(down, -forward), [90.0, 0.0, 0.0]);
        assert_angles(Joint::Spine1, toward(up, forward), [90.0, 0.0, 0.0]);
        assert_angles(Joint::Spine1, toward(up, left), [0.0, 90.0, 0.0]);
        // Legs outwards, toes outwards.
        assert_angles(Joint::LeftHip, toward(down, left), [0.0, 90.0, 0.0]);
        assert_angles(Joint::RightHip, toward(down, right), [0.0, 90.0, 0.0]);
        assert_angles(Joint::LeftHip, toward(forward, left), [0.0, 0.0, 90.0]);
        assert_angles(Joint::RightHip, toward(forward, right), [0.0, 0.0, 90.0]);
        // Toes up.
        assert_angles(Joint::LeftAnkle, toward(forward, up), [90.0, 0.0, 0.0]);
        // Arms hang, forearms bend forwards, palms (down in the T-pose) turn up by way of forward.
        assert_angles(Joint::LeftShoulder, toward(left, down), [0.0, -90.0, 0.0]);
        assert_angles(Joint::RightShoulder, toward(right, down), [0.0, -90.0, 0.0]);
        assert_angles(Joint::LeftElbow, toward(left, forward), [90.0, 0.0, 0.0]);
        assert_angles(Joint::RightElbow, toward(right, forward), [90.0, 0.0, 0.0]);
        assert_angles(Joint::LeftElbow, toward(down, forward), [0.0, 0.0, 90.0]);
        assert_angles(Joint::RightElbow, toward(down, forward), [0.0, 0.0, 90.0]);
        assert_angles(Joint::LeftWrist, toward(left, down), [90.0, 0.0, 0.0]);
        assert_angles(Joint::LeftWrist, toward(left, forward), [0.0, 90.0, 0.0]);
    }

    #[test]
    fn swing_and_twist_come_apart() {
        let turn = Quat::from_rotation_y(0.5);
        let bend = Quat::from_rotation_x(-1.0);
        let expected = [1.0_f32.to_degrees(), 0.0, 0.5_f32.to_degrees()];
        assert_angles(Joint::LeftHip, bend * turn, expected);
        assert_angles(Joint::LeftHip, -(bend * turn), expected);
    }
}
