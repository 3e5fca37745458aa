//! What BVH does not say: unit, up axis, and what position channels mean.

use glam::Vec3;

use super::{channel::position, frames::BvhFrames, hierarchy::BvhJoint};
use crate::{SkeletonClip, SkeletonPose, UpAxis, clip::spread, mapping::HumanJoints};

/// The length unit of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LengthUnit {
    /// 1 m.
    Metre,
    /// 1 cm.
    Centimetre,
    /// 1 mm.
    Millimetre,
    /// 2.54 cm.
    Inch,
    /// (1 / 0.45) inch = 5.644 cm, the unit of CMU's ASF/AMC recordings.
    Acclaim,
    /// Metres in one unit of the file.
    Metres(f64),
}

impl LengthUnit {
    /// The units that inference chooses from.
    const NAMED: [Self; 5] = [
        Self::Metre,
        Self::Centimetre,
        Self::Millimetre,
        Self::Inch,
        Self::Acclaim,
    ];

    /// Metres in one unit.
    pub fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 0.01,
            Self::Millimetre => 0.001,
            Self::Inch => 0.0254,
            Self::Acclaim => 0.0254 / 0.45,
            Self::Metres(metres) => metres,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Metre => "metres",
            Self::Centimetre => "centimetres",
            Self::Millimetre => "millimetres",
            Self::Inch => "inches",
            Self::Acclaim => "Acclaim units of 5.644 cm",
            Self::Metres(_) => "units",
        }
    }
}

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

/// Length of the longest way through the skeleton, tip to tip, in the file's unit.
///
/// Bones above the first branching do not count: they place the figure in the world. `bone` is
/// the length from a joint's parent to the joint.
pub(super) fn tip_to_tip(joints: &[BvhJoint], bone: impl Fn(usize) -> f32) -> f32 {
    // Longest way down from each joint, children before parents.
    let mut down = vec![0.0f32; joints.len()];
    let mut widest = 0.0f32;
    for (index, joint) in joints.iter().enumerate() {
        for site in &joint.end_sites {
            down[index] = down[index].max(site.length());
        }
    }
    let mut through = down.clone();
    for index in (0..joints.len()).rev() {
        widest = widest.max(through[index]);
        let Some(parent) = joints[index].parent else {
            continue;
        };
        let arm = down[index] + bone(index);
        let children = joints.iter().filter(|joint| joint.parent == Some(parent));
        if children.count() + joints[parent].end_sites.len() > 1 {
            through[parent] = through[parent].max(down[parent] + arm);
        }
        down[parent] = down[parent].max(arm);
    }
    widest
}

/// The unit that makes the longest way through the skeleton human, and a note that says so.
pub(super) fn unit(tip_to_tip: f32) -> (LengthUnit, String) {
    /// Foot to the other hand of an adult of 1.7 m, along the bones.
    const ADULT_METRES: f64 = 2.3;
    let length = f64::from(tip_to_tip);
    if length <= 0.0 {
        let note = "unit: metres, since the skeleton has no length";
        return (LengthUnit::Metre, note.into());
    }
    let off = |unit: LengthUnit| (length * unit.metres() / ADULT_METRES).ln().abs();
    let unit = LengthUnit::NAMED
        .into_iter()
        .min_by(|&a, &b| off(a).total_cmp(&off(b)))
        .unwrap_or(LengthUnit::Metre);
    let mut note = format!(
        "unit: {}, since the longest way through the skeleton is {length:.1} of the file's units, \
         so {:.2} m",
        unit.name(),
        length * unit.metres(),
    );
    if off(unit) > 0.6 {
        note += " (unlike an adult's 2.3 m: state the unit if this is wrong)";
    }
    (unit, note)
}

/// The axis along which the figure stands, and a note where that is not Y.
pub(super) fn up_axis(clip: &SkeletonClip, human: &HumanJoints) -> UpAxis {
    let mut pose = SkeletonPose::default();
    let (mut along_z, mut frames) = (0, 0);
    for frame in spread(clip.frame_count(), 64) {
        clip.pose_into(frame, &mut pose);
        let middle = |[a, b]: [usize; 2]| (pose.positions[a] + pose.positions[b]) / 2.0;
        let upright = middle(human.shoulders()) - middle(human.ankles());
        along_z += usize::from(upright.z > upright.y.abs() && upright.z > upright.x.abs());
        frames += 1;
    }
    if frames > 0 && along_z * 5 >= frames * 4 {
        UpAxis::Z
    } else {
        UpAxis::Y
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
