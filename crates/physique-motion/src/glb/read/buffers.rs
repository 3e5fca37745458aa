//! Binary data: the chunk of a `.glb`, base64 in the document, or files beside it.

use std::path::{Component, Path, PathBuf};

use base64::Engine as _;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::Context;
use super::document::{Buffer, Document, Uri};
use crate::Error;
use crate::read_file::read_file;

/// Buffers, loaded when they are first asked for: a mesh's textures are never opened.
pub(super) struct Buffers<'a> {
    declared: &'a [Buffer<'a>],
    binary: Option<&'a [u8]>,
    loaded: Vec<Option<Vec<u8>>>,
    /// Bytes of all that were loaded.
    total: u64,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(document: &'a Document<'a>, binary: Option<&'a [u8]>) -> Self {
        Self {
            declared: &document.buffers,
            binary,
            loaded: document.buffers.iter().map(|_| None).collect(),
            total: 0,
        }
    }

    /// The bytes of a buffer, as many as it declares.
    pub(super) fn get(&mut self, index: usize, context: &Context<'_>) -> Result<&[u8], Error> {
        let place = format!("buffer {index}");
        let Some(buffer) = self.declared.get(index) else {
            let found = format!("{} of them", self.declared.len());
            return Err(context.format(place, "a buffer of this number", found));
        };
        if let (Some(Uri(uri)), None) = (&buffer.uri, &self.loaded[index]) {
            let left = context.options.limits.bytes.saturating_sub(self.total);
            let bytes = load(uri, &place, left, context)?;
            self.total += bytes.len() as u64;
            self.loaded[index] = Some(bytes);
        }
        let bytes = match (&self.loaded[index], self.binary) {
            (Some(bytes), _) => bytes,
            (None, Some(binary)) if index == 0 => binary,
            _ => return Err(context.format(place, "data, or a uri that says where", "neither")),
        };
        bytes.get(..buffer.byte_length).ok_or_else(|| {
            let expected = format!("{} bytes", buffer.byte_length);
            context.format(place, expected, bytes.len().to_string())
        })
    }
}

fn load(uri: &str, place: &str, limit: u64, context: &Context<'_>) -> Result<Vec<u8>, Error> {
    let Some(data) = uri.strip_prefix("data:") else {
        return read_file(&beside(uri, place, context)?, limit);
    };
    let base64 = data
        .split_once(',')
        .filter(|(kind, _)| kind.ends_with(";base64"));
    let Some((_, base64)) = base64 else {
        return Err(context.format(place, "data in base64", "another encoding"));
    };
    context.check(
        "the size in bytes of its buffers",
        base64.len() as u64 / 4 * 3,
        limit,
    )?;
    let config =
        GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    let engine = GeneralPurpose::new(&base64::alphabet::STANDARD, config);
    engine
        .decode(base64)
        .map_err(|problem| context.format(place, "data in base64", problem.to_string()))
}

/// A file in the document's folder or below it. Links that lead elsewhere are refused, too.
fn beside(uri: &str, place: &str, context: &Context<'_>) -> Result<PathBuf, Error> {
    let escape = || {
        let quoted: String = uri.chars().take(60).collect();
        let found = format!("\"{}\"", quoted.escape_debug());
        context.format(place, "a file in the same folder or below it", found)
    };
    let name = percent_decoded(uri).ok_or_else(escape)?;
    let relative = Path::new(&name);
    let plain = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if name.is_empty() || name.contains(['\\', ':', '\0']) || !relative.components().all(plain) {
        return Err(escape());
    }
    let folder = match context.path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let file = folder.join(relative);
    let io = |problem| Error::Io {
        path: file.clone(),
        problem,
    };
    let real = file.canonicalize().map_err(io)?;
    if real.starts_with(folder.canonicalize().map_err(io)?) {
        Ok(file)
    } else {
        Err(escape())
    }
}

/// The text behind `%20` and the like.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let digits = rest.first_chunk::<2>()?;
        let digit = |digit: u8| char::from(digit).to_digit(16);
        bytes.push((digit(digits[0])? * 16 + digit(digits[1])?) as u8);
        rest = &rest[2..];
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::percent_decoded;

    #[test]
    fn percent_signs_stand_for_bytes() {
        assert_eq!(percent_decoded("a%20b.bin").as_deref(), Some("a b.bin"));
        assert_eq!(percent_decoded("%c3%A4").as_deref(), Some("ä"));
        for broken in ["%", "%2", "%zz", "%ff"] {
            assert_eq!(percent_decoded(broken), None, "{broken}");
        }
    }
}
