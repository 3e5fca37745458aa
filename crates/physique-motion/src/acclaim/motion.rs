//! The `.amc` file: a line a bone and frame.

use std::collections::HashMap;
use std::path::Path;

use glam::{DQuat, DVec3, Quat};

use super::channel::{Channel, turns};
use super::figure::{Bone, Figure};
use super::text::{Line, key, lines};
use crate::limits::check;
use crate::{Error, Limits};

/// All frames, in the file's unit.
pub(super) struct Motion {
    /// Frames a second, where the file says.
    pub(super) rate: Option<f64>,
    /// `[frames][bones]`, `parent_from_bone`.
    pub(super) rotations: Vec<Quat>,
    /// Bones that move within their parent; the root is the first.
    pub(super) moved: Vec<usize>,
    /// `[frames][moved]`, from where the bone starts at rest.
    pub(super) shifts: Vec<DVec3>,
}

/// Reads the motion of a figure.
pub(super) fn parse(
    text: &[u8],
    path: &Path,
    figure: &Figure,
    limits: &Limits,
) -> Result<Motion, Error> {
    // Frames are counted first: nothing grows, and the limits hold before memory is taken.
    let frames = lines(path, text).filter(|line| frame_number(line).is_some());
    let frames = frames.count();
    check(
        path,
        "the number of frames",
        frames as u64,
        limits.frames as u64,
    )?;
    limits.check_rotations(path, frames, figure.bones.len())?;

    let moves = |bone: &Bone| {
        let is_translation = |channel: &Channel| matches!(channel, Channel::Translation(_));
        bone.parent.is_none() || bone.channels.iter().any(is_translation)
    };
    let moved: Vec<usize> = (0..figure.bones.len())
        .filter(|&bone| moves(&figure.bones[bone]))
        .collect();
    let mut reader = Reader {
        figure,
        by_name: figure.by_name(),
        in_degrees: figure.in_degrees,
        fully_specified: false,
        number: None,
        usual_order: Vec::new(),
        lines_in_frame: 0,
        row: Row::still(figure),
        motion: Motion {
            rate: None,
            rotations: Vec::with_capacity(frames * figure.bones.len()),
            shifts: Vec::with_capacity(frames * moved.len()),
            moved,
        },
    };
    let mut last = None;
    for line in lines(path, text) {
        reader.line(&line)?;
        last = Some(line);
    }
    match last {
        Some(line) if reader.number.is_some() => reader.end_frame(&line)?,
        _ => {
            return Err(Error::Format {
                path: path.into(),
                place: "the file".into(),
                expected: "at least one frame".into(),
                found: "none".into(),
            });
        }
    }
    Ok(reader.motion)
}

/// The number of a frame, if the line is nothing else.
fn frame_number(line: &Line<'_>) -> Option<u64> {
    std::str::from_utf8(line.text).ok()?.parse().ok()
}

/// The frame being read.
struct Row {
    rotations: Vec<DQuat>,
    shifts: Vec<DVec3>,
    seen: Vec<bool>,
}

impl Row {
    fn still(figure: &Figure) -> Self {
        let bones = figure.bones.len();
        let mut rotations = vec![DQuat::IDENTITY; bones];
        rotations[0] = figure.bones[0].axes;
        Self {
            rotations,
            shifts: vec![DVec3::ZERO; bones],
            seen: vec![false; bones],
        }
    }
}

struct Reader<'a> {
    figure: &'a Figure,
    by_name: HashMap<String, usize>,
    in_degrees: bool,
    fully_specified: bool,
    /// Of the frame being read.
    number: Option<u64>,
    /// Bones in the order of the first frame's lines: the next line's bone is seldom another.
    usual_order: Vec<usize>,
    lines_in_frame: usize,
    row: Row,
    motion: Motion,
}

