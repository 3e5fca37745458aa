//! One door for every format: [`read_motions`] looks at what a file holds, not at its name.

use std::path::{Path, PathBuf};

use glam::Vec3;

use crate::bvh::{self, BvhOptions, LengthUnit, PositionChannels};
use crate::content::Content;
use crate::features::FeatureStatistics;
use crate::npz::{Archive, ArrayLimits};
use crate::read_file::read_file;
use crate::{
    Error, FrameRate, Limits, PositionClip, Recording, SkeletonClip, UpAxis, acclaim, arrays, csv,
    deep_mimic, glb,
};

/// What to take for granted where a file is silent or wrong.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// How much a file may ask for.
    pub limits: Limits,
    /// Taken instead of what the file says; needed for files that state no frame rate.
    pub frame_rate: Option<FrameRate>,
    /// The file's up axis; otherwise inferred for BVH and AMC, and Z for AMASS by its definition.
    pub up_axis: Option<UpAxis>,
    /// The length unit of a BVH or ASF file; otherwise inferred.
    pub unit: Option<LengthUnit>,
    /// What a BVH file's position channels do to a joint's offset; otherwise inferred.
    pub position_channels: Option<PositionChannels>,
    /// Rest pelvis of the body that an AMASS file was recorded for, in metres and in the axes of
    /// that body's file; otherwise a mean body's. See [`crate::amass`].
    pub rest_pelvis: Option<Vec3>,
    /// Mean and deviation of the data set, for features that a file holds normalised.
    pub statistics: Option<FeatureStatistics>,
    /// The `.asf` of an `.amc`; otherwise looked for beside it, see
    /// [`crate::acclaim::find_skeleton`].
    pub skeleton: Option<PathBuf>,
}

/// What a motion file holds.
#[derive(Clone, Debug, PartialEq)]
pub enum SourceMotion {
    /// An animation of some skeleton, which [`crate::mapping`] brings to the body.
    Skeleton(SkeletonClip),
    /// A motion of the body's own 22 joints.
    Body(Recording),
    /// Joint positions, from which [`crate::inverse_kinematics`] finds rotations.
    Positions(PositionClip),
}

/// A motion of a file that may hold several.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMotion {
    /// The file's name; with `#` and its number from 0, or its key, where the file holds several:
    /// `results.npy#3`.
    pub name: String,
    /// What the motion shows, where the file says: the prompt of a generator.
    pub text: Option<String>,
    /// What kind of file it comes from, in words: `BVH`, `HumanML3D features`.
    pub format: &'static str,
    /// The motion.
    pub motion: SourceMotion,
}

/// A motion as the readers of files of many hand it over.
#[derive(Debug)]
pub(crate) struct Part {
    /// What tells it from its neighbours in the file.
    pub(crate) key: String,
    pub(crate) text: Option<String>,
    pub(crate) format: &'static str,
    /// A broken motion does not keep others of its file from being read.
    pub(crate) motion: Result<SourceMotion, Error>,
}

impl Part {
    /// The only motion of a file.
    pub(crate) const fn only(format: &'static str, motion: SourceMotion) -> Self {
        Self {
            key: String::new(),
            text: None,
            format,
            motion: Ok(motion),
        }
    }
}

