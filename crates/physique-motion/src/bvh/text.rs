//! Words and lines of the file, with their places.

use std::path::Path;

use crate::Error;

/// A reader of words that knows its line.
pub(super) struct Text<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl<'a> Text<'a> {
    pub(super) fn new(path: &'a Path, bytes: &'a [u8]) -> Self {
        // A byte order mark is no part of the first word.
        let at = if bytes.starts_with(b"\xef\xbb\xbf") {
            3
        } else {
            0
        };
        Self {
            path,
            bytes,
            at,
            line: 1,
        }
    }

    /// Number of the line that is being read, from 1.
    pub(super) const fn line(&self) -> usize {
        self.line
    }

    pub(super) const fn path(&self) -> &'a Path {
        self.path
    }

    /// Bytes not yet read.
    pub(super) const fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The next word; braces are words of their own. `None` at the end of the file.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        self.skip_blank();
        let rest = &self.bytes[self.at..];
        let length = match rest.first()? {
            b'{' | b'}' => 1,
            _ => rest
                .iter()
                .position(|&byte| byte.is_ascii_whitespace() || matches!(byte, b'{' | b'}'))
                .unwrap_or(rest.len()),
        };
        self.at += length;
        Some(&rest[..length])
    }

    /// The rest of the line up to a brace or comment, without blanks around: a name.
    pub(super) fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let length = (0..rest.len())
            .find(|&index| {
                let starts_word = index == 0 || rest[index - 1].is_ascii_whitespace();
                matches!(rest[index], b'\n' | b'{' | b'}')
                    || (starts_word && is_comment(&rest[index..]))
            })
            .unwrap_or(rest.len());
        self.at += length;
        rest[..length].trim_ascii()
    }

    /// The next line that holds anything but blanks and comments, and its number.
    pub(super) fn data_line(&mut self) -> Option<(usize, &'a [u8])> {
        while self.at < self.bytes.len() {
            let rest = &self.bytes[self.at..];
            let length = rest
                .iter()
                .position(|&byte| byte == b'\n')
                .unwrap_or(rest.len());
            let line = self.line;
            self.at = (self.at + length + 1).min(self.bytes.len());
            self.line += 1;
            let content = rest[..length].trim_ascii();
            if !content.is_empty() && !is_comment(content) {
                return Some((line, content));
            }
        }
        None
    }

    /// The next word, which must be `keyword` in any case.
    pub(super) fn expect(&mut self, keyword: &str) -> Result<(), Error> {
        match self.word() {
            Some(word) if word.eq_ignore_ascii_case(keyword.as_bytes()) => Ok(()),
            found => Err(self.error(keyword, found)),
        }
    }

    /// The next word as a finite number.
    pub(super) fn number(&mut self, expected: &str) -> Result<f64, Error> {
        let word = self.word();
        let number = word.and_then(|word| std::str::from_utf8(word).ok()?.parse().ok());
        match number {
            Some(number) if f64::is_finite(number) => Ok(number),
            _ => Err(self.error(expected, word)),
        }
    }

    /// The next word as a count.
    pub(super) fn count(&mut self, expected: &str) -> Result<u64, Error> {
        let word = self.word();
        word.and_then(|word| std::str::from_utf8(word).ok()?.parse().ok())
            .ok_or_else(|| self.error(expected, word))
    }

    /// An error at the line being read.
    pub(super) fn error(&self, expected: &str, found: Option<&[u8]>) -> Error {
        format_error(self.path, format!("line {}", self.line), expected, found)
    }

    fn skip_blank(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            if byte == b'\n' {
                self.line += 1;
                self.at += 1;
            } else if byte.is_ascii_whitespace() {
                self.at += 1;
            } else if is_comment(&self.bytes[self.at..]) {
                let rest = &self.bytes[self.at..];
                let end = rest.iter().position(|&byte| byte == b'\n');
                self.at += end.unwrap_or(rest.len());
            } else {
                break;
            }
        }
    }
}

/// Whether a word starts a comment that runs to the end of its line.
pub(super) fn is_comment(text: &[u8]) -> bool {
    text.starts_with(b"#") || text.starts_with(b"//")
}

/// A format error that quotes at most a short piece of the file.
pub(super) fn format_error(
    path: &Path,
    place: String,
    expected: &str,
    found: Option<&[u8]>,
) -> Error {
    const QUOTED: usize = 40;
    Error::Format {
        path: path.into(),
        place,
        expected: expected.into(),
        found: found.map_or_else(
            || "the end of the file".into(),
            |word| {
                let quoted = String::from_utf8_lossy(&word[..word.len().min(QUOTED)]);
                format!("\"{}\"", quoted.escape_debug())
            },
        ),
    }
}
