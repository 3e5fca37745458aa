//! Lines and words of both files, with their places.

use std::path::Path;

use crate::Error;

/// A line that holds something.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    path: &'a Path,
    /// From 1.
    number: usize,
    /// Without comment and blanks around.
    pub(super) text: &'a [u8],
}

/// The lines of a text that hold anything but blanks and `#` comments.
pub(super) fn lines<'a>(path: &'a Path, text: &'a [u8]) -> impl Iterator<Item = Line<'a>> {
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let lines = text.split(|&byte| byte == b'\n').zip(1..);
    lines.filter_map(move |(line, number)| {
        let content = line.split(|&byte| byte == b'#').next().unwrap_or_default();
        let text = content.trim_ascii();
        (!text.is_empty()).then_some(Line { path, number, text })
    })
}

impl<'a> Line<'a> {
    /// Words between blanks, commas and parentheses.
    pub(super) fn words(&self) -> Words<'a> {
        Words {
            line: *self,
            rest: self.text,
        }
    }

    /// Whether the first word is `keyword`, in any case.
    pub(super) fn starts_with(&self, keyword: &str) -> bool {
        let first = self.words().next();
        first.is_some_and(|word| word.eq_ignore_ascii_case(keyword.as_bytes()))
    }

    /// An error in this line that quotes at most a short piece of it.
    pub(super) fn error(&self, expected: impl Into<String>, found: Option<&[u8]>) -> Error {
        const QUOTED: usize = 40;
        let found = match found {
            None => "the end of the line".into(),
            Some(word) => {
                let quoted = String::from_utf8_lossy(&word[..word.len().min(QUOTED)]);
                format!("\"{}\"", quoted.escape_debug())
            }
        };
        Error::Format {
            path: self.path.into(),
            place: format!("line {}", self.number),
            expected: expected.into(),
            found,
        }
    }
}

/// A name as it is looked up: letter case does not matter, nor what is no text.
pub(super) fn key(name: &[u8]) -> String {
    String::from_utf8_lossy(name).to_ascii_lowercase()
}

/// The words of a line.
pub(super) struct Words<'a> {
    line: Line<'a>,
    rest: &'a [u8],
}

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let between = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, b',' | b'(' | b')');
        let start = self.rest.iter().position(|byte| !between(byte))?;
        let word = &self.rest[start..];
        let length = word.iter().position(between).unwrap_or(word.len());
        self.rest = &word[length..];
        Some(&word[..length])
    }
}

impl Words<'_> {
    /// The next word as a number of ordinary size: what stays finite in 32 bits, however many
    /// bones add up.
    pub(super) fn number(&mut self, expected: &str) -> Result<f64, Error> {
        let word = self.next();
        let number = word.and_then(|word| std::str::from_utf8(word).ok()?.parse().ok());
        match number {
            Some(number) if f64::abs(number) < 1e30 => Ok(number),
            _ => Err(self.line.error(expected, word)),
        }
    }

    /// The next three words as numbers.
    pub(super) fn vector(&mut self, expected: &str) -> Result<[f64; 3], Error> {
        Ok([
            self.number(expected)?,
            self.number(expected)?,
            self.number(expected)?,
        ])
    }
}
