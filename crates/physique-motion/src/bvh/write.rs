//! A clip as BVH text.

use std::{fmt::Write as _, path::Path};

use glam::{DQuat, EulerRot, Quat, Vec3};

use super::channel::{Axis, Channel};
use crate::unspoken::LengthUnit;
use crate::{Error, Motion, SkeletonClip, UpAxis, mapping::BodyRest, write_file::write_file};

/// How to write a clip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhWriteOptions {
    /// Length unit of offsets and positions: centimetres unless stated.
    pub unit: LengthUnit,
    /// Axis that points up in the file: Y unless stated. With Z, the rest pose stands along Z too.
    pub up_axis: UpAxis,
}

impl Default for BvhWriteOptions {
    fn default() -> Self {
        Self {
            unit: LengthUnit::Centimetre,
            up_axis: UpAxis::Y,
        }
    }
}

/// Rotation channels of every joint.
const ROTATION: [Channel; 3] = [
    Channel::Rotation(Axis::Z),
    Channel::Rotation(Axis::Y),
    Channel::Rotation(Axis::X),
];

/// Position channels of the joints that move.
const POSITION: [Channel; 3] = [
    Channel::Position(Axis::X),
    Channel::Position(Axis::Y),
    Channel::Position(Axis::Z),
];

/// Writes a clip to a file, beside it first, then renamed.
///
/// # Errors
/// [`Error::Io`].
pub fn write_clip(
    path: impl AsRef<Path>,
    clip: &SkeletonClip,
    options: &BvhWriteOptions,
) -> Result<(), Error> {
    write_file(path.as_ref(), format_clip(clip, options).as_bytes())
}

/// Writes a motion of the body: 22 joints with the rest pose of `body` as zero pose, so that
/// reading and mapping it again gives the same motion.
///
/// # Errors
/// [`Error::Io`]; [`Error::Skeleton`] when a rest joint is not finite.
pub fn write_motion(
    path: impl AsRef<Path>,
    motion: &Motion,
    body: &BodyRest,
    options: &BvhWriteOptions,
) -> Result<(), Error> {
    write_clip(path, &SkeletonClip::from_motion(motion, body)?, options)
}

/// A clip as BVH text: channels Z, Y, X; six digits after the point, so that centimetres
/// come back within 1e-8 m and angles within 1e-6 degrees of what was rounded.
///
/// A moving root has its offset in its channels (both readings of position channels then agree);
/// other moving joints repeat theirs. Angles run on over 180 degrees instead of jumping. Rest
/// rotations, which BVH cannot say, are in the frames only.
pub fn format_clip(clip: &SkeletonClip, options: &BvhWriteOptions) -> String {
    let joints = clip.skeleton().joint_count();
    let mut children = vec![Vec::new(); joints];
    let mut roots = Vec::new();
    for (index, joint) in clip.skeleton().joints().iter().enumerate() {
        match joint.parent {
            Some(parent) => children[parent].push(index),
            None => roots.push(index),
        }
    }
    let mut writer = Writer {
        clip,
        units_per_metre: 1.0 / options.unit.metres(),
        file_from_ours: options.up_axis.y_up_from_file().inverse(),
        text: String::from("HIERARCHY\n"),
        order: Vec::with_capacity(joints),
    };
    for root in roots {
        writer.tree(root, &children);
    }
    writer.frames();
    writer.text
}

struct Writer<'a> {
    clip: &'a SkeletonClip,
    units_per_metre: f64,
    /// Turns the axes of the world and of every joint; the identity for Y up.
    file_from_ours: Quat,
    text: String,
    /// Joints as the hierarchy lists them: depth first.
    order: Vec<usize>,
}

