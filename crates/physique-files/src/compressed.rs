//! Files that are compressed as a whole: gzip's, and zlib's as joblib writes them.

use std::io::Read;

use flate2::read::{GzDecoder, ZlibDecoder};

use crate::Error;

/// The content of a gzip or zlib stream; other bytes come back as they are.
///
/// Memory grows with what really comes, and stops at the limit.
///
/// # Errors
/// [`Error::Compressed`] for a stream that is broken or unpacks to more than `limit` bytes.
pub fn unpacked(bytes: Vec<u8>, limit: u64) -> Result<Vec<u8>, Error> {
    match bytes.as_slice() {
        [0x1f, 0x8b, ..] => read("gzip", GzDecoder::new(bytes.as_slice()), limit),
        // The first byte says zlib with a window of 32 KiB; the pair is a multiple of 31.
        [0x78, second, ..] if (0x7800 + u32::from(*second)).is_multiple_of(31) => {
            read("zlib", ZlibDecoder::new(bytes.as_slice()), limit)
        }
        _ => Ok(bytes),
    }
}

fn read(method: &'static str, stream: impl Read, limit: u64) -> Result<Vec<u8>, Error> {
    let mut content = Vec::new();
    let outcome = stream
        .take(limit.saturating_add(1))
        .read_to_end(&mut content);
    if let Err(error) = outcome {
        return Err(Error::Compressed {
            method,
            expected: "a whole stream".into(),
            found: error.to_string(),
        });
    }
    if content.len() as u64 > limit {
        return Err(Error::Compressed {
            method,
            expected: format!("at most {limit} bytes inside; raise the limit if the file is right"),
            found: "more".into(),
        });
    }
    Ok(content)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::{GzEncoder, ZlibEncoder};

    use super::unpacked;

    #[test]
    fn streams_unpack_within_the_limit_and_others_stay() -> std::io::Result<()> {
        let text = b"HIERARCHY ".repeat(1000);
        let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
        let mut zlib = ZlibEncoder::new(Vec::new(), Compression::default());
        gzip.write_all(&text)?;
        zlib.write_all(&text)?;
        for packed in [gzip.finish()?, zlib.finish()?] {
            assert!(unpacked(packed.clone(), 10_000).is_ok_and(|content| content == text));
            let bomb = unpacked(packed.clone(), 9_999).map_err(|error| error.to_string());
            assert!(bomb.is_err_and(|error| error.contains("at most 9999 bytes")));
            let broken = unpacked(packed[..packed.len() / 2].to_vec(), 10_000);
            assert!(broken.is_err());
        }
        for plain in [b"x".to_vec(), b"HIERARCHY".to_vec(), Vec::new()] {
            assert!(unpacked(plain.clone(), 100).is_ok_and(|same| same == plain));
        }
        Ok(())
    }
}
