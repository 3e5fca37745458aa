//! The form before PyTorch 1.6: pickles of a magic number, the version, the machine, the value and
//! the storages' names, then for each storage its count and its numbers.

use std::collections::HashMap;
use std::sync::Arc;

use super::{Numbers, TorchFile};
use crate::Error;
use crate::npz::{ArrayLimits, ByteOrder};
use crate::pickle::{Pickle, PickleLimits, View};

/// A pickle of protocol 2 with the ten bytes of the magic number 0x1950a86a20f9469cfc6c.
pub(super) const START: &[u8] = b"\x80\x02\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19.";
const VERSION: i64 = 1001;

pub(super) fn read(
    bytes: Vec<u8>,
    arrays: &ArrayLimits,
    pickles: &PickleLimits,
) -> Result<TorchFile, Error> {
    let error = |place: &str, expected, found: String| Error::Torch {
        place: place.into(),
        expected,
        found,
    };
    if !bytes.starts_with(START) {
        let start = bytes[..bytes.len().min(16)].escape_ascii().to_string();
        return Err(error("start", "a ZIP archive or PyTorch's number", start));
    }
    if bytes.len() as u64 > arrays.bytes {
        let found = format!("{} bytes", bytes.len());
        return Err(error("start", "a file within the limit of bytes", found));
    }

    let version = Pickle::read_at(bytes, START.len(), pickles)?;
    if !matches!(version.root().view(), View::Integer(VERSION)) {
        return Err(error("version", "1001", format!("{:?}", version.root())));
    }
    let machine = next(version, pickles)?;
    let big = machine
        .root()
        .get("little_endian")
        .map(|little| little.view());
    let byte_order = match big {
        Some(View::Bool(false)) => ByteOrder::Big,
        _ => ByteOrder::Little,
    };

    // The value keeps its own copy of the bytes it refers to.
    let at = machine.end();
    let bytes = machine.into_bytes();
    let value = Pickle::read_at(bytes.clone(), at, pickles)?;
    let names = Pickle::read_at(bytes, value.end(), pickles)?;
    let mut position = names.end();
    let listed = names.root().list().map(|names| {
        let listed = names.iter().map(|name| name.text().map(str::to_owned));
        listed.collect::<Option<Vec<String>>>()
    });
    let Some(Some(listed)) = listed else {
        return Err(error(
            "storages",
            "a list of names",
            names.root().kind().into(),
        ));
    };
    let bytes: Arc<[u8]> = names.into_bytes().into();

    let sizes = element_sizes(&value);
    let mut storages = HashMap::new();
    for name in listed {
        let place = format!("storage `{}`", name.escape_debug());
        let short = || {
            error(
                &place,
                "a count and as many numbers",
                "the end of the file".into(),
            )
        };
        let rest = bytes.get(position..).unwrap_or_default();
        let count = *rest.first_chunk().ok_or_else(short)?;
        let count = match byte_order {
            ByteOrder::Little => u64::from_le_bytes(count),
            ByteOrder::Big => u64::from_be_bytes(count),
        };
        let Some(&size) = sizes.get(&name) else {
            return Err(error(&place, "a storage that a tensor uses", "none".into()));
        };
        let start = position + size_of::<u64>();
        let length = usize::try_from(count)
            .ok()
            .and_then(|count| count.checked_mul(size));
        let end = length.and_then(|length| start.checked_add(length));
        let end = end.filter(|&end| end <= bytes.len()).ok_or_else(short)?;
        storages.insert(name, Numbers::Within(Arc::clone(&bytes), start..end));
        position = end;
    }
    Ok(TorchFile {
        pickle: value,
        storages,
        byte_order,
        limit: arrays.bytes,
    })
}

/// The pickle behind another one.
fn next(before: Pickle, limits: &PickleLimits) -> Result<Pickle, Error> {
    let at = before.end();
    Ok(Pickle::read_at(before.into_bytes(), at, limits)?)
}

/// Bytes of a number, by storage.
fn element_sizes(value: &Pickle) -> HashMap<String, usize> {
    let storages = value.storages();
    storages
        .map(|storage| (storage.key.clone(), storage.element.size()))
        .collect()
}
