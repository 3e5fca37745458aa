//! Text forms of protocol 0.

/// Bytes from Python 2's `repr` of a `str`, quotes included; `None` where it is none.
pub(super) fn unquote(quoted: &[u8]) -> Option<Vec<u8>> {
    let (&quote, rest) = quoted.split_first()?;
    let (&last, body) = rest.split_last()?;
    if quote != last || !matches!(quote, b'\'' | b'"') {
        return None;
    }
    let mut bytes = Vec::with_capacity(body.len());
    let mut rest = body;
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        if byte != b'\\' {
            bytes.push(byte);
            continue;
        }
        let (&letter, after) = rest.split_first()?;
        rest = after;
        bytes.push(match letter {
            b'\\' | b'\'' | b'"' => letter,
            b'a' => 7,
            b'b' => 8,
            b't' => b'\t',
            b'n' => b'\n',
            b'v' => 11,
            b'f' => 12,
            b'r' => b'\r',
            b'x' => {
                let value = hexadecimal(rest, 2)?;
                rest = &rest[2..];
                value as u8
            }
            b'0'..=b'7' => {
                let mut value = u32::from(letter - b'0');
                for _ in 0..2 {
                    let Some((&digit @ b'0'..=b'7', after)) = rest.split_first() else {
                        break;
                    };
                    value = value * 8 + u32::from(digit - b'0');
                    rest = after;
                }
                u8::try_from(value).ok()?
            }
            _ => return None,
        });
    }
    Some(bytes)
}

/// Text from Python's `raw-unicode-escape`: Latin-1 with `\uXXXX` and `\UXXXXXXXX`.
///
/// Halves of a surrogate pair that lost the other half become U+FFFD.
pub(super) fn raw_unicode_escape(escaped: &[u8]) -> Option<String> {
    let mut units: Vec<u16> = Vec::with_capacity(escaped.len());
    let mut rest = escaped;
    while let Some((&byte, after)) = rest.split_first() {
        let digits = match rest {
            [b'\\', b'u', ..] => 4,
            [b'\\', b'U', ..] => 8,
            _ => {
                units.push(byte.into());
                rest = after;
                continue;
            }
        };
        let code = hexadecimal(&rest[2..], digits)?;
        rest = &rest[2 + digits..];
        match u16::try_from(code) {
            Ok(unit) => units.push(unit),
            Err(_) => units.extend_from_slice(char::from_u32(code)?.encode_utf16(&mut [0; 2])),
        }
    }
    Some(String::from_utf16_lossy(&units))
}

fn hexadecimal(text: &[u8], digits: usize) -> Option<u32> {
    text.get(..digits)?.iter().try_fold(0_u32, |value, &digit| {
        Some(value * 16 + char::from(digit).to_digit(16)?)
    })
}

#[cfg(test)]
mod tests {
    use super::{raw_unicode_escape, unquote};

    #[test]
    fn quoted_bytes() {
        assert_eq!(
            unquote(br"'a\x00\xff\n\'\\\101'").unwrap(),
            b"a\0\xff\n'\\A"
        );
        assert_eq!(unquote(b"\"it's\"").unwrap(), b"it's");
        for broken in [
            &b"'"[..],
            b"",
            b"'a",
            b"'a\\'",
            b"'\\x4'",
            b"'\\q'",
            b"'\\777'",
            b"a'",
        ] {
            assert_eq!(unquote(broken), None, "{broken:?}");
        }
    }

    #[test]
    fn escaped_text() {
        let read = |text: &[u8]| raw_unicode_escape(text).unwrap();
        assert_eq!(read(b"Gr\xfc\\u00dfe \\U0001f600 \\n"), "Grüße 😀 \\n");
        assert_eq!(read(b"\\ud83d\\ude00"), "😀");
        assert_eq!(read(b"\\ud83d"), "\u{fffd}");
        for broken in [&b"\\u12"[..], b"\\u", b"\\U00110000", b"\\u00g0"] {
            assert_eq!(raw_unicode_escape(broken), None, "{broken:?}");
        }
    }
}
