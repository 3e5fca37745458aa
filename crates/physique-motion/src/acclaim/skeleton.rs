//! The `.asf` file: bones, their axes and which numbers move them.

use std::path::Path;

use glam::{DQuat, DVec3};

use super::channel::{Channel, axis, turns};
use super::figure::{Bone, Figure, in_order};
use super::text::{Line, Words, key, lines};
use crate::limits::check;
use crate::{Error, Limits};

enum Section {
    Units,
    Root,
    Bones,
    Hierarchy,
    /// Notes, names, and what other programs add.
    Other,
}

/// What is read before the bones are in order.
struct Draft {
    length_factor: f64,
    in_degrees: bool,
    root: Bone,
    root_orientation: [f64; 3],
    root_axes: [usize; 3],
    bones: Vec<Bone>,
    open: Option<OpenBone>,
    /// Parents' and children's names.
    edges: Vec<(String, String)>,
}

/// A bone between `begin` and `end`.
#[derive(Default)]
struct OpenBone {
    bone: Bone,
    direction: DVec3,
    length: f64,
}

/// Reads a skeleton.
pub(super) fn parse(text: &[u8], path: &Path, limits: &Limits) -> Result<Figure, Error> {
    let mut draft = Draft {
        length_factor: 1.0,
        in_degrees: true,
        root: Bone {
            name: "root".into(),
            ..Bone::default()
        },
        root_orientation: [0.0; 3],
        root_axes: [0, 1, 2],
        bones: Vec::new(),
        open: None,
        edges: Vec::new(),
    };
    let mut section = Section::Other;
    for line in lines(path, text) {
        if line.text.starts_with(b":") {
            section = match () {
                () if line.starts_with(":units") => Section::Units,
                () if line.starts_with(":root") => Section::Root,
                () if line.starts_with(":bonedata") => Section::Bones,
                () if line.starts_with(":hierarchy") => Section::Hierarchy,
                () => Section::Other,
            };
            continue;
        }
        match section {
            Section::Units => draft.unit(&line)?,
            Section::Root => draft.root(&line)?,
            Section::Bones => {
                check(
                    path,
                    "the number of joints",
                    draft.bones.len() as u64 + 1,
                    limits.joints as u64,
                )?;
                draft.bone(&line)?;
            }
            Section::Hierarchy => draft.edges(&line, path, limits)?,
            Section::Other => {}
        }
    }
    draft.finish(path, limits)
}

impl Draft {
    fn unit(&mut self, line: &Line<'_>) -> Result<(), Error> {
        let mut words = line.words();
        let key = words.next().map(<[u8]>::to_ascii_lowercase);
        match key.as_deref() {
            Some(b"length") => {
                self.length_factor = words.number("a factor of the length unit")?;
                if self.length_factor < 1e-9 {
                    return Err(line.error("a factor above 0", Some(line.text)));
                }
            }
            Some(b"angle") => {
                self.in_degrees = match words.next().map(<[u8]>::to_ascii_lowercase).as_deref() {
                    Some([b'd', b'e', b'g', ..]) => true,
                    Some([b'r', b'a', b'd', ..]) => false,
                    _ => return Err(line.error("angle deg or angle rad", Some(line.text))),
                };
            }
            _ => {}
        }
        Ok(())
    }

    fn root(&mut self, line: &Line<'_>) -> Result<(), Error> {
        let mut words = line.words();
        let key = words.next().map(<[u8]>::to_ascii_lowercase);
        match key.as_deref() {
            Some(b"order") => self.root.channels = channels(line, words)?,
            Some(b"axis") => self.root_axes = axes(line, words.next())?,
            Some(b"position") => {
                self.root.reach = DVec3::from_array(words.vector("the root's position")?);
            }
            Some(b"orientation") => {
                self.root_orientation = words.vector("the root's orientation")?;
            }
            _ => {}
        }
        Ok(())
    }