impl Reader<'_> {
    fn line(&mut self, line: &Line<'_>) -> Result<(), Error> {
        if line.text.starts_with(b":") {
            return self.header(line);
        }
        if let Some(number) = frame_number(line) {
            if let Some(before) = self.number {
                self.end_frame(line)?;
                if before.checked_add(1) != Some(number) {
                    let expected = format!("the frame after frame {before}");
                    return Err(line.error(expected, Some(line.text)));
                }
            }
            self.number = Some(number);
            return Ok(());
        }
        if self.number.is_none() {
            return Err(line.error("the number of the first frame", Some(line.text)));
        }
        self.bone(line)
    }

    fn header(&mut self, line: &Line<'_>) -> Result<(), Error> {
        if line.starts_with(":degrees") {
            self.in_degrees = true;
        } else if line.starts_with(":radians") {
            self.in_degrees = false;
        } else if line.starts_with(":fully-specified") {
            self.fully_specified = true;
        } else if line.starts_with(":samples-per-second") {
            let mut words = line.words();
            words.next();
            self.motion.rate = Some(words.number("samples a second")?);
        }
        Ok(())
    }

    fn bone(&mut self, line: &Line<'_>) -> Result<(), Error> {
        let mut words = line.words();
        let name = words.next().unwrap_or_default();
        let index = self.find(name);
        let index = index.ok_or_else(|| line.error("a bone of the skeleton", Some(name)))?;
        let bone = &self.figure.bones[index];
        if std::mem::replace(&mut self.row.seen[index], true) {
            return Err(line.error("every bone once a frame", Some(name)));
        }

        let mut turned = [(0, 0.0); 3];
        let mut turn_count = 0;
        let mut shift = DVec3::ZERO;
        for channel in &bone.channels {
            let number = words.number("as many finite numbers as the bone has in the skeleton")?;
            match *channel {
                Channel::Translation(axis) => shift[axis] = number,
                Channel::Rotation(axis) => {
                    let radians = if self.in_degrees {
                        number.to_radians()
                    } else {
                        number
                    };
                    // No skeleton turns twice about an axis, so there are three at most.
                    turned[turn_count] = (axis, radians);
                    turn_count += 1;
                }
            }
        }
        if let Some(more) = words.next() {
            let expected = format!("{} numbers, as in the skeleton", bone.channels.len());
            return Err(line.error(expected, Some(more)));
        }
        let turn = turns(turned[..turn_count].iter().copied());
        if bone.parent.is_none() {
            self.row.rotations[index] = turn * bone.axes;
            self.row.shifts[index] = shift;
        } else {
            self.row.rotations[index] = bone.axes * turn * bone.axes.inverse();
            self.row.shifts[index] = bone.axes * shift;
        }
        self.lines_in_frame += 1;
        Ok(())
    }

    fn find(&mut self, name: &[u8]) -> Option<usize> {
        let usual = self.usual_order.get(self.lines_in_frame).copied();
        let is_it = |&bone: &usize| self.figure.bones[bone].name.as_bytes() == name;
        usual.filter(is_it).or_else(|| {
            let found = self.by_name.get(&key(name)).copied();
            if self.motion.rotations.is_empty() {
                self.usual_order.extend(found);
            }
            found
        })
    }

    fn end_frame(&mut self, line: &Line<'_>) -> Result<(), Error> {
        let bones = self.figure.bones.iter();
        let missing = bones
            .zip(&self.row.seen)
            .find(|(bone, seen)| !**seen && !bone.channels.is_empty());
        if let (true, Some((bone, _)), Some(number)) = (self.fully_specified, missing, self.number)
        {
            let expected = format!("a line for {} in frame {number}", bone.name);
            return Err(line.error(expected, Some(line.text)));
        }
        self.row.seen.fill(false);
        self.lines_in_frame = 0;
        let Self { row, motion, .. } = self;
        motion
            .rotations
            .extend(row.rotations.iter().map(|rotation| rotation.as_quat()));
        motion
            .shifts
            .extend(motion.moved.iter().map(|&bone| row.shifts[bone]));
        Ok(())
    }
}
