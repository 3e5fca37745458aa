//! Joint positions as text.

use std::fmt::Write as _;
use std::path::Path;

use glam::Vec3;
use physique_body::Joint;

use super::{header, place_columns, table};
use crate::features::{FeatureSkeleton, JointPositions};
use crate::{Error, ReadOptions};

/// Names of all columns behind the time.
pub(super) fn columns() -> impl Iterator<Item = String> {
    Joint::ALL.into_iter().flat_map(place_columns)
}

/// Positions as text; see the [module](super). KIT's are brought to the 22 joints first.
///
/// # Errors
/// [`Error::NotFinite`] when sums of KIT's overflow.
pub fn format_positions(positions: &JointPositions) -> Result<String, Error> {
    let positions = positions.to_smpl_joints()?;
    let mut text = header(columns()) + "\n";
    for (frame, joints) in positions.frames().enumerate() {
        text += &table::time(frame, positions.frame_rate());
        for Vec3 { x, y, z } in joints {
            // Writing to a string cannot fail.
            let _ = write!(text, ",{x:.6},{y:.6},{z:.6}");
        }
        text.push('\n');
    }
    Ok(text)
}

/// Reads what [`format_positions`] wrote; `path` only names it in errors.
///
/// The rate follows from the times, unless the options state it.
///
/// # Errors
/// [`Error::Format`] with the line for anything but finite numbers, even times and whole lines;
/// [`Error::Limit`]; [`Error::NoFrames`].
pub fn parse_positions(
    bytes: &[u8],
    path: &Path,
    options: &ReadOptions,
) -> Result<JointPositions, Error> {
    let table = table::parse(bytes, path, 3 * Joint::COUNT, options)?;
    let positions = table
        .values
        .as_chunks()
        .0
        .iter()
        .copied()
        .map(Vec3::from_array);
    JointPositions::new(
        table.frame_rate,
        FeatureSkeleton::HumanMl3d,
        positions.collect(),
    )
}