impl Writer<'_> {
    /// A root and all below it, depth first, with a stack instead of recursion.
    fn tree(&mut self, root: usize, children: &[Vec<usize>]) {
        enum Step {
            Open(usize, usize),
            Close(usize),
        }
        let mut steps = vec![Step::Open(root, 0)];
        while let Some(step) = steps.pop() {
            match step {
                Step::Close(depth) => self.line(depth, "}"),
                Step::Open(joint, depth) => {
                    self.joint(joint, depth, children[joint].is_empty());
                    steps.push(Step::Close(depth));
                    let below = children[joint].iter().rev();
                    steps.extend(below.map(|&child| Step::Open(child, depth + 1)));
                }
            }
        }
    }

    fn joint(&mut self, index: usize, depth: usize, is_leaf: bool) {
        self.order.push(index);
        let joint = &self.clip.skeleton().joints()[index];
        let is_root = joint.parent.is_none();
        let moves = self.clip.moves(index);
        let keyword = if is_root { "ROOT" } else { "JOINT" };
        // A line break or brace inside a name would end it.
        let name = joint.name.replace(['\n', '\r', '{', '}'], "_");
        self.line(depth, &format!("{keyword} {}", name.trim()));
        self.line(depth, "{");
        let offset = if is_root && moves {
            Vec3::ZERO
        } else {
            joint.rest_translation
        };
        let offset = self.vector(offset);
        self.line(depth + 1, &format!("OFFSET {offset}"));
        let channels: Vec<&str> = POSITION
            .iter()
            .filter(|_| moves)
            .chain(&ROTATION)
            .map(|channel| channel.keyword())
            .collect();
        let channels = format!("CHANNELS {} {}", channels.len(), channels.join(" "));
        self.line(depth + 1, &channels);
        let mut sites = joint.end_sites.clone();
        if is_leaf && sites.is_empty() {
            // Many readers demand one at the end of a chain.
            sites.push(Vec3::ZERO);
        }
        for site in sites {
            let offset = self.vector(site);
            self.line(depth + 1, "End Site");
            self.line(depth + 1, "{");
            self.line(depth + 2, &format!("OFFSET {offset}"));
            self.line(depth + 1, "}");
        }
    }

    fn frames(&mut self) {
        let seconds = self.clip.frame_rate().frame_seconds();
        let count = self.clip.frame_count();
        self.text += &format!("MOTION\nFrames: {count}\nFrame Time: {seconds:.8}\n");
        let mut before = vec![[0.0; 3]; self.order.len()];
        for frame in 0..count {
            for (place, &joint) in self.order.iter().enumerate() {
                if place > 0 {
                    self.text.push(' ');
                }
                if self.clip.moves(joint) {
                    let position = self.vector(self.clip.translation(frame, joint));
                    self.text += &position;
                    self.text.push(' ');
                }
                let turned = self.file_from_ours * self.clip.rotation(frame, joint);
                let rotation = turned * self.file_from_ours.inverse();
                let angles = euler_degrees(rotation, before[place]);
                before[place] = angles;
                let [z, y, x] = angles;
                // Writing to a string cannot fail.
                let _ = write!(self.text, "{z:.6} {y:.6} {x:.6}");
            }
            self.text.push('\n');
        }
    }

    fn line(&mut self, depth: usize, content: &str) {
        self.text.extend(std::iter::repeat_n('\t', depth));
        self.text += content;
        self.text.push('\n');
    }

    fn vector(&self, metres: Vec3) -> String {
        let metres = self.file_from_ours * metres;
        let [x, y, z] = (metres.as_dvec3() * self.units_per_metre).to_array();
        format!("{x:.6} {y:.6} {z:.6}")
    }
}

/// Angles about Z, Y, X in degrees, each within half a turn of the frame before.
fn euler_degrees(rotation: Quat, before: [f64; 3]) -> [f64; 3] {
    let rotation = DQuat::from_xyzw(
        f64::from(rotation.x),
        f64::from(rotation.y),
        f64::from(rotation.z),
        f64::from(rotation.w),
    );
    let (z, y, x) = rotation.normalize().to_euler(EulerRot::ZYX);
    let mut angles = [z, y, x].map(f64::to_degrees);
    for (angle, before) in angles.iter_mut().zip(before) {
        *angle -= 360.0 * ((*angle - before) / 360.0).round();
    }
    angles
}