/// Reads all motions of a file of any known format; see the table of formats in [`crate::arrays`]
/// and the modules of this crate.
///
/// One of many can be named as [`NamedMotion::name`] does: `results.npy#3`, where no file of this
/// very name exists.
///
/// # Errors
/// [`Error::Io`]; [`Error::UnknownFormat`] with what the file looks like; [`Error::NoSuchMotion`];
/// else the errors of the format's own reader, for the first motion that is broken.
pub fn read_motions(
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<Vec<NamedMotion>, Error> {
    read_each(path, options)?
        .into_iter()
        .map(|(_, motion)| motion)
        .collect()
}

/// As [`read_motions`], but hands each motion over by its name with its own error, so that a
/// broken one does not hide the others.
///
/// # Errors
/// As [`read_motions`], for what concerns the whole file.
#[allow(clippy::type_complexity)] // A list of results with their names.
pub fn read_each(
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<Vec<(String, Result<NamedMotion, Error>)>, Error> {
    let path = path.as_ref();
    let (file, wanted) = one_of_many(path);
    let parts = parse_parts(read_file(&file, options.limits.bytes)?, &file, options)?;
    let mut motions = named(parts, &file);
    if wanted.is_some() {
        let name = file_name(path);
        let found = motions.len();
        motions.retain(|(known, _)| *known == name);
        if motions.is_empty() {
            return Err(Error::NoSuchMotion {
                path: file,
                name,
                found,
            });
        }
    }
    Ok(motions)
}

/// Reads a file that holds exactly one motion; see [`read_motions`].
///
/// # Errors
/// [`Error::ManyMotions`], and those of [`read_motions`].
pub fn read_motion(path: impl AsRef<Path>, options: &ReadOptions) -> Result<SourceMotion, Error> {
    let path = path.as_ref();
    only(read_motions(path, options)?, path)
}

/// Reads the bytes of a file of any known format; `path` names it in errors and motions, and files
/// that belong to it (the skeleton of an `.amc`, the buffers of a `.gltf`) are looked for beside it.
///
/// # Errors
/// As [`read_motions`], without [`Error::Io`].
pub fn parse_motions(
    bytes: Vec<u8>,
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<Vec<NamedMotion>, Error> {
    let path = path.as_ref();
    let motions = named(parse_parts(bytes, path, options)?, path);
    motions.into_iter().map(|(_, motion)| motion).collect()
}

/// Reads the bytes of a file that holds exactly one motion; see [`parse_motions`].
///
/// # Errors
/// As [`read_motion`], without [`Error::Io`].
pub fn parse_motion(
    bytes: Vec<u8>,
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<SourceMotion, Error> {
    let path = path.as_ref();
    only(parse_motions(bytes, path, options)?, path)
}

fn parse_parts(bytes: Vec<u8>, path: &Path, options: &ReadOptions) -> Result<Vec<Part>, Error> {
    let unpacked = physique_files::unpacked(bytes, options.limits.bytes);
    let bytes = unpacked.map_err(|problem| Error::Data {
        path: path.into(),
        problem,
    })?;
    match Content::of(&bytes) {
        Content::Npz => arrays::from_npz(bytes, path, options),
        Content::Arrays => arrays::from_bytes(bytes, path, options),
        Content::Bvh => {
            let bvh_options = BvhOptions {
                limits: options.limits,
                unit: options.unit,
                up_axis: options.up_axis,
                position_channels: options.position_channels,
                frame_rate: options.frame_rate,
            };
            let clip = bvh::parse(&bytes, path, &bvh_options)?;
            Ok(vec![Part::only("BVH", SourceMotion::Skeleton(clip))])
        }
        Content::AcclaimMotion => {
            let clip = acclaim::parse_beside(&bytes, path, options)?;
            Ok(vec![Part::only("ASF/AMC", SourceMotion::Skeleton(clip))])
        }
        Content::Gltf => glb::parts(&bytes, path, options),
        Content::DeepMimic => {
            let clip = deep_mimic::parse(&bytes, path, options)?;
            Ok(vec![Part::only("DeepMimic", SourceMotion::Skeleton(clip))])
        }
        Content::Csv(csv::Content::Positions) => {
            let positions = csv::parse_positions(&bytes, path, options)?;
            let notes = Vec::new();
            let clip = PositionClip { positions, notes };
            Ok(vec![Part::only(
                "CSV of positions",
                SourceMotion::Positions(clip),
            )])
        }
        Content::Csv(csv::Content::Rotations) => {
            let recording = csv::parse_rotations(&bytes, path, options)?;
            Ok(vec![Part::only(
                "CSV of rotations",
                SourceMotion::Body(recording),
            )])
        }
        Content::Other(looks_like) => Err(Error::UnknownFormat {
            path: path.into(),
            looks_like,
        }),
    }
}

/// Parts with their full names.
fn named(parts: Vec<Part>, path: &Path) -> Vec<(String, Result<NamedMotion, Error>)> {
    let file = file_name(path);
    let parts = parts.into_iter().map(|part| {
        let name = match part.key.as_str() {
            "" => file.clone(),
            key => format!("{file}#{key}"),
        };
        let motion = part.motion.map(|motion| NamedMotion {
            name: name.clone(),
            text: part.text,
            format: part.format,
            motion,
        });
        (name, motion)
    });
    parts.collect()
}

fn only(mut motions: Vec<NamedMotion>, path: &Path) -> Result<SourceMotion, Error> {
    match (motions.pop(), motions.len()) {
        (Some(only), 0) => Ok(only.motion),
        (last, others) => Err(Error::ManyMotions {
            path: path.into(),
            found: others + usize::from(last.is_some()),
        }),
    }
}

/// The file, and which of its motions, where `path` is no file but `FILE#KEY`.
fn one_of_many(path: &Path) -> (PathBuf, Option<String>) {
    let name = file_name(path);
    match name.rsplit_once('#') {
        Some((file, key)) if !file.is_empty() && !path.exists() => {
            (path.with_file_name(file), Some(key.to_owned()))
        }
        _ => (path.to_owned(), None),
    }
}

/// Opens the bytes of an archive within the limits; `path` names it in errors.
pub(crate) fn open_archive(
    bytes: Vec<u8>,
    path: &Path,
    options: &ReadOptions,
) -> Result<Archive, Error> {
    let limits = ArrayLimits {
        bytes: options.limits.bytes,
        ..ArrayLimits::default()
    };
    Archive::open(bytes, limits).map_err(|problem| Error::Array {
        path: path.into(),
        problem,
    })
}

/// Name of a file without folder and extension.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

/// Name of a file without folder.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
