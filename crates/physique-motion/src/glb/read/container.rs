//! The GLB container around a document and its binary chunk; a bare document has none.

use super::Context;
use crate::Error;

pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    /// The first buffer of a `.glb`.
    pub(super) binary: Option<&'a [u8]>,
}

impl<'a> Container<'a> {
    /// A `.glb` by its mark, otherwise the text of a `.gltf`.
    pub(super) fn open(bytes: &'a [u8], context: &Context<'_>) -> Result<Self, Error> {
        if !bytes.starts_with(b"glTF") {
            let json = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
            return Ok(Self { json, binary: None });
        }
        let word = |at: usize| {
            let word = bytes.get(at..)?.first_chunk::<4>()?;
            usize::try_from(u32::from_le_bytes(*word)).ok()
        };
        if word(4) != Some(2) {
            let found = word(4).map_or("the end of the file".into(), |found| found.to_string());
            return Err(context.format("the header", "version 2 of glTF", found));
        }
        let whole = word(8).and_then(|length| bytes.get(..length));
        let Some(whole) = whole else {
            let expected = match word(8) {
                Some(length) => format!("{length} bytes"),
                None => "12 bytes".into(),
            };
            return Err(context.format("the header", expected, bytes.len().to_string()));
        };
        let chunk = |at: usize, kind: &[u8; 4]| {
            let start = at.checked_add(8)?;
            let end = start.checked_add(word(at)?)?;
            (whole.get(at.checked_add(4)?..start)? == kind)
                .then(|| whole.get(start..end))
                .flatten()
        };
        let json = chunk(12, b"JSON").ok_or_else(|| {
            context.format("the first chunk", "a whole JSON chunk", "something else")
        })?;
        // Chunks start at multiples of four; what other kinds hold is not ours.
        let binary = chunk((20 + json.len()).next_multiple_of(4), b"BIN\0");
        Ok(Self { json, binary })
    }
}
