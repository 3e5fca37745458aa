//! Reading vocabularies.

use std::collections::HashMap;
use std::path::Path;

use serde_json::Value;

use crate::Error;

/// Numbers of word pieces.
pub(super) type Numbers = HashMap<String, u32>;

/// The text of a file.
pub(super) fn text<'a>(bytes: &'a [u8], path: &Path) -> Result<&'a str, Error> {
    std::str::from_utf8(bytes).map_err(|problem| {
        let place = format!("byte {}", problem.valid_up_to());
        wrong(path, place, "UTF-8", "other bytes".into())
    })
}

/// JSON of a file.
pub(super) fn json(bytes: &[u8], path: &Path) -> Result<Value, Error> {
    serde_json::from_slice(bytes).map_err(|problem| {
        let place = format!("line {}", problem.line());
        wrong(path, place, "JSON", problem.to_string())
    })
}

/// A JSON object of pieces and numbers.
pub(super) fn numbers(value: &Value, path: &Path) -> Result<Numbers, Error> {
    let fail = |place: &str, found: String| {
        wrong(
            path,
            place.to_owned(),
            "word pieces with their numbers",
            found,
        )
    };
    let pieces = value
        .as_object()
        .ok_or_else(|| fail("vocabulary", "none".into()))?;
    let pieces = pieces.iter().map(|(piece, number)| {
        let small = number
            .as_u64()
            .and_then(|number| u32::try_from(number).ok());
        let number = small.ok_or_else(|| fail(piece, number.to_string()))?;
        Ok((piece.clone(), number))
    });
    pieces.collect()
}

pub(super) fn wrong(path: &Path, place: String, expected: &str, found: String) -> Error {
    Error::Format {
        path: path.into(),
        place,
        expected: expected.into(),
        found,
    }
}
