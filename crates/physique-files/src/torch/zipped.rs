//! The form since PyTorch 1.6: `name/data.pkl`, `name/byteorder` and `name/data/0` and on. TorchScript
//! adds `name/code/` and `name/constants.pkl`, which are not looked at.

use super::{Numbers, TorchFile};
use crate::Error;
use crate::npz::{Archive, ArrayLimits, ByteOrder};
use crate::pickle::{Pickle, PickleLimits};

pub(super) fn read(
    bytes: Vec<u8>,
    arrays: &ArrayLimits,
    pickles: &PickleLimits,
) -> Result<TorchFile, Error> {
    // Checkpoints have thousands of entries where `.npz` files have dozens; they cost little.
    let limits = ArrayLimits {
        entries: arrays.entries.saturating_mul(16),
        ..*arrays
    };
    let mut archive = Archive::open(bytes, limits)?;
    let names: Vec<String> = archive.entries().map(str::to_owned).collect();
    let folder = names.iter().find_map(|name| name.strip_suffix("data.pkl"));
    let folder = folder.ok_or_else(|| Error::Torch {
        place: "the archive".into(),
        expected: "an entry `data.pkl`",
        found: format!("{} other entries", names.len()),
    })?;
    let order_name = format!("{folder}byteorder");
    let mut byte_order = ByteOrder::Little;
    if names.contains(&order_name) {
        byte_order = match archive.entry(&order_name)?.as_slice() {
            b"little" => ByteOrder::Little,
            b"big" => ByteOrder::Big,
            other => {
                return Err(Error::Torch {
                    place: order_name,
                    expected: "`little` or `big`",
                    found: format!("{} other bytes", other.len()),
                });
            }
        };
    }
    let pickle = Pickle::read(archive.entry(&format!("{folder}data.pkl"))?, pickles)?;
    let data = format!("{folder}data/");
    let mut storages = std::collections::HashMap::new();
    for name in &names {
        if let Some(key) = name.strip_prefix(&data) {
            storages.insert(key.to_owned(), Numbers::Own(archive.entry(name)?));
        }
    }
    Ok(TorchFile {
        pickle,
        storages,
        byte_order,
        limit: arrays.bytes,
    })
}
