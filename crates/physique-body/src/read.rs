//! One door for every body file, told apart by content.

use std::path::Path;

use physique_files::npz::{Archive, ArrayLimits};
use physique_files::pickle::{Pickle, PickleLimits};

use crate::smpl::{self, JointSet, Source};
use crate::{BodyModel, Error, compact};

/// How to read a body file.
#[derive(Clone, Copy, Debug)]
pub struct BodyOptions {
    /// Which joints to keep.
    pub joints: JointSet,
    /// Bytes of the file, and of what it unpacks to. SMPL-X takes 300 MB.
    pub bytes: u64,
}

impl Default for BodyOptions {
    fn default() -> Self {
        Self {
            joints: JointSet::default(),
            bytes: 1 << 30,
        }
    }
}

/// Reads a body: a compact file of ours, or SMPL, SMPL-H or SMPL-X as `.npz` or `.pkl`, whatever
/// its name ends in. See [`crate::smpl`] for the layouts.
///
/// # Errors
/// [`Error::File`] when it cannot be read or is too large, and as [`parse_body`].
pub fn read_body(path: &Path, options: &BodyOptions) -> Result<BodyModel, Error> {
    let bytes = physique_files::read_file(path, options.bytes)?;
    parse_body(&path.display().to_string(), bytes, options)
}

/// Reads a body from the bytes of its file; `name` is used in reports and errors.
///
/// # Errors
/// [`Error::Content`] for files that are broken or hold more than data, [`Error::Format`] for
/// arrays that are missing or of the wrong shape, [`Error::Model`] for arrays that do not fit
/// together.
pub fn parse_body(name: &str, bytes: Vec<u8>, options: &BodyOptions) -> Result<BodyModel, Error> {
    let content = |problem| Error::Content {
        file: name.into(),
        problem: Box::new(problem),
    };
    let pickles = PickleLimits {
        bytes: options.bytes,
        ..PickleLimits::default()
    };
    if Archive::looks_like(&bytes) {
        let arrays = ArrayLimits {
            bytes: options.bytes,
            ..ArrayLimits::default()
        };
        let archive = Archive::open(bytes, arrays).map_err(|error| content(error.into()))?;
        if archive.contains("template_quantised") {
            return compact::from_archive(name, archive);
        }
        return smpl::read(
            name,
            Source::Npz(Box::new(archive), pickles),
            options.joints,
        );
    }
    if Pickle::looks_like(&bytes) {
        let pickle = Pickle::read(bytes, &pickles).map_err(|error| content(error.into()))?;
        return smpl::read(name, Source::Pickle(pickle), options.joints);
    }
    Err(Error::Format {
        file: name.into(),
        place: "start".into(),
        expected: "a body: a .npz archive or a pickle".into(),
        found: format!("`{}`", bytes[..bytes.len().min(16)].escape_ascii()),
    })
}