    fn bone(&mut self, line: &Line<'_>) -> Result<(), Error> {
        let mut words = line.words();
        let key = words.next().map(<[u8]>::to_ascii_lowercase);
        let key = key.as_deref().unwrap_or_default();
        if self.open.is_none() {
            if key != b"begin" {
                return Err(line.error("begin", Some(line.text)));
            }
            self.open = Some(OpenBone::default());
            return Ok(());
        }
        let Some(open) = &mut self.open else {
            return Ok(());
        };
        match key {
            b"name" => {
                let name = words.next().unwrap_or_default();
                open.bone.name = String::from_utf8_lossy(name).into_owned();
            }
            b"direction" => {
                open.direction = DVec3::from_array(words.vector("three numbers of a direction")?);
            }
            b"length" => open.length = words.number("the bone's length")?,
            b"axis" => {
                let angles = words.vector("three angles of the bone's axis")?;
                let order = match words.next() {
                    None => [0, 1, 2],
                    order => axes(line, order)?,
                };
                open.bone.axes = orientation(angles, order, self.in_degrees);
            }
            b"dof" => open.bone.channels = channels(line, words)?,
            b"begin" => return Err(line.error("end before the next begin", Some(line.text))),
            b"end" => {
                if open.bone.name.is_empty() {
                    return Err(line.error("a bone with a name", Some(b"a bone without one")));
                }
                // Files round directions to six digits.
                let direction = open.direction.normalize_or_zero();
                let mut bone = std::mem::take(&mut open.bone);
                bone.reach = direction * open.length;
                self.bones.push(bone);
                self.open = None;
            }
            // Identity, mass and limits of the bone.
            _ => {}
        }
        Ok(())
    }

    fn edges(&mut self, line: &Line<'_>, path: &Path, limits: &Limits) -> Result<(), Error> {
        let mut words = line.words().map(key);
        let parent = words.next().unwrap_or_default();
        let before = self.edges.len();
        for child in words {
            let edges = self.edges.len() as u64 + 1;
            check(path, "the number of joints", edges, limits.joints as u64)?;
            self.edges.push((parent.clone(), child));
        }
        if self.edges.len() == before && !matches!(&*parent, "begin" | "end") {
            return Err(line.error("a bone and its children", Some(line.text)));
        }
        Ok(())
    }

    /// Puts every bone after its parent.
    fn finish(mut self, path: &Path, limits: &Limits) -> Result<Figure, Error> {
        let error = |place: &str, expected: &str, found: String| Error::Format {
            path: path.into(),
            place: place.into(),
            expected: expected.into(),
            found,
        };
        if self.open.is_some() {
            let found = "the end of the section".into();
            return Err(error(":bonedata", "end after the last bone", found));
        }
        if self.bones.is_empty() {
            return Err(error(":bonedata", "at least one bone", "none".into()));
        }
        self.root.axes = orientation(self.root_orientation, self.root_axes, self.in_degrees);
        if self.root.channels.is_empty() {
            use Channel::{Rotation, Translation};
            self.root.channels = [0, 1, 2].map(Translation).to_vec();
            self.root.channels.extend([0, 1, 2].map(Rotation));
        }
        let mut drafts = vec![self.root];
        drafts.append(&mut self.bones);
        Ok(Figure {
            length_factor: self.length_factor,
            in_degrees: self.in_degrees,
            bones: in_order(drafts, &self.edges, path, limits)?,
        })
    }
}

/// Angles about X, Y and Z, turned in an order.
fn orientation(angles: [f64; 3], order: [usize; 3], in_degrees: bool) -> DQuat {
    let radians = angles.map(|angle| {
        if in_degrees {
            angle.to_radians()
        } else {
            angle
        }
    });
    turns(order.into_iter().map(|axis| (axis, radians[axis])))
}

/// An order of axes such as `XYZ`.
fn axes(line: &Line<'_>, word: Option<&[u8]>) -> Result<[usize; 3], Error> {
    let order = word.and_then(|word| {
        let letters: [u8; 3] = word.try_into().ok()?;
        let order = [axis(letters[0])?, axis(letters[1])?, axis(letters[2])?];
        let mut sorted = order;
        sorted.sort_unstable();
        (sorted == [0, 1, 2]).then_some(order)
    });
    order.ok_or_else(|| line.error("an order of axes such as XYZ", word))
}

/// Tokens of `dof` or `order`.
fn channels(line: &Line<'_>, words: Words<'_>) -> Result<Vec<Channel>, Error> {
    let mut channels = Vec::new();
    for word in words {
        let channel = Channel::from_token(word);
        match channel.filter(|channel| !channels.contains(channel)) {
            Some(channel) => channels.push(channel),
            None => {
                return Err(line.error("each of tx, ty, tz, rx, ry, rz at most once", Some(word)));
            }
        }
    }
    Ok(channels)
}
