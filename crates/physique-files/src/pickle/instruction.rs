//! From bytes to instructions: the sixty-eight opcodes of protocols 0 to 5.
//!
//! Many opcodes differ only in how they store an operand; they become one instruction here.
//! Meaning of the opcodes: CPython's `Lib/pickletools.py` and PEP 307, 3154 and 574.

use super::PickleError;
use super::blob::Blob;
use super::cursor::Cursor;

/// What the machine is told to do. Operands that are text or bytes stay in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Instruction {
    None,
    Bool(bool),
    Integer(i64),
    /// A number; integers that do not fit 64 bits are rounded to one.
    Float(f64),
    Bytes(Blob),
    /// UTF-8.
    Text(Blob),
    /// Bytes as Python 2's `repr` writes them, quotes included.
    QuotedBytes(Blob),
    /// Text in Python's `raw-unicode-escape`.
    EscapedText(Blob),
    EmptyList,
    EmptyTuple,
    EmptyDict,
    EmptySet,
    Mark,
    Pop,
    PopMark,
    Duplicate,
    /// Of so many values from the top of the stack.
    Tuple(usize),
    /// The others take all values above the last mark.
    TupleFromMark,
    ListFromMark,
    DictFromMark,
    FrozenSetFromMark,
    Append,
    Appends,
    SetItem,
    SetItems,
    AddItems,
    Get(u32),
    Put(u32),
    Memoize,
    Global {
        module: Blob,
        name: Blob,
    },
    StackGlobal,
    /// An object of a named class; arguments above the mark.
    Instance {
        module: Blob,
        name: Blob,
    },
    /// An object of the class at the mark; arguments above it.
    ObjectFromMark,
    NewObject,
    NewObjectWithKeywords,
    Reduce,
    Build,
    /// A reference to something outside the pickle, by text or by value.
    PersistentText(Blob),
    Persistent,
    Buffer,
    ReadOnlyBuffer,
    /// Known, and without effect on data.
    Nothing,
    /// A number in a registry that only the writing program knows.
    Extension(u32),
    Stop,
}

impl Instruction {
    /// Decodes the instruction at the cursor.
    pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<Self, PickleError> {
        let byte = cursor.position();
        Ok(match cursor.u8("an instruction")? {
            b'(' => Self::Mark,
            b'.' => Self::Stop,
            b'0' => Self::Pop,
            b'1' => Self::PopMark,
            b'2' => Self::Duplicate,
            b'F' => Self::Float(decimal(cursor, byte, "a decimal number")?),
            b'G' => Self::Float(f64::from_be_bytes(cursor.array("a number")?)),
            b'I' => integer_or_bool(cursor, byte)?,
            b'J' => Self::Integer(i32::from_le_bytes(cursor.array("an integer")?).into()),
            b'K' => Self::Integer(cursor.u8("an integer")?.into()),
            b'L' => long_line(cursor, byte)?,
            b'M' => Self::Integer(u16::from_le_bytes(cursor.array("an integer")?).into()),
            0x8a => {
                let length = cursor.u8("a length")?;
                long(cursor, length.into())?
            }
            0x8b => {
                let length = cursor.length_i32()?;
                long(cursor, length)?
            }
            b'N' => Self::None,
            0x88 => Self::Bool(true),
            0x89 => Self::Bool(false),
            b'S' => Self::QuotedBytes(cursor.line()?),
            b'T' => {
                let length = cursor.length_i32()?;
                Self::Bytes(cursor.take(length, "bytes")?)
            }
            b'U' | b'C' => {
                let length = cursor.u8("a length")?;
                Self::Bytes(cursor.take(length.into(), "bytes")?)
            }
            b'B' => {
                let length = cursor.length_u32()?;
                Self::Bytes(cursor.take(length, "bytes")?)
            }
            0x8e | 0x96 => {
                let length = cursor.length_u64()?;
                Self::Bytes(cursor.take(length, "bytes")?)
            }
            b'V' => Self::EscapedText(cursor.line()?),
            b'X' => {
                let length = cursor.length_u32()?;
                Self::Text(cursor.take(length, "text")?)
            }
            0x8c => {
                let length = cursor.u8("a length")?;
                Self::Text(cursor.take(length.into(), "text")?)
            }
            0x8d => {
                let length = cursor.length_u64()?;
                Self::Text(cursor.take(length, "text")?)
            }
            b']' => Self::EmptyList,
            b')' => Self::EmptyTuple,
            b'}' => Self::EmptyDict,
            0x8f => Self::EmptySet,
            0x85 => Self::Tuple(1),
            0x86 => Self::Tuple(2),
            0x87 => Self::Tuple(3),
            b't' => Self::TupleFromMark,
            b'l' => Self::ListFromMark,
            b'd' => Self::DictFromMark,
            0x91 => Self::FrozenSetFromMark,
            b'a' => Self::Append,
            b'e' => Self::Appends,
            b's' => Self::SetItem,
            b'u' => Self::SetItems,
            0x90 => Self::AddItems,
            b'g' => Self::Get(decimal(cursor, byte, "the number of a value")?),
            b'h' => Self::Get(cursor.u8("the number of a value")?.into()),
            b'j' => Self::Get(u32::from_le_bytes(cursor.array("the number of a value")?)),
            b'p' => Self::Put(decimal(cursor, byte, "the number of a value")?),
            b'q' => Self::Put(cursor.u8("the number of a value")?.into()),
            b'r' => Self::Put(u32::from_le_bytes(cursor.array("the number of a value")?)),
            0x94 => Self::Memoize,
            b'c' => Self::Global {
                module: cursor.line()?,
                name: cursor.line()?,
            },
            0x93 => Self::StackGlobal,
            b'i' => Self::Instance {
                module: cursor.line()?,
                name: cursor.line()?,
            },
            b'o' => Self::ObjectFromMark,
            0x81 => Self::NewObject,
            0x92 => Self::NewObjectWithKeywords,
            b'R' => Self::Reduce,
            b'b' => Self::Build,
            b'P' => Self::PersistentText(cursor.line()?),
            b'Q' => Self::Persistent,
            0x97 => Self::Buffer,
            0x98 => Self::ReadOnlyBuffer,
            0x80 => protocol(cursor, byte)?,
            0x95 => {
                // Frames only tell how much to read ahead; the bytes are all here already.
                let length = cursor.length_u64()?;
                cursor.require(length, "the whole frame")?;
                Self::Nothing
            }
            0x82 => Self::Extension(cursor.u8("a number")?.into()),
            0x83 => Self::Extension(u16::from_le_bytes(cursor.array("a number")?).into()),
            0x84 => Self::Extension(u32::from_le_bytes(cursor.array("a number")?)),
            unknown => {
                return Err(PickleError::Malformed {
                    byte,
                    expected: "an instruction of protocols 0 to 5",
                    found: format!("byte 0x{unknown:02x}"),
                });
            }
        })
    }
}

