//! Motions as comma-separated text, for spreadsheets, R and pandas: one header line, one line a
//! frame, Y up, metres.
//!
//! | file | columns |
//! |---|---|
//! | positions | `time_s`, then `pelvis_x_m`, `pelvis_y_m`, `pelvis_z_m` and so on for all 22 joints |
//! | rotations | `time_s`, the pelvis's `pelvis_x_m`, `pelvis_y_m`, `pelvis_z_m`, then `pelvis_qw`, `pelvis_qx`, `pelvis_qy`, `pelvis_qz` and so on: local rotations relative to the T-pose |
//!
//! Both are read back. Joints have SMPL's names and order. Positions have six digits after the
//! point (a micrometre), quaternions eight.

mod positions;
mod rotations;
mod table;

pub use positions::{format_positions, parse_positions};
pub use rotations::{format_rotations, parse_rotations};

use std::path::Path;

use glam::Vec3;
use physique_body::Joint;

use crate::features::JointPositions;
use crate::write_file::write_file;
use crate::{Error, Motion};

/// What a text of ours holds, by its header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Joint positions.
    Positions,
    /// Path of the pelvis and local rotations.
    Rotations,
}

impl Content {
    /// By the first line; `None` for any other text.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let line = bytes.split(|&byte| byte == b'\n').next()?;
        let line = str::from_utf8(line).ok()?.trim_end();
        if line == header(positions::columns()) {
            Some(Self::Positions)
        } else if line == header(rotations::columns()) {
            Some(Self::Rotations)
        } else {
            None
        }
    }
}

/// Writes positions, beside the file first, then renamed.
///
/// # Errors
/// [`Error::Io`], and those of [`format_positions`].
pub fn write_positions(path: impl AsRef<Path>, positions: &JointPositions) -> Result<(), Error> {
    write_file(path.as_ref(), format_positions(positions)?.as_bytes())
}

/// Writes the rotations of a motion, beside the file first, then renamed; see
/// [`format_rotations`].
///
/// # Errors
/// [`Error::Io`].
pub fn write_rotations(
    path: impl AsRef<Path>,
    motion: &Motion,
    rest_pelvis: Vec3,
) -> Result<(), Error> {
    write_file(
        path.as_ref(),
        format_rotations(motion, rest_pelvis).as_bytes(),
    )
}

/// The first line, without its end.
fn header(columns: impl Iterator<Item = String>) -> String {
    let columns: Vec<String> = [TIME.to_owned()].into_iter().chain(columns).collect();
    columns.join(",")
}

const TIME: &str = "time_s";

/// `pelvis_x_m` and its like.
fn place_columns(joint: Joint) -> impl Iterator<Item = String> {
    ["x", "y", "z"]
        .map(|axis| format!("{}_{axis}_m", joint.name()))
        .into_iter()
}
