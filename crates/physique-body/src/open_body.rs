//! The embedded open body: free for any use, no file needed.
//!
//! Made by `tools/open_body` from MakeHuman's data released as CC0 1.0; `assets/open_body.md`
//! tells how, with numbers. It has SMPL's 22 joints and blend-weight structure, but its **betas
//! are not SMPL's**: bring a person over by attributes ([`crate::Attributes`]), not by betas.

use std::sync::{Arc, OnceLock};

use crate::{BodyModel, Error, compact};

/// The open body at about 6,900 vertices: SMPL-like cost and detail. Decoded once, then shared.
///
/// # Errors
/// None in practice: the tests read the embedded file. A damaged build is told, not hidden.
pub fn open_body() -> Result<Arc<BodyModel>, Error> {
    static MODEL: OnceLock<Arc<BodyModel>> = OnceLock::new();
    shared(
        &MODEL,
        "open body",
        include_bytes!("../assets/open_body.npz"),
    )
}

/// The open body at about 3,000 vertices: for fast tests and coarse work.
///
/// # Errors
/// As [`open_body`].
pub fn open_body_low() -> Result<Arc<BodyModel>, Error> {
    static MODEL: OnceLock<Arc<BodyModel>> = OnceLock::new();
    shared(
        &MODEL,
        "open body (low)",
        include_bytes!("../assets/open_body_low.npz"),
    )
}

fn shared(
    cell: &OnceLock<Arc<BodyModel>>,
    name: &str,
    bytes: &[u8],
) -> Result<Arc<BodyModel>, Error> {
    if let Some(model) = cell.get() {
        return Ok(Arc::clone(model));
    }
    let model = Arc::new(compact::read(name, bytes)?);
    Ok(Arc::clone(cell.get_or_init(|| model)))
}
