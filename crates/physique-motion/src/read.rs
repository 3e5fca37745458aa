//! One door for every format: [`read_motion`] looks at what a file holds, not at its name.

use std::path::Path;

use glam::Vec3;

use crate::bvh::{self, BvhOptions, LengthUnit, PositionChannels};
use crate::npz::{Archive, ArrayLimits};
use crate::read_file::read_file;
use crate::{Error, FrameRate, Limits, Recording, SkeletonClip, UpAxis, amass, deep_mimic, native};

/// What to take for granted where a file is silent or wrong.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// How much a file may ask for.
    pub limits: Limits,
    /// Taken instead of what the file says; needed for files that state no frame rate.
    pub frame_rate: Option<FrameRate>,
    /// The file's up axis; otherwise inferred for BVH, and Z for AMASS by its definition.
    pub up_axis: Option<UpAxis>,
    /// A BVH file's length unit; otherwise inferred.
    pub unit: Option<LengthUnit>,
    /// What a BVH file's position channels do to a joint's offset; otherwise inferred.
    pub position_channels: Option<PositionChannels>,
    /// Rest pelvis of the body that an AMASS file was recorded for, in metres and in the axes of
    /// that body's file; otherwise a mean body's. See [`crate::amass`].
    pub rest_pelvis: Option<Vec3>,
}

/// What a motion file holds.
#[derive(Clone, Debug, PartialEq)]
pub enum SourceMotion {
    /// An animation of some skeleton, which [`crate::mapping`] brings to the body.
    Skeleton(SkeletonClip),
    /// A motion of the body's own 22 joints.
    Body(Recording),
}

/// Reads a motion file of any known format: BVH, AMASS, our own, or DeepMimic's.
///
/// # Errors
/// [`Error::Io`]; [`Error::UnknownFormat`] with what the file looks like; else the errors of the
/// format's own reader.
pub fn read_motion(path: impl AsRef<Path>, options: &ReadOptions) -> Result<SourceMotion, Error> {
    let path = path.as_ref();
    parse_motion(read_file(path, options.limits.bytes)?, path, options)
}

/// Reads the bytes of a motion file of any known format; `path` only names it in errors.
///
/// # Errors
/// As [`read_motion`], without [`Error::Io`].
pub fn parse_motion(
    bytes: Vec<u8>,
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<SourceMotion, Error> {
    let path = path.as_ref();
    let unknown = |looks_like: String| Error::UnknownFormat {
        path: path.into(),
        looks_like,
    };
    match Content::of(&bytes) {
        Content::Zip => {
            let mut archive = open_archive(bytes, path, options)?;
            if archive.contains(native::MARK) {
                native::from_archive(&mut archive, path, options).map(SourceMotion::Body)
            } else if ["poses", "pose_body"]
                .iter()
                .any(|key| archive.contains(key))
            {
                amass::from_archive(&mut archive, path, options).map(SourceMotion::Body)
            } else {
                let keys = archive.keys();
                let shown = keys[..keys.len().min(12)].join(", ");
                Err(unknown(format!("an archive of the arrays [{shown}]")))
            }
        }
        Content::Bvh => {
            let bvh_options = BvhOptions {
                limits: options.limits,
                unit: options.unit,
                up_axis: options.up_axis,
                position_channels: options.position_channels,
                frame_rate: options.frame_rate,
            };
            bvh::parse(&bytes, path, &bvh_options).map(SourceMotion::Skeleton)
        }
        Content::DeepMimic => deep_mimic::parse(&bytes, path, options).map(SourceMotion::Skeleton),
        Content::Other(looks_like) => Err(unknown(looks_like)),
    }
}

/// What the first bytes of a file tell.
enum Content {
    Zip,
    Bvh,
    DeepMimic,
    Other(String),
}

impl Content {
    fn of(bytes: &[u8]) -> Self {
        /// Marks of files that people have, but that are not read.
        const MARKS: [(&[u8], &str); 7] = [
            (
                b"\x93NUMPY",
                "a single NumPy array without names or a frame rate",
            ),
            (
                b"glTF",
                "a binary glTF model, which is written but not read",
            ),
            (b"Kaydara FBX", "Autodesk FBX; Blender converts it to BVH"),
            (
                b"\x80",
                "a Python pickle, which is not opened because it may run code",
            ),
            (b"\x1f\x8b", "a gzip file; unpack it first"),
            (b"\xfd7zXZ", "an xz file; unpack it first"),
            (b":version", "Acclaim ASF/AMC; convert it to BVH"),
        ];
        if Archive::looks_like(bytes) {
            return Self::Zip;
        }
        if bytes.is_empty() {
            return Self::Other("an empty file".into());
        }
        if let Some((_, name)) = MARKS.iter().find(|(mark, _)| bytes.starts_with(mark)) {
            return Self::Other((*name).into());
        }
        let text = after_comments(bytes);
        let starts_with = |word: &str| {
            let start = text.get(..word.len());
            start.is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()))
        };
        if starts_with("HIERARCHY") {
            return Self::Bvh;
        }
        if starts_with("{") {
            let mentions_frames = text.windows(8).any(|window| window == b"\"Frames\"");
            return if mentions_frames {
                Self::DeepMimic
            } else {
                Self::Other("JSON without `Frames`".into())
            };
        }
        let start = &text[..text.len().min(24)];
        Self::Other(format!(
            "a file that begins with `{}`",
            start.escape_ascii()
        ))
    }
}

/// Text behind a byte order mark, blank lines and the `#` and `//` comments that BVH allows.
fn after_comments(bytes: &[u8]) -> &[u8] {
    let mut text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    loop {
        text = text.trim_ascii_start();
        if !(text.starts_with(b"#") || text.starts_with(b"//")) {
            return text;
        }
        let line_end = text.iter().position(|&byte| byte == b'\n');
        text = &text[line_end.unwrap_or(text.len())..];
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
    Archive::open(bytes, limits).map_err(|source| Error::Array {
        path: path.into(),
        source,
    })
}

/// Name of a file without folder and extension.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}
