//! Types of array elements: NumPy's type strings such as `<f4`, `>i8`, `|b1` and `<U6`.

/// Order of the bytes of one element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ByteOrder {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

/// What one element of an array is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Element {
    /// One byte, zero or not.
    Bool,
    /// A signed integer of 1, 2, 4 or 8 bytes.
    Int(u8),
    /// An unsigned integer of 1, 2, 4 or 8 bytes.
    Uint(u8),
    /// An IEEE 754 number of 2, 4 or 8 bytes.
    Float(u8),
    /// Text of so many UTF-32 code points, padded with zeros.
    Text(usize),
    /// Text of so many bytes, padded with zeros.
    Bytes(usize),
}

impl Element {
    /// Bytes of one element; `None` when that overflows.
    pub fn size(self) -> Option<usize> {
        match self {
            Self::Bool => Some(1),
            Self::Int(size) | Self::Uint(size) | Self::Float(size) => Some(size.into()),
            Self::Text(length) => length.checked_mul(4),
            Self::Bytes(length) => Some(length),
        }
    }

    /// Element and byte order of a type string; the error says why a type is refused.
    pub(crate) fn parse(descr: &str) -> Result<(Self, ByteOrder), &'static str> {
        let mut letters = descr.chars();
        let order = match letters.next() {
            Some('<' | '|') => ByteOrder::Little,
            Some('>') => ByteOrder::Big,
            _ => return Err("its byte order is not one of `<`, `>` and `|`"),
        };
        let Some(kind) = letters.next() else {
            return Err("it names no type");
        };
        if kind == 'O' {
            return Err("Python objects are pickled, and unpickling runs code from the file");
        }
        let digits = letters.as_str();
        let all_digits = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
        let Some(size) = digits.parse::<usize>().ok().filter(|_| all_digits) else {
            return Err("its size is no number");
        };
        let element = match (kind, size) {
            ('b', 1) => Self::Bool,
            ('i', 1 | 2 | 4 | 8) => Self::Int(size as u8),
            ('u', 1 | 2 | 4 | 8) => Self::Uint(size as u8),
            ('f', 2 | 4 | 8) => Self::Float(size as u8),
            ('U', _) => Self::Text(size),
            ('S', _) => Self::Bytes(size),
            _ => return Err("there is no reader for this type"),
        };
        Ok((element, order))
    }
}

#[cfg(test)]
mod tests {
    use super::{ByteOrder, Element};

    #[test]
    fn type_strings() {
        let read = Element::parse;
        assert_eq!(read("<f4"), Ok((Element::Float(4), ByteOrder::Little)));
        assert_eq!(read(">i8"), Ok((Element::Int(8), ByteOrder::Big)));
        assert_eq!(read("|b1"), Ok((Element::Bool, ByteOrder::Little)));
        assert_eq!(read("<U6"), Ok((Element::Text(6), ByteOrder::Little)));
        for refused in [
            "", "f4", "<", "<f", "<f3", "<f+4", "<f16", "<c8", "<M8[s]", "|V4", "<f٤",
        ] {
            assert!(read(refused).is_err(), "{refused}");
        }
        assert!(read("|O").is_err_and(|reason| reason.contains("pickled")));
    }

    #[test]
    fn a_text_whose_size_overflows_has_none() {
        assert_eq!(Element::Text(usize::MAX / 2).size(), None);
    }
}
