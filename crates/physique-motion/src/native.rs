//! Physique's own motion file: a [`Recording`], bit for bit, as an `.npz` that NumPy opens.
//!
//! The usual name is `NAME.motion.npz`. Version 1 holds these arrays, little-endian, in C order:
//!
//! | array | type | shape | meaning |
//! |---|---|---|---|
//! | `physique_motion` | i8 | | version of this table, 1; marks the format |
//! | `frame_rate` | f8 | | frames a second |
//! | `rotations` | f4 | frames, 22, 4 | unit quaternions (x, y, z, w), `parent_from_joint` relative to the rest pose |
//! | `root_translation` | f4 | frames, 3 | metres; the pelvis stands at `rest_pelvis + root_translation` |
//! | `rest_pelvis` | f4 | 3 | metres |
//! | `joints` | text | | the 22 names in order, separated by spaces |
//! | `name` | text | | what to call it |
//! | `source`, `licence` | text | | where it comes from and on which terms; may be missing |
//! | `notes` | text | | a sentence a line; may be missing |
//! | `shape_space` | text | | `open`, `smpl` or `smplx`, which the betas belong to; may be missing with the next two |
//! | `betas` | f4 | betas | shape coefficients |
//! | `gender` | text | | as its source spells it; may be missing |
//!
//! The world is Y up, right-handed, in metres. Arrays of other names are ignored, so that a
//! version stays readable when something is added beside it. In Python:
//!
//! ```python
//! motion = numpy.load("walk.motion.npz")
//! motion["rotations"].shape  # (frames, 22, 4)
//! ```

use std::path::Path;

use glam::{Quat, Vec3};
use physique_body::Joint;

use crate::fields::Fields;
use crate::npz::{Archive, ArchiveWriter, ArrayError};
use crate::read::{open_archive, stem};
use crate::read_file::read_file;
use crate::write_file::write_file;
use crate::{Error, FrameRate, Motion, MotionShape, ReadOptions, Recording, ShapeSpace};

/// The version that is written and read.
pub const VERSION: i64 = 1;

/// The array whose presence marks the format.
pub(crate) const MARK: &str = "physique_motion";

const SPACES: [(&str, ShapeSpace); 3] = [
    ("open", ShapeSpace::Open),
    ("smpl", ShapeSpace::Smpl),
    ("smplx", ShapeSpace::SmplX),
];

/// Writes a recording, beside the file first, then renamed.
///
/// # Errors
/// [`Error::Io`], and [`Error::Array`] for a motion that outgrows the ZIP format.
pub fn write(path: impl AsRef<Path>, recording: &Recording) -> Result<(), Error> {
    let path = path.as_ref();
    let bytes = to_npz(recording).map_err(|problem| Error::Array {
        path: path.into(),
        problem,
    })?;
    write_file(path, &bytes)
}

/// The bytes of a recording's file; equal recordings give equal bytes.
///
/// # Errors
/// [`ArrayError::Write`] for a motion that outgrows the ZIP format.
pub fn to_npz(recording: &Recording) -> Result<Vec<u8>, ArrayError> {
    let motion = &recording.motion;
    let frames = motion.frame_count();
    let rotations: Vec<f32> = motion.rotations().iter().flat_map(Quat::to_array).collect();
    let translations = motion.root_translation().iter();
    let translations: Vec<f32> = translations.flat_map(Vec3::to_array).collect();

    let mut archive = ArchiveWriter::new();
    archive.integer(MARK, VERSION)?;
    archive.f64("frame_rate", &[], &[motion.frame_rate().per_second()])?;
    archive.f32("rotations", &[frames, Joint::COUNT, 4], &rotations)?;
    archive.f32("root_translation", &[frames, 3], &translations)?;
    archive.f32("rest_pelvis", &[3], &recording.rest_pelvis.to_array())?;
    archive.text("joints", &joint_names())?;
    archive.text("name", &recording.name)?;
    for (key, text) in [
        ("source", &recording.source),
        ("licence", &recording.licence),
    ] {
        if let Some(text) = text {
            archive.text(key, text)?;
        }
    }
    if !recording.notes.is_empty() {
        archive.text("notes", &recording.notes.join("\n"))?;
    }
    if let Some(shape) = motion.shape() {
        for (name, space) in SPACES {
            if space == shape.space {
                archive.text("shape_space", name)?;
            }
        }
        archive.f32("betas", &[shape.betas.len()], &shape.betas)?;
        if let Some(gender) = &shape.gender {
            archive.text("gender", gender)?;
        }
    }
    archive.finish()
}

