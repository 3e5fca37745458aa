//! The embedded proxies of the open body: no file needed.
//!
//! Fitted by `physique proxy fit`; `assets/CARD.md` tells how, with numbers.

use std::sync::{Arc, OnceLock};

use crate::files::{ProxyLimits, parse_proxy};
use crate::{Error, SphereProxy};

/// The open body's proxy of 192 spheres, the paper's size. Decoded once, then shared.
///
/// # Errors
/// None in practice: the tests read the embedded file. A damaged build is told, not hidden.
pub fn open_proxy() -> Result<Arc<SphereProxy>, Error> {
    open_proxy_with(192)
}

/// The open body's proxy of 128, 192 or 256 spheres. Each is decoded once, then shared.
///
/// # Errors
/// [`Error::NoOpenProxy`] for another number of spheres.
pub fn open_proxy_with(spheres: usize) -> Result<Arc<SphereProxy>, Error> {
    static PROXIES: [OnceLock<Arc<SphereProxy>>; OPEN_PROXY_SIZES.len()] =
        [const { OnceLock::new() }; OPEN_PROXY_SIZES.len()];
    let Some(index) = OPEN_PROXY_SIZES.iter().position(|&size| size == spheres) else {
        return Err(Error::NoOpenProxy { found: spheres });
    };
    if let Some(proxy) = PROXIES[index].get() {
        return Ok(Arc::clone(proxy));
    }
    let file = format!("open_{spheres}.safetensors (embedded)");
    let proxy = Arc::new(parse_proxy(&file, BYTES[index], &ProxyLimits::default())?);
    Ok(Arc::clone(PROXIES[index].get_or_init(|| proxy)))
}

/// Sizes of the embedded proxies.
pub const OPEN_PROXY_SIZES: [usize; 3] = [128, 192, 256];

const BYTES: [&[u8]; OPEN_PROXY_SIZES.len()] = [
    include_bytes!("../assets/open_128.safetensors"),
    include_bytes!("../assets/open_192.safetensors"),
    include_bytes!("../assets/open_256.safetensors"),
];
