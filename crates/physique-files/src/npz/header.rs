//! The header of a `.npy` file: magic, version, and a Python dictionary of three known keys.

use super::{ArrayError, ArrayLimits, ByteOrder, Element};

const MAGIC: &[u8] = b"\x93NUMPY";

/// NumPy itself refuses longer headers.
const LONGEST_HEADER: usize = 10_000;

/// What a header says.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) element: Element,
    pub(super) byte_order: ByteOrder,
    pub(super) fortran_order: bool,
    pub(super) shape: Vec<usize>,
    /// Product of the shape.
    pub(super) count: usize,
    /// Bytes of all elements.
    pub(super) data_bytes: usize,
    /// Where the data starts.
    pub(super) data_start: usize,
}

impl Header {
    /// Reads the header at the start of `bytes`.
    pub(super) fn parse(key: &str, bytes: &[u8], limits: &ArrayLimits) -> Result<Self, ArrayError> {
        let (text, data_start) = text(key, bytes)?;
        let mut cursor = Cursor {
            key,
            text,
            position: 0,
        };
        let (descr, fortran_order, shape) = cursor.dictionary(limits)?;
        let (element, byte_order) = match &descr {
            Descr::Plain(descr) => {
                Element::parse(descr).map_err(|reason| ArrayError::ElementType {
                    key: key.into(),
                    found: descr.clone(),
                    reason,
                })?
            }
            Descr::Record => {
                return Err(ArrayError::ElementType {
                    key: key.into(),
                    found: "a list of fields".into(),
                    reason: "records are not supported",
                });
            }
        };
        let impossible = || ArrayError::Shape {
            key: key.into(),
            shape: shape.clone(),
        };
        // An empty dimension must not hide the overflow of its neighbours.
        let product = |least: usize| {
            let mut lengths = shape.iter().map(|&length| length.max(least));
            lengths.try_fold(1_usize, usize::checked_mul)
        };
        let size = element.size().ok_or_else(impossible)?;
        product(1)
            .and_then(|count| count.checked_mul(size))
            .ok_or_else(impossible)?;
        let count = product(0).ok_or_else(impossible)?;
        let data_bytes = count * size;
        // Elements of no bytes (`<U0`) would make a huge array out of nothing.
        if count as u64 > limits.bytes {
            return Err(ArrayError::Bytes {
                key: key.into(),
                found: count as u64,
                limit: limits.bytes,
            });
        }
        Ok(Self {
            element,
            byte_order,
            fortran_order,
            shape,
            count,
            data_bytes,
            data_start,
        })
    }

    /// Where the pickle of an array of Python objects starts.
    ///
    /// The shape in the header is not used: the pickle states it again, with its items.
    pub(super) fn objects_start(key: &str, bytes: &[u8]) -> Result<usize, ArrayError> {
        let (text, data_start) = text(key, bytes)?;
        let mut cursor = Cursor {
            key,
            text,
            position: 0,
        };
        match cursor.dictionary(&ArrayLimits::default())?.0 {
            Descr::Plain(descr) if matches!(descr.as_str(), "|O" | "O" | "|O8" | "|O4") => {
                Ok(data_start)
            }
            Descr::Plain(found) => Err(ArrayError::ElementType {
                key: key.into(),
                found,
                reason: "an array of Python objects was asked for",
            }),
            Descr::Record => Err(ArrayError::ElementType {
                key: key.into(),
                found: "a list of fields".into(),
                reason: "records are not supported",
            }),
        }
    }
}

/// The dictionary, and where the data behind it starts.
fn text<'a>(key: &str, bytes: &'a [u8]) -> Result<(&'a [u8], usize), ArrayError> {
    let (start, length) = extent(key, bytes)?;
    let end = start + length;
    match bytes.get(start..end) {
        Some(text) => Ok((text, end)),
        None => Err(header_error(
            key,
            start,
            "the whole header",
            "the end of the file",
        )),
    }
}

/// Where the dictionary starts and how long it is.
fn extent(key: &str, bytes: &[u8]) -> Result<(usize, usize), ArrayError> {
    if !bytes.starts_with(MAGIC) {
        let start = bytes.get(..MAGIC.len()).unwrap_or(bytes);
        return Err(header_error(
            key,
            0,
            "the mark of a .npy file",
            &start.escape_ascii().to_string(),
        ));
    }
    let short = || {
        header_error(
            key,
            MAGIC.len(),
            "version and length",
            "the end of the file",
        )
    };
    let rest = &bytes[MAGIC.len()..];
    let (start, length) = match rest {
        [1, _, a, b, ..] => (10, usize::from(u16::from_le_bytes([*a, *b]))),
        [2 | 3, _, a, b, c, d, ..] => (12, u32::from_le_bytes([*a, *b, *c, *d]) as usize),
        [1..=3, ..] | [] => return Err(short()),
        [version, ..] => {
            return Err(header_error(
                key,
                MAGIC.len(),
                "version 1, 2 or 3",
                &version.to_string(),
            ));
        }
    };
    if length > LONGEST_HEADER {
        return Err(header_error(
            key,
            MAGIC.len() + 2,
            "a header below 10,000 bytes",
            &length.to_string(),
        ));
    }
    Ok((start, length))
}

