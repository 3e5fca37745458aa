//! The JSON of a motion file: rows of 44 finite numbers.

use std::path::Path;

use serde::Deserialize;

use crate::{Error, ReadOptions};

/// Numbers of a frame.
pub(super) const COLUMNS: usize = 44;

#[derive(Deserialize)]
struct MotionFile {
    #[serde(rename = "Frames")]
    frames: Vec<Vec<f64>>,
}

/// Reads and checks all frames.
pub(super) fn parse(
    text: &[u8],
    path: &Path,
    options: &ReadOptions,
) -> Result<Vec<[f64; COLUMNS]>, Error> {
    let error = |place: String, expected: &str, found: String| Error::Format {
        path: path.into(),
        place,
        expected: expected.into(),
        found,
    };
    // Every frame opens a bracket: the count bounds what parsing may allocate.
    let brackets = text.iter().filter(|&&byte| byte == b'[').count();
    let limit = options.limits.frames;
    if brackets > limit.saturating_add(64) {
        return Err(Error::Limit {
            path: path.into(),
            what: "the number of frames",
            found: brackets as u64,
            limit: limit as u64,
        });
    }
    let file: MotionFile = serde_json::from_slice(text).map_err(|problem| {
        let place = format!("line {}, column {}", problem.line(), problem.column());
        error(place, "DeepMimic's JSON with `Frames`", problem.to_string())
    })?;
    if file.frames.is_empty() {
        return Err(error(
            "`Frames`".into(),
            "at least one frame",
            "none".into(),
        ));
    }
    let rows = file.frames.into_iter().enumerate();
    let frames = rows.map(|(frame, row)| {
        let row: [f64; COLUMNS] = row.try_into().map_err(|row: Vec<f64>| {
            let found = format!("{} numbers", row.len());
            error(
                format!("frame {frame}"),
                "44 numbers, as of `humanoid3d`",
                found,
            )
        })?;
        if let Some(column) = row.iter().position(|value| !value.is_finite()) {
            let place = format!("frame {frame}, number {column}");
            return Err(error(place, "a finite number", row[column].to_string()));
        }
        if row[0] < 0.0 {
            let place = format!("frame {frame}, duration");
            return Err(error(place, "at least 0 seconds", row[0].to_string()));
        }
        Ok(row)
    });
    frames.collect()
}