/// Reads a file of our own format.
///
/// # Errors
/// [`Error::Io`], and those of [`from_archive`].
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Recording, Error> {
    let path = path.as_ref();
    let mut archive = open_archive(read_file(path, options.limits.bytes)?, path, options)?;
    from_archive(&mut archive, path, options)
}

/// Reads an opened archive; `path` only names it in errors.
///
/// # Errors
/// [`Error::Array`] for broken or missing arrays; [`Error::Format`] for another version, for
/// arrays that disagree and for numbers that are not finite; [`Error::Limit`] for too many frames.
pub fn from_archive(
    archive: &mut Archive,
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<Recording, Error> {
    from_fields(&mut Fields::of_archive(archive, path.as_ref(), options))
}

/// Reads a dictionary of the format's arrays.
pub(crate) fn from_fields(fields: &mut Fields<'_>) -> Result<Recording, Error> {
    Reader { fields }.read()
}

struct Reader<'a, 'b> {
    fields: &'b mut Fields<'a>,
}

impl Reader<'_, '_> {
    fn read(mut self) -> Result<Recording, Error> {
        let version = self.fields.number(MARK)?;
        if version != VERSION as f64 {
            let expected = format!("version {VERSION}");
            return Err(self.fields.format(MARK, &expected, &version.to_string()));
        }
        let names = self.fields.text("joints")?;
        if names != joint_names() {
            return Err(self.fields.format("joints", &joint_names(), &names));
        }
        let frame_rate = match self.fields.options.frame_rate {
            Some(given) => given,
            None => FrameRate::new(self.fields.number("frame_rate")?)?,
        };

        let (rotations, shape) = self.fields.numbers("rotations")?;
        let frames = match *shape.as_slice() {
            [frames, Joint::COUNT, 4] if frames > 0 => frames,
            _ => {
                let found = format!("{shape:?}");
                let expected = "[frames][22][4], frames above 0";
                return Err(self.fields.format("rotations", expected, &found));
            }
        };
        self.fields.check_frames(frames)?;
        let (translations, shape) = self.fields.numbers("root_translation")?;
        if shape != [frames, 3] {
            let (expected, found) = (format!("[{frames}][3]"), format!("{shape:?}"));
            return Err(self.fields.format("root_translation", &expected, &found));
        }
        let (rest_pelvis, _) = self.fields.numbers("rest_pelvis")?;
        let rest_pelvis = match *rest_pelvis.as_slice() {
            [x, y, z] if Vec3::new(x, y, z).is_finite() => Vec3::new(x, y, z),
            _ => {
                let found = format!("{rest_pelvis:?}");
                return Err(self
                    .fields
                    .format("rest_pelvis", "3 finite numbers", &found));
            }
        };
        let shape = self.shape()?;
        let rotations = rotations.as_chunks::<4>().0.iter().copied();
        let translations = translations.as_chunks::<3>().0.iter().copied();
        let motion = Motion::new(
            frame_rate,
            shape,
            translations.map(Vec3::from_array).collect(),
            rotations.map(Quat::from_array).collect(),
        )
        .map_err(|error| {
            let found = error.to_string();
            self.fields
                .format_at("the motion", "finite rotations", &found)
        })?;

        let name = self.optional_text("name")?;
        let notes = self.optional_text("notes")?.unwrap_or_default();
        Ok(Recording {
            motion,
            name: name.unwrap_or_else(|| stem(self.fields.path)),
            rest_pelvis,
            source: self.optional_text("source")?,
            licence: self.optional_text("licence")?,
            notes: notes.lines().map(str::to_owned).collect(),
        })
    }

    fn shape(&mut self) -> Result<Option<MotionShape>, Error> {
        let Some(name) = self.optional_text("shape_space")? else {
            return Ok(None);
        };
        let Some((_, space)) = SPACES.into_iter().find(|(known, _)| *known == name) else {
            let expected = "`open`, `smpl` or `smplx`";
            return Err(self.fields.format("shape_space", expected, &name));
        };
        let (betas, _) = self.fields.numbers("betas")?;
        if let Some(beta) = betas.iter().find(|beta| !beta.is_finite()) {
            let found = beta.to_string();
            return Err(self.fields.format("betas", "finite numbers", &found));
        }
        Ok(Some(MotionShape {
            space,
            gender: self.optional_text("gender")?,
            betas,
        }))
    }

    fn optional_text(&mut self, key: &str) -> Result<Option<String>, Error> {
        if !self.fields.contains(key) {
            return Ok(None);
        }
        self.fields.text(key).map(Some)
    }
}

fn joint_names() -> String {
    Joint::ALL.map(Joint::name).join(" ")
}
