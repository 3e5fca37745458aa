//! MDM's `results.npy`: a dictionary of many motions with their texts and lengths.
//!
//! | key | content |
//! |---|---|
//! | `motion` | `[motions][22][3][frames]` joint positions, or features in any order of axes |
//! | `text` | the prompts, one a motion |
//! | `lengths` | frames of each motion; what follows is padding |
//! | `num_samples`, `num_repetitions` | motions are all samples of repetition 0, then of 1 |
//!
//! Written by the Motion Diffusion Model (Tevet et al., ICLR 2023) and by those built on it.

use glam::{DQuat, DVec3};
use physique_body::Joint;
use physique_files::Data;

use super::{Context, joints, parameters};
use crate::features::Rotation6d;
use crate::fields::Fields;
use crate::read::Part;
use crate::smpl_motion::{Path, SMPL_JOINTS, SmplMotion, left_out};
use crate::{Error, MotionShape, ShapeSpace, SourceMotion};

/// Whether a dictionary is one of MDM's.
pub(super) fn holds(data: &Data) -> bool {
    matches!(data.get("motion"), Some(Data::Array(_)))
        && ["lengths", "text", "num_samples"]
            .iter()
            .any(|key| data.get(key).is_some())
}

pub(super) fn read(context: &Context<'_>, data: &Data) -> Result<Vec<Part>, Error> {
    let Some(Data::Array(array)) = data.get("motion") else {
        return Err(context.format("`motion`", "an array", "none"));
    };
    let Some(axes) = joints::Axes::of(array.shape()) else {
        let expected = "[motions][22][3][frames], [motions][21][3][frames] or features";
        return Err(context.format("`motion`", expected, format!("{:?}", array.shape())));
    };
    let values = joints::numbers(context, array)?;
    let motions = axes.motions.unwrap_or(1);
    let lengths = lengths(context, data, motions, axes.frames)?;
    let texts = texts(data, motions);
    let parts = lengths.into_iter().zip(texts).enumerate();
    let parts = parts.map(|(index, (frames, text))| Part {
        key: axes.motions.map_or(String::new(), |_| index.to_string()),
        text,
        format: "MDM results",
        motion: joints::clip(context, &axes, &values, index, frames).map(SourceMotion::Positions),
    });
    Ok(parts.collect())
}

/// Frames of each motion; all of them where the file does not say.
fn lengths(
    context: &Context<'_>,
    data: &Data,
    motions: usize,
    frames: usize,
) -> Result<Vec<usize>, Error> {
    let Some(found) = data.get("lengths") else {
        return Ok(vec![frames; motions]);
    };
    let expected = format!("{motions} whole numbers from 1 to {frames}");
    let Some(numbers) = found.numbers() else {
        return Err(context.format("`lengths`", &expected, found.kind()));
    };
    if numbers.len() != motions {
        let found = format!("{} of them", numbers.len());
        return Err(context.format("`lengths`", &expected, found));
    }
    let lengths = numbers.iter().map(|&length| {
        if length >= 1.0 && length <= frames as f64 && length.fract() == 0.0 {
            Ok(length as usize)
        } else {
            Err(context.format("`lengths`", &expected, length.to_string()))
        }
    });
    lengths.collect()
}

/// The text of each motion. One text may stand for all.
fn texts(data: &Data, motions: usize) -> Vec<Option<String>> {
    let text = |index: usize| match data.get("text")? {
        Data::List(items) if items.len() == 1 => items[0].text(),
        Data::List(items) => items.get(index)?.text(),
        one => one.text(),
    };
    (0..motions)
        .map(|index| text(index).filter(|text| !text.is_empty()))
        .collect()
}

/// Whether a dictionary is MDM's `smpl_params.npy`.
pub(super) fn holds_rotations(data: &Data) -> bool {
    let is_array = |key| matches!(data.get(key), Some(Data::Array(_)));
    is_array("thetas") && is_array("root_translation")
}

/// MDM's `smpl_params.npy`: `thetas` `[24][6][frames]`, six numbers by rows, and
/// `root_translation` `[3][frames]`.
pub(super) fn read_rotations(fields: &mut Fields<'_>) -> Result<Vec<Part>, Error> {
    let mut notes = vec![left_out("hands")];
    let thetas = fields.array("thetas")?;
    let &[SMPL_JOINTS, 6, frames] = thetas.shape() else {
        let found = format!("{:?}", thetas.shape());
        return Err(fields.format("thetas", "[24][6][frames]", &found));
    };
    fields.check_frames(frames)?;
    let (values, _) = fields.numbers("thetas")?;
    let at =
        |joint: usize, number: usize, frame: usize| values[(joint * 6 + number) * frames + frame];
    let mut rotations = Vec::with_capacity(frames * Joint::COUNT);
    for frame in 0..frames {
        for joint in Joint::ALL {
            let numbers = [0, 1, 2, 3, 4, 5].map(|number| at(joint.index(), number, frame));
            let turn = Rotation6d::rows(numbers)
                .to_matrix()
                .ok_or(Error::NoRotation {
                    frame,
                    joint: joint.name(),
                });
            let turn = turn.map_err(|problem| fields.inside("`thetas`", problem))?;
            rotations.push(DQuat::from_mat3(&turn.as_dmat3()).normalize());
        }
    }
    let (trans, shape) = fields.numbers("root_translation")?;
    if shape != [3, frames] || frames == 0 {
        let (expected, found) = (
            format!("[3][{frames}], above no frames"),
            format!("{shape:?}"),
        );
        return Err(fields.format("root_translation", &expected, &found));
    }
    let places =
        (0..frames).map(|frame| [0, 1, 2].map(|axis| f64::from(trans[axis * frames + frame])));
    let usual = Some((20.0, "MDM"));
    let frame_rate = parameters::frame_rate(fields, &["fps"], usual, &mut notes)?;
    let motion = SmplMotion {
        frame_rate,
        world: parameters::world(fields, None, &rotations, &mut notes),
        shape: MotionShape {
            space: ShapeSpace::Smpl,
            gender: None,
            betas: Vec::new(),
        },
        rotations,
        path: Path::Translation(places.map(DVec3::from_array).collect()),
        notes,
    };
    let motion = SourceMotion::Body(motion.into_recording(fields)?);
    Ok(vec![Part {
        text: fields.optional_text("text")?.0,
        ..Part::only("MDM rotations", motion)
    }])
}
