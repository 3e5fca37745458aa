//! From the file's text to a clip in metres with Y up.

use std::path::Path;

use glam::{Quat, Vec3};

use super::{
    channel, frames,
    frames::BvhFrames,
    hierarchy,
    hierarchy::BvhJoint,
    infer::{self, PositionChannels},
    text::Text,
};
use crate::read_file::read_file;
use crate::unspoken::{self, Bone, LengthUnit};
use crate::{Conversion, Error, FrameRate, Limits, Skeleton, SkeletonClip, SkeletonJoint, UpAxis};

/// What to take for granted instead of inferring it; see [`crate::bvh`].
#[derive(Clone, Debug, Default)]
pub struct BvhOptions {
    /// How much a file may ask for.
    pub limits: Limits,
    /// The file's length unit.
    pub unit: Option<LengthUnit>,
    /// The file's up axis.
    pub up_axis: Option<UpAxis>,
    /// What position channels do to a joint's offset.
    pub position_channels: Option<PositionChannels>,
    /// The true frame rate, where the header lies.
    pub frame_rate: Option<FrameRate>,
}

/// Reads a BVH file: about 100 MB a second.
///
/// # Errors
/// [`Error::Io`]; [`Error::Limit`]; [`Error::Format`] with the line, and in a frame the frame,
/// joint and channel.
pub fn read(path: impl AsRef<Path>, options: &BvhOptions) -> Result<SkeletonClip, Error> {
    let path = path.as_ref();
    parse(&read_file(path, options.limits.bytes)?, path, options)
}

/// Reads the text of a BVH file; `path` only names it in errors.
///
/// # Errors
/// As [`read`], without [`Error::Io`].
pub fn parse(
    bytes: &[u8],
    path: impl AsRef<Path>,
    options: &BvhOptions,
) -> Result<SkeletonClip, Error> {
    let path = path.as_ref();
    let mut text = Text::new(path, bytes);
    let joints = hierarchy::parse(&mut text, &options.limits)?;
    let frames = frames::parse(&mut text, &joints, options.frame_rate, &options.limits)?;
    options
        .limits
        .check_rotations(path, frames.frame_count, joints.len())?;
    resolve(&joints, &frames, options)
}

/// Decides unit, axes and position channels, then builds the clip.
fn resolve(
    joints: &[BvhJoint],
    frames: &BvhFrames,
    options: &BvhOptions,
) -> Result<SkeletonClip, Error> {
    let mut notes = Vec::new();
    let moved_roots = joints
        .iter()
        .any(|joint| joint.parent.is_none() && joint.has_position() && joint.offset != Vec3::ZERO);
    let vote = infer::vote_position_channels(joints, frames);
    let stated = options.position_channels.or(vote);
    if let (Some(vote), None) = (vote, options.position_channels) {
        notes.push(match vote {
            PositionChannels::Replace => {
                "position channels replace the offsets, since below the root they repeat them"
            }
            PositionChannels::Add => {
                "position channels add to the offsets, since below the root they lack them"
            }
        });
    }
    let mut notes: Vec<String> = notes.into_iter().map(Into::into).collect();

    let mut meaning = stated.unwrap_or(PositionChannels::Add);
    let unit = options.unit.unwrap_or_else(|| {
        let first = (frames.frame_count > 0).then(|| frames.frame(0));
        let (unit, note) = unspoken::unit(unspoken::tip_to_tip(&bones(joints, first, meaning)));
        notes.push(note);
        unit
    });
    let metres = unit.metres() as f32;
    let skeleton = skeleton(joints, metres)?;
    let mut clip = clip(&skeleton, joints, frames, meaning, metres)?;

    let up_axis = options.up_axis.unwrap_or_else(|| {
        let (up_axis, note) = unspoken::up_axis(&clip);
        notes.extend(note);
        up_axis
    });
    if stated.is_none() && moved_roots {
        let offset = joints[0].offset * metres;
        if infer::root_offset_adds(&clip, offset, up_axis) {
            notes
                .push("the root's channels add to its offset: so the feet reach the ground".into());
        } else {
            notes.push(
                "the root's channels replace its offset: so the feet reach the ground".into(),
            );
            meaning = PositionChannels::Replace;
            clip = self::clip(&skeleton, joints, frames, meaning, metres)?;
        }
    }
    let conversion = Conversion {
        metres_per_unit: unit.metres(),
        up_axis,
        notes,
    };
    clip.turned_upright(conversion)
}

/// Lengths in the file's unit, in its first frame.
fn bones(joints: &[BvhJoint], first: Option<&[f32]>, meaning: PositionChannels) -> Vec<Bone> {
    let longest = |sites: &[Vec3]| sites.iter().map(|site| site.length()).fold(0.0, f32::max);
    joints
        .iter()
        .map(|joint| Bone {
            parent: joint.parent,
            length: translation(joint, first, meaning).length(),
            tips: joint.end_sites.len(),
            longest_tip: longest(&joint.end_sites),
        })
        .collect()
}

fn skeleton(joints: &[BvhJoint], metres: f32) -> Result<Skeleton, Error> {
    let joints = joints.iter().map(|joint| SkeletonJoint {
        name: joint.name.clone(),
        parent: joint.parent,
        rest_translation: joint.offset * metres,
        rest_rotation: Quat::IDENTITY,
        end_sites: joint.end_sites.iter().map(|&site| site * metres).collect(),
    });
    Skeleton::new(joints.collect())
}

fn clip(
    skeleton: &Skeleton,
    joints: &[BvhJoint],
    frames: &BvhFrames,
    meaning: PositionChannels,
    metres: f32,
) -> Result<SkeletonClip, Error> {
    let moved = (0..joints.len()).filter(|&joint| joints[joint].has_position());
    let moved: Vec<usize> = moved.collect();
    let mut rotations = Vec::with_capacity(frames.frame_count * joints.len());
    let mut translations = Vec::with_capacity(frames.frame_count * moved.len());
    for frame in (0..frames.frame_count).map(|frame| frames.frame(frame)) {
        rotations.extend(
            joints
                .iter()
                .map(|joint| channel::rotation(&joint.channels, joint.values(frame))),
        );
        translations.extend(
            moved
                .iter()
                .map(|&joint| translation(&joints[joint], Some(frame), meaning) * metres),
        );
    }
    let conversion = Conversion::default();
    let rate = frames.frame_rate;
    SkeletonClip::new(
        skeleton.clone(),
        rate,
        conversion,
        rotations,
        moved,
        translations,
    )
}

/// A joint's origin in its parent's frame, in the file's unit.
fn translation(joint: &BvhJoint, frame: Option<&[f32]>, meaning: PositionChannels) -> Vec3 {
    let Some(frame) = frame else {
        return joint.offset;
    };
    let values = joint.values(frame);
    match meaning {
        PositionChannels::Replace => channel::position(&joint.channels, values, joint.offset),
        PositionChannels::Add => {
            joint.offset + channel::position(&joint.channels, values, Vec3::ZERO)
        }
    }
}
