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

use physique_files::Data;

use super::{Context, joints};
use crate::Error;
use crate::read::Part;

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
    let motions = axes.motions.unwrap_or(1);
    let lengths = lengths(context, data, motions, axes.frames)?;
    let texts = texts(data, motions);
    let values = joints::numbers(context, array)?;
    let parts = lengths.into_iter().zip(texts).enumerate();
    let parts = parts.map(|(index, (frames, text))| Part {
        key: axes.motions.map_or(String::new(), |_| index.to_string()),
        text,
        format: "MDM results",
        motion: joints::clip(context, &axes, &values, index, frames),
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
