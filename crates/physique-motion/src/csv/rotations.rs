//! The pelvis's path and all local rotations as text.

use std::fmt::Write as _;
use std::path::Path;

use glam::{Quat, Vec3};
use physique_body::Joint;

use super::{header, place_columns, table};
use crate::read::stem;
use crate::{Error, Motion, ReadOptions, Recording};

/// Names of all columns behind the time.
pub(super) fn columns() -> impl Iterator<Item = String> {
    let quaternion = |joint: Joint| {
        ["w", "x", "y", "z"]
            .map(|part| format!("{}_q{part}", joint.name()))
            .into_iter()
    };
    place_columns(Joint::Pelvis).chain(Joint::ALL.into_iter().flat_map(quaternion))
}

/// A motion as text; see the [module](super). `rest_pelvis` is that of the body it drives, so that
/// the columns say where the pelvis is in the world.
pub fn format_rotations(motion: &Motion, rest_pelvis: Vec3) -> String {
    let mut text = header(columns()) + "\n";
    for frame in 0..motion.frame_count() {
        let Vec3 { x, y, z } = motion.root_translation()[frame] + rest_pelvis;
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "{},{x:.6},{y:.6},{z:.6}",
            table::time(frame, motion.frame_rate())
        );
        for rotation in motion.frame_rotations(frame) {
            let [x, y, z, w] = rotation.to_array();
            let _ = write!(text, ",{w:.8},{x:.8},{y:.8},{z:.8}");
        }
        text.push('\n');
    }
    text
}

/// Reads what [`format_rotations`] wrote; `path` only names it in errors.
///
/// The rest pelvis of the recording is the origin: the text says where the pelvis is, not whose.
///
/// # Errors
/// As [`super::parse_positions`], and [`Error::NotFinite`] for four numbers that are no rotation.
pub fn parse_rotations(
    bytes: &[u8],
    path: &Path,
    options: &ReadOptions,
) -> Result<Recording, Error> {
    let table = table::parse(bytes, path, 3 + 4 * Joint::COUNT, options)?;
    let mut root = Vec::with_capacity(table.frames);
    let mut rotations = Vec::with_capacity(table.frames * Joint::COUNT);
    for row in table.values.chunks_exact(3 + 4 * Joint::COUNT) {
        let (place, quaternions) = row.split_at(3);
        root.push(Vec3::from_slice(place));
        let quaternions = quaternions.as_chunks().0.iter();
        rotations.extend(quaternions.map(|&[w, x, y, z]| Quat::from_xyzw(x, y, z, w)));
    }
    Ok(Recording {
        motion: Motion::new(table.frame_rate, None, root, rotations)?,
        name: stem(path),
        rest_pelvis: Vec3::ZERO,
        source: None,
        licence: None,
        notes: Vec::new(),
    })
}