fn protocol(cursor: &mut Cursor<'_>, byte: usize) -> Result<Instruction, PickleError> {
    match cursor.u8("the protocol")? {
        0..=5 => Ok(Instruction::Nothing),
        later => Err(PickleError::Malformed {
            byte,
            expected: "protocol 0 to 5",
            found: later.to_string(),
        }),
    }
}

fn decimal<T: std::str::FromStr>(
    cursor: &mut Cursor<'_>,
    byte: usize,
    expected: &'static str,
) -> Result<T, PickleError> {
    let line = cursor.line()?;
    parse(cursor.text(line), byte, expected)
}

fn parse<T: std::str::FromStr>(
    text: &[u8],
    byte: usize,
    expected: &'static str,
) -> Result<T, PickleError> {
    let number = str::from_utf8(text).ok().and_then(|text| text.parse().ok());
    number.ok_or_else(|| PickleError::Malformed {
        byte,
        expected,
        found: shown(text),
    })
}

/// Protocols 0 and 1 write truth values as the integers `00` and `01`.
fn integer_or_bool(cursor: &mut Cursor<'_>, byte: usize) -> Result<Instruction, PickleError> {
    let line = cursor.line()?;
    Ok(match cursor.text(line) {
        b"00" => Instruction::Bool(false),
        b"01" => Instruction::Bool(true),
        text => Instruction::Integer(parse(text, byte, "an integer below 2^63")?),
    })
}

/// A decimal integer with Python 2's `L` at its end, or without.
fn long_line(cursor: &mut Cursor<'_>, byte: usize) -> Result<Instruction, PickleError> {
    let line = cursor.line()?;
    let text = cursor.text(line);
    let digits = text.strip_suffix(b"L").unwrap_or(text);
    let unsigned = digits.strip_prefix(b"-").unwrap_or(digits);
    if unsigned.len() > 18 && unsigned.iter().all(u8::is_ascii_digit) {
        if let Ok(integer) = parse(digits, byte, "an integer") {
            return Ok(Instruction::Integer(integer));
        }
        return parse(digits, byte, "an integer").map(Instruction::Float);
    }
    parse(digits, byte, "an integer").map(Instruction::Integer)
}

/// Two's complement, least significant byte first; an empty one is 0.
fn long(cursor: &mut Cursor<'_>, length: usize) -> Result<Instruction, PickleError> {
    let blob = cursor.take(length, "an integer")?;
    let bytes = cursor.text(blob);
    if bytes.len() > 8 {
        let mut from_highest = bytes.iter().rev();
        let highest = from_highest
            .next()
            .map_or(0.0, |&byte| f64::from(byte as i8));
        let rounded = from_highest.fold(highest, |sum, &byte| sum * 256.0 + f64::from(byte));
        return Ok(Instruction::Float(rounded));
    }
    let negative = bytes.last().is_some_and(|&last| last >= 0x80);
    let mut padded = [if negative { 0xff } else { 0 }; 8];
    padded[..bytes.len()].copy_from_slice(bytes);
    Ok(Instruction::Integer(i64::from_le_bytes(padded)))
}

/// The start of some bytes, for errors.
pub(super) fn shown(bytes: &[u8]) -> String {
    let start = &bytes[..bytes.len().min(60)];
    let more = if start.len() < bytes.len() { "..." } else { "" };
    format!("`{}{more}`", start.escape_ascii())
}
