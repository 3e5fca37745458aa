//! The `MOTION` section: frame count, frame time, numbers.

use super::{
    hierarchy::{BvhJoint, LARGEST},
    text::{Text, format_error, is_comment},
};
use crate::frame_rate::customary_rate;
use crate::{Error, FrameRate, Limits};

/// The numbers of a file.
pub(super) struct BvhFrames {
    pub(super) frame_rate: FrameRate,
    pub(super) frame_count: usize,
    /// Numbers a frame.
    pub(super) columns: usize,
    /// `[frame_count][columns]`, in degrees and the file's unit.
    pub(super) values: Vec<f32>,
}

impl BvhFrames {
    pub(super) fn frame(&self, frame: usize) -> &[f32] {
        &self.values[frame * self.columns..(frame + 1) * self.columns]
    }
}

/// Reads what follows the word `MOTION`; `frame_rate` overrides the file's.
pub(super) fn parse(
    text: &mut Text<'_>,
    joints: &[BvhJoint],
    frame_rate: Option<FrameRate>,
    limits: &Limits,
) -> Result<BvhFrames, Error> {
    text.expect("Frames:")?;
    let declared = text.count("the number of frames")?;
    if declared > limits.frames as u64 {
        return Err(Error::Limit {
            path: text.path().into(),
            what: "the number of frames",
            found: declared,
            limit: limits.frames as u64,
        });
    }
    let frame_count = declared as usize;
    text.expect("Frame")?;
    text.expect("Time:")?;
    let seconds = text.number("the frame time in seconds")?;
    let frame_rate = match frame_rate {
        Some(frame_rate) => frame_rate,
        None => FrameRate::new(customary_rate(seconds)).map_err(|_| {
            let found = format!("{seconds:e}");
            text.error(
                "a frame time from a millionth to 1,000 seconds",
                Some(found.as_bytes()),
            )
        })?,
    };
    let columns = joints.iter().map(|joint| joint.channels.len()).sum();
    let values = numbers(text, joints, frame_count, columns)?;
    Ok(BvhFrames {
        frame_rate,
        frame_count,
        columns,
        values,
    })
}

fn numbers(
    text: &mut Text<'_>,
    joints: &[BvhJoint],
    frame_count: usize,
    columns: usize,
) -> Result<Vec<f32>, Error> {
    // A number takes two bytes at least: a header that promises more than the file holds
    // cannot make us allocate it.
    let promised = frame_count.saturating_mul(columns);
    let mut values = Vec::with_capacity(promised.min(text.remaining() / 2 + 1));
    let mut frame = 0;
    if columns == 0 {
        return Ok(values);
    }
    while let Some((line, content)) = text.data_line() {
        let place = |column| place(joints, line, frame, column);
        if frame == frame_count {
            let expected = format!("the end of the file after {frame_count} frames");
            return Err(format_error(
                text.path(),
                place(None),
                &expected,
                Some(content),
            ));
        }
        let start = values.len();
        let words = content
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty());
        for word in words.take_while(|word| !is_comment(word)) {
            let column = values.len() - start;
            if column == columns {
                let expected = format!("{columns} numbers, as the hierarchy has channels");
                return Err(format_error(
                    text.path(),
                    place(None),
                    &expected,
                    Some(word),
                ));
            }
            let number = std::str::from_utf8(word)
                .ok()
                .and_then(|word| word.parse().ok());
            match number {
                Some(number) if f32::abs(number) < LARGEST => values.push(number),
                _ => {
                    let place = place(Some(column));
                    return Err(format_error(
                        text.path(),
                        place,
                        "a finite number below 1e30",
                        Some(word),
                    ));
                }
            }
        }
        let found = values.len() - start;
        if found < columns {
            let expected = format!("{columns} numbers, as the hierarchy has channels");
            let found = found.to_string();
            return Err(format_error(
                text.path(),
                place(None),
                &expected,
                Some(found.as_bytes()),
            ));
        }
        frame += 1;
    }
    if frame < frame_count {
        let expected = format!("{frame_count} frames, as the header says");
        let found = frame.to_string();
        let place = format!("line {}", text.line());
        return Err(format_error(
            text.path(),
            place,
            &expected,
            Some(found.as_bytes()),
        ));
    }
    Ok(values)
}

fn place(joints: &[BvhJoint], line: usize, frame: usize, column: Option<usize>) -> String {
    let channel = column.and_then(|column| {
        let joint = joints.iter().find(|joint| {
            (joint.first_column..joint.first_column + joint.channels.len()).contains(&column)
        })?;
        let channel = joint.channels[column - joint.first_column];
        Some(format!(", joint {}, {}", joint.name, channel.keyword()))
    });
    format!("line {line}, frame {frame}{}", channel.unwrap_or_default())
}
