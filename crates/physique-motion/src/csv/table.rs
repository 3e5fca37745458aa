//! Numbers in lines: what both kinds of file share.

use std::path::Path;

use crate::{Error, FrameRate, ReadOptions};

/// Lines of numbers with their rate.
pub(super) struct Table {
    pub(super) frame_rate: FrameRate,
    pub(super) frames: usize,
    /// `[frames][columns]`, without the times.
    pub(super) values: Vec<f32>,
}

/// Reads the lines below the header: a time and `columns` numbers each, evenly spaced in time.
pub(super) fn parse(
    bytes: &[u8],
    path: &Path,
    columns: usize,
    options: &ReadOptions,
) -> Result<Table, Error> {
    let format = |place: String, expected: &str, found: String| Error::Format {
        path: path.into(),
        place,
        expected: expected.into(),
        found,
    };
    let text = str::from_utf8(bytes)
        .map_err(|error| format("the text".into(), "UTF-8", error.to_string()))?;
    let lines = text.lines().enumerate().skip(1);
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for (number, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        if times.len() == options.limits.frames {
            return Err(Error::Limit {
                path: path.into(),
                what: "the number of frames",
                found: times.len() as u64 + 1,
                limit: options.limits.frames as u64,
            });
        }
        let place = || format!("line {}", number + 1);
        let before = values.len();
        let mut fields = line.split(',');
        let time = fields.next().unwrap_or_default();
        times.push(
            finite::<f64>(time).ok_or_else(|| {
                format(place(), "a time in seconds", format!("`{}`", shown(time)))
            })?,
        );
        for field in fields {
            values.push(finite::<f32>(field).ok_or_else(|| {
                format(place(), "a finite number", format!("`{}`", shown(field)))
            })?);
        }
        if values.len() - before != columns {
            let found = format!("{}", values.len() - before + 1);
            return Err(format(place(), &format!("{} numbers", columns + 1), found));
        }
    }
    let frame_rate = match options.frame_rate {
        Some(rate) => rate,
        None => rate(&times).map_err(|(expected, found)| format(TIMES.into(), expected, found))?,
    };
    Ok(Table {
        frame_rate,
        frames: times.len(),
        values,
    })
}

const TIMES: &str = "the times";

/// A finite number of any width.
fn finite<T: std::str::FromStr + Into<f64> + Copy>(field: &str) -> Option<T> {
    let number: T = field.trim().parse().ok()?;
    number.into().is_finite().then_some(number)
}

/// The start of a field, for an error.
fn shown(field: &str) -> String {
    field.chars().take(24).collect()
}

/// The rate of evenly spaced times, or what was expected and found.
fn rate(times: &[f64]) -> Result<FrameRate, (&'static str, String)> {
    /// How far a time may be from its even place, in frames.
    const UNEVEN: f64 = 0.01;
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return Err(("at least one frame", "none".into()));
    };
    if times.len() < 2 {
        let found = "one time, which states no rate: give the frame rate";
        return Err(("two frames", found.into()));
    }
    let step = (last - first) / (times.len() - 1) as f64;
    for (frame, time) in times.iter().enumerate() {
        let even = first + frame as f64 * step;
        if step <= 0.0 || (time - even).abs() > UNEVEN * step {
            let found = format!("{time} s in frame {frame} instead of {even:.6} s");
            return Err(("even steps forward", found));
        }
    }
    // Times are rounded to nanoseconds; the rate is a rounder number.
    let rounded = (1e4 / step).round() / 1e4;
    let per_second = if (rounded * step - 1.0).abs() < 1e-6 {
        rounded
    } else {
        1.0 / step
    };
    FrameRate::new(per_second).map_err(|error| ("a frame rate", error.to_string()))
}

/// A time, to the nanosecond.
pub(super) fn time(frame: usize, frame_rate: FrameRate) -> String {
    format!("{:.9}", frame as f64 / frame_rate.per_second())
}
