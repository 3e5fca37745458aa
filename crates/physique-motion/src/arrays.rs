//! Motions in NumPy arrays, Python pickles and PyTorch files: one array, or a dictionary of them.
//!
//! What a file holds is told by the shapes of its arrays and the keys of its dictionaries.
//!
//! | file | content |
//! |---|---|
//! | `[frames][263]`, `[frames][251]` | features of HumanML3D and KIT-ML, see [`crate::features`] |
//! | `[frames][22][3]`, `[frames][21][3]` | joint positions of HumanML3D and KIT-ML |
//! | either with motions first, or motions first and frames last | many of them |
//! | `motion` with `lengths` or `text` | MDM's `results.npy` |
//! | `poses`, or `root_orient` and `pose_body` | [`crate::amass`] |
//! | `physique_motion` | [`crate::native`] |

mod joints;
mod mdm;

use std::path::Path;

use physique_files::pickle::PickleLimits;
use physique_files::{Data, Error as DataError};

use crate::npz::ArrayLimits;
use crate::read::{Part, open_archive};
use crate::{Error, ReadOptions, SourceMotion, amass, native};

/// What the readers of this module share: the file's name for errors, and the options.
#[derive(Clone, Copy)]
struct Context<'a> {
    path: &'a Path,
    options: &'a ReadOptions,
}

impl Context<'_> {
    fn format(&self, place: impl Into<String>, expected: &str, found: impl Into<String>) -> Error {
        Error::Format {
            path: self.path.into(),
            place: place.into(),
            expected: expected.into(),
            found: found.into(),
        }
    }

    fn unknown(&self, looks_like: String) -> Error {
        Error::UnknownFormat {
            path: self.path.into(),
            looks_like,
        }
    }

    fn check_frames(&self, frames: usize) -> Result<(), Error> {
        if frames > self.options.limits.frames {
            return Err(Error::Limit {
                path: self.path.into(),
                what: "the number of frames",
                found: frames as u64,
                limit: self.options.limits.frames as u64,
            });
        }
        Ok(())
    }
}

/// Motions of an `.npz`.
pub(crate) fn from_npz(
    bytes: Vec<u8>,
    path: &Path,
    options: &ReadOptions,
) -> Result<Vec<Part>, Error> {
    let context = Context { path, options };
    let mut archive = open_archive(bytes, path, options)?;
    if archive.contains(native::MARK) {
        let recording = native::from_archive(&mut archive, path, options)?;
        let motion = SourceMotion::Body(recording);
        return Ok(vec![Part::only("Physique motion", motion)]);
    }
    if archive.contains("poses") || archive.contains("pose_body") {
        let recording = amass::from_archive(&mut archive, path, options)?;
        return Ok(vec![Part::only("AMASS", SourceMotion::Body(recording))]);
    }
    let keys = archive.keys();
    let shown = keys[..keys.len().min(12)].join(", ");
    Err(context.unknown(format!("an archive of the arrays [{shown}]")))
}

/// Motions of a `.npy`, a pickle or a PyTorch file.
pub(crate) fn from_bytes(
    bytes: Vec<u8>,
    path: &Path,
    options: &ReadOptions,
) -> Result<Vec<Part>, Error> {
    let context = Context { path, options };
    let bytes_limit = options.limits.bytes;
    let arrays = ArrayLimits {
        bytes: bytes_limit,
        ..ArrayLimits::default()
    };
    let pickles = PickleLimits {
        bytes: bytes_limit,
        ..PickleLimits::default()
    };
    let data = Data::read(bytes, &arrays, &pickles).map_err(|error| match error {
        DataError::Array(source) => Error::Array {
            path: path.into(),
            source,
        },
        source => Error::Data {
            path: path.into(),
            source,
        },
    })?;
    match &data {
        Data::Array(array) => joints::read(&context, array),
        Data::Dict(_) if mdm::holds(&data) => mdm::read(&context, &data),
        Data::Dict(entries) => {
            let keys = entries.iter().take(12);
            let keys: Vec<_> = keys
                .map(|(key, value)| format!("`{}`: {}", key.escape_debug(), value.kind()))
                .collect();
            Err(context.unknown(format!("a dictionary of {}", keys.join(", "))))
        }
        other => Err(context.unknown(other.kind())),
    }
}
