//! The `HIERARCHY` section: joints, offsets, channels.

use glam::Vec3;

use super::{channel::Channel, text::Text};
use crate::{Error, Limits};

/// A joint as the file describes it, in the file's unit.
#[derive(Clone, Debug)]
pub(super) struct BvhJoint {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    pub(super) offset: Vec3,
    pub(super) channels: Vec<Channel>,
    /// Column of the joint's first channel.
    pub(super) first_column: usize,
    pub(super) end_sites: Vec<Vec3>,
}

impl BvhJoint {
    /// The joint's columns of a frame.
    pub(super) fn values<'a>(&self, frame: &'a [f32]) -> &'a [f32] {
        &frame[self.first_column..self.first_column + self.channels.len()]
    }

    /// Whether the file moves the joint within its parent.
    pub(super) fn has_position(&self) -> bool {
        let is_position = |channel: &Channel| matches!(channel, Channel::Position(_));
        self.channels.iter().any(is_position)
    }
}

/// What an open brace belongs to.
enum Block {
    Joint(usize),
    EndSite(usize),
}

/// Below this, numbers stay finite in 32 bits however many joints add up.
pub(super) const LARGEST: f32 = 1e30;

/// No exporter writes more channels than three positions and a few rotations.
const MOST_CHANNELS: u64 = 12;

/// Reads up to and with the word `MOTION`. Nesting is a stack, not recursion.
pub(super) fn parse(text: &mut Text<'_>, limits: &Limits) -> Result<Vec<BvhJoint>, Error> {
    text.expect("HIERARCHY")?;
    let mut joints: Vec<BvhJoint> = Vec::new();
    let mut open: Vec<Block> = Vec::new();
    let mut columns = 0;
    loop {
        let word = text.word();
        let keyword = word.map(<[u8]>::to_ascii_uppercase).unwrap_or_default();
        match (keyword.as_slice(), open.last()) {
            (b"ROOT", None) | (b"JOINT", None | Some(Block::Joint(_))) => {
                let parent = match open.last() {
                    Some(Block::Joint(parent)) => Some(*parent),
                    _ => None,
                };
                check_limit(
                    text,
                    "the number of joints",
                    joints.len() + 1,
                    limits.joints,
                )?;
                check_limit(
                    text,
                    "the depth of the hierarchy",
                    open.len() + 1,
                    limits.depth,
                )?;
                let name = String::from_utf8_lossy(text.rest_of_line()).into_owned();
                if name.is_empty() {
                    return Err(text.error("a joint's name on the same line", None));
                }
                text.expect("{")?;
                open.push(Block::Joint(joints.len()));
                joints.push(BvhJoint {
                    name,
                    parent,
                    offset: Vec3::ZERO,
                    channels: Vec::new(),
                    first_column: columns,
                    end_sites: Vec::new(),
                });
            }
            (b"END", Some(Block::Joint(joint))) => {
                let joint = *joint;
                text.rest_of_line(); // "Site", or whatever an exporter calls it.
                text.expect("{")?;
                open.push(Block::EndSite(joint));
            }
            (b"OFFSET", Some(block)) => {
                let offset = vector(text)?;
                match block {
                    Block::Joint(joint) => joints[*joint].offset = offset,
                    Block::EndSite(joint) => joints[*joint].end_sites.push(offset),
                }
            }
            (b"CHANNELS", Some(Block::Joint(joint))) if joints[*joint].channels.is_empty() => {
                let channels = channels(text)?;
                joints[*joint].first_column = columns;
                columns += channels.len();
                joints[*joint].channels = channels;
            }
            (b"}", Some(_)) => {
                open.pop();
            }
            (b"MOTION", None) if !joints.is_empty() => return Ok(joints),
            (_, None) if joints.is_empty() => return Err(text.error("ROOT", word)),
            (_, None) => return Err(text.error("MOTION or another ROOT", word)),
            (_, Some(Block::EndSite(_))) => return Err(text.error("OFFSET or }", word)),
            (_, Some(Block::Joint(_))) => {
                return Err(text.error("OFFSET, CHANNELS (once), JOINT, End Site or }", word));
            }
        }
    }
}

fn vector(text: &mut Text<'_>) -> Result<Vec3, Error> {
    let mut number = || text.number("three finite numbers after OFFSET");
    let offset = Vec3::new(number()? as f32, number()? as f32, number()? as f32);
    if offset.abs().max_element() < LARGEST {
        Ok(offset)
    } else {
        Err(text.error("an offset below 1e30", Some(b"a larger one")))
    }
}

fn channels(text: &mut Text<'_>) -> Result<Vec<Channel>, Error> {
    let count = text.count("the number of channels")?;
    if count > MOST_CHANNELS {
        let found = count.to_string();
        return Err(text.error("at most 12 channels", Some(found.as_bytes())));
    }
    (0..count)
        .map(|_| {
            let word = text.word();
            word.and_then(|word| Channel::from_keyword(std::str::from_utf8(word).ok()?))
                .ok_or_else(|| text.error("a channel such as Xposition or Zrotation", word))
        })
        .collect()
}

fn check_limit(
    text: &Text<'_>,
    what: &'static str,
    found: usize,
    limit: usize,
) -> Result<(), Error> {
    if found <= limit {
        return Ok(());
    }
    Err(Error::Limit {
        path: text.path().into(),
        what,
        found: found as u64,
        limit: limit as u64,
    })
}
