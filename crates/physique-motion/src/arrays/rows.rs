//! Rows of numbers that hold rotations: 322, 272, 201 and 135 a frame, one layout each.
//!
//! | numbers | layout |
//! |---|---|
//! | 322 | Motion-X: root 3, body 63, hands 90, jaw 3 as axis-angle vectors, expression 50, face shape 100, translation 3, betas 10 |
//! | 272 | MotionStreamer: step of the root in x and z, turn of the heading 6, then 22 joints' positions, velocities and 6D rotations (by rows), the heading taken off |
//! | 201 | HY-Motion: translation 3, 22 6D rotations, 22 positions relative to the pelvis |
//! | 135 | translation 3 and 22 6D rotations, or rotations first |
//!
//! The last two do not say which six numbers of a matrix they hold: of the orders in which the
//! numbers make rotations, the one is taken in which knees bend as knees do.

mod motion_streamer;
mod six_numbers;

use glam::{DQuat, DVec3};
use physique_body::Joint;

use super::{Context, parameters};
use crate::fields::Fields;
use crate::npz::Array;
use crate::read::Part;
use crate::smpl_motion::{Path, SmplMotion, left_out, vectors_of};
use crate::{Error, MotionShape, ShapeSpace, SourceMotion};
use physique_files::Data;

/// Frames a second of all four data sets.
const RATE: f64 = 30.0;

/// Numbers of a row, by layout.
const MOTION_X: usize = 322;
const MOTION_STREAMER: usize = 272;
const HY_MOTION: usize = 201;
const SIX_NUMBERS: usize = 135;

/// What a row says, in the axes of the file.
struct Body {
    rotations: Vec<DQuat>,
    path: Path,
    betas: Vec<f32>,
    notes: Vec<String>,
}

/// Whether an array has the shape of one of the layouts.
pub(super) fn holds(array: &Array) -> bool {
    matches!(*array.shape(), [_, width] if is_width(width))
}

/// Whether rows of one of the layouts are so long.
pub(super) const fn is_width(numbers: usize) -> bool {
    matches!(
        numbers,
        MOTION_X | MOTION_STREAMER | HY_MOTION | SIX_NUMBERS
    )
}

/// Reads an array of one of the layouts.
pub(super) fn read(context: &Context<'_>, array: &Array) -> Result<Vec<Part>, Error> {
    let data = Data::Dict(vec![("array".into(), Data::Array(array.clone()))]);
    let mut fields = Fields::of_tree(&data, "", context.path, context.options);
    let known = [MOTION_X, MOTION_STREAMER, HY_MOTION, SIX_NUMBERS];
    let matrix = fields.matrix("array", &known)?;
    let rows: Vec<&[f64]> = matrix.values.chunks_exact(matrix.columns).collect();
    let (format, space, body) = match matrix.columns {
        MOTION_X => ("Motion-X", ShapeSpace::SmplX, motion_x(&rows)),
        MOTION_STREAMER => (
            "MotionStreamer features",
            ShapeSpace::Smpl,
            motion_streamer::read(&fields, &rows)?,
        ),
        HY_MOTION => (
            "HY-Motion features",
            ShapeSpace::Smpl,
            six_numbers::read(&fields, &rows)?,
        ),
        _ => (
            "SMPL rotations in six numbers",
            ShapeSpace::Smpl,
            six_numbers::read(&fields, &rows)?,
        ),
    };
    let mut notes = body.notes;
    let frame_rate = parameters::frame_rate(&mut fields, &[], Some((RATE, format)), &mut notes)?;
    let is_upright = matrix.columns == MOTION_STREAMER;
    let known = is_upright.then_some(crate::world::World::YUp);
    let world = parameters::world(&fields, known, &body.rotations, &mut notes);
    let motion = SmplMotion {
        frame_rate,
        world,
        shape: MotionShape {
            space,
            gender: None,
            betas: body.betas,
        },
        rotations: body.rotations,
        path: body.path,
        notes,
    };
    let motion = SourceMotion::Body(motion.into_recording(&fields)?);
    Ok(vec![Part::only(format, motion)])
}

fn motion_x(rows: &[&[f64]]) -> Body {
    let rotations = rows
        .iter()
        .flat_map(|row| vectors_of(&row[..3 * Joint::COUNT]).map(DQuat::from_scaled_axis));
    let translation = rows.iter().flat_map(|row| vectors_of(&row[309..312]));
    let betas = rows.first().map_or(&[][..], |row| &row[312..]);
    Body {
        rotations: rotations.collect(),
        path: Path::Translation(translation.collect()),
        betas: betas.iter().map(|&beta| beta as f32).collect(),
        notes: vec![left_out("hands and jaw")],
    }
}

/// The error that rotations are none.
fn no_rotation(fields: &Fields<'_>, frame: usize, joint: usize) -> Error {
    let name = Joint::ALL
        .get(joint)
        .map_or("heading", |joint| joint.name());
    let place = format!("frame {frame}, {name}");
    let expected = "six numbers of a rotation; features that were normalised must be multiplied by \
        their deviation and moved by their mean first";
    fields.format_at(
        &place,
        expected,
        "vectors that are not of unit length at right angles",
    )
}

/// A rotation of two unit vectors at right angles, nearly; `columns` or rows of its matrix.
fn rotation(first: DVec3, second: DVec3, are_rows: bool) -> Option<DQuat> {
    /// Generated features are rotations to some per cent only.
    const SLACK: f64 = 0.35;
    let is_near = (first.length() - 1.0).abs() < SLACK
        && (second.length() - 1.0).abs() < SLACK
        && first.dot(second).abs() < SLACK;
    let x = first.try_normalize()?;
    let z = x.cross(second).try_normalize()?;
    let turn = DQuat::from_mat3(&glam::DMat3::from_cols(x, z.cross(x), z)).normalize();
    is_near.then(|| if are_rows { turn.inverse() } else { turn })
}