fn header_error(key: &str, byte: usize, expected: &'static str, found: &str) -> ArrayError {
    ArrayError::Header {
        key: key.into(),
        byte,
        expected,
        found: found.into(),
    }
}

enum Descr {
    Plain(String),
    Record,
}

/// Reads the dictionary; it never recurses, so no nesting can exhaust the stack.
struct Cursor<'a> {
    key: &'a str,
    text: &'a [u8],
    position: usize,
}

impl Cursor<'_> {
    fn dictionary(
        &mut self,
        limits: &ArrayLimits,
    ) -> Result<(Descr, bool, Vec<usize>), ArrayError> {
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        self.expect(b'{', "`{`")?;
        while !self.take(b'}') {
            let name = self.string()?;
            self.expect(b':', "`:`")?;
            match name.as_str() {
                "descr" => descr = Some(self.descr()?),
                "fortran_order" => fortran_order = Some(self.boolean()?),
                "shape" => shape = Some(self.shape(limits)?),
                _ => return Err(self.error("`descr`, `fortran_order` or `shape`")),
            }
            if matches!(descr, Some(Descr::Record)) {
                break;
            }
            if !self.take(b',') {
                self.expect(b'}', "`,` or `}`")?;
                break;
            }
        }
        if matches!(descr, Some(Descr::Record)) {
            return Ok((Descr::Record, false, Vec::new()));
        }
        match (descr, fortran_order, shape) {
            (Some(descr), Some(fortran_order), Some(shape)) => Ok((descr, fortran_order, shape)),
            _ => Err(self.error("all of `descr`, `fortran_order` and `shape`")),
        }
    }

    fn descr(&mut self) -> Result<Descr, ArrayError> {
        if self.peek() == Some(b'[') {
            return Ok(Descr::Record);
        }
        self.string().map(Descr::Plain)
    }

    fn string(&mut self) -> Result<String, ArrayError> {
        let quote = match self.peek() {
            Some(quote @ (b'\'' | b'"')) => quote,
            _ => return Err(self.error("a quoted name")),
        };
        self.position += 1;
        let rest = &self.text[self.position..];
        let Some(length) = rest.iter().position(|&byte| byte == quote) else {
            return Err(self.error("a closing quote"));
        };
        self.position += length + 1;
        Ok(String::from_utf8_lossy(&rest[..length]).into_owned())
    }

    fn boolean(&mut self) -> Result<bool, ArrayError> {
        self.skip_space();
        for (word, value) in [("False", false), ("True", true)] {
            if self.text[self.position..].starts_with(word.as_bytes()) {
                self.position += word.len();
                return Ok(value);
            }
        }
        Err(self.error("`True` or `False`"))
    }

    fn shape(&mut self, limits: &ArrayLimits) -> Result<Vec<usize>, ArrayError> {
        let mut shape = Vec::new();
        self.expect(b'(', "`(`")?;
        while !self.take(b')') {
            if shape.len() >= limits.dimensions {
                return Err(self.error("fewer dimensions"));
            }
            shape.push(self.length()?);
            if !self.take(b',') {
                self.expect(b')', "`,` or `)`")?;
                break;
            }
        }
        Ok(shape)
    }

    fn length(&mut self) -> Result<usize, ArrayError> {
        self.skip_space();
        let digits = self.text[self.position..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        let text = str::from_utf8(&self.text[self.position..self.position + digits]);
        let length = text.ok().and_then(|text| text.parse().ok());
        let length = length.ok_or_else(|| self.error("a length that fits this machine"))?;
        self.position += digits;
        // Python 2 wrote long integers as `12L`.
        self.take(b'L');
        Ok(length)
    }

    fn skip_space(&mut self) {
        let rest = &self.text[self.position..];
        self.position += rest
            .iter()
            .take_while(|byte| byte.is_ascii_whitespace())
            .count();
    }

    fn peek(&mut self) -> Option<u8> {
        self.skip_space();
        self.text.get(self.position).copied()
    }

    fn take(&mut self, wanted: u8) -> bool {
        let found = self.peek() == Some(wanted);
        self.position += usize::from(found);
        found
    }

    fn expect(&mut self, wanted: u8, name: &'static str) -> Result<(), ArrayError> {
        if self.take(wanted) {
            Ok(())
        } else {
            Err(self.error(name))
        }
    }

    fn error(&self, expected: &'static str) -> ArrayError {
        let rest = &self.text[self.position..];
        let shown = &rest[..rest.len().min(24)];
        let found = if shown.is_empty() {
            "the end of the header".into()
        } else {
            format!("`{}`", shown.escape_ascii())
        };
        header_error(self.key, self.position, expected, &found)
    }
}
