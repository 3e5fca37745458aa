//! How much the files of an encoder may ask for.

use physique_files::npz::ArrayLimits;
use physique_files::pickle::PickleLimits;

/// Upper bounds, checked before memory is taken.
#[derive(Clone, Copy, Debug)]
pub struct TextLimits {
    /// Bytes of a file of weights. CLIP with its image tower has 600 MB.
    pub weight_bytes: u64,
    /// Bytes of a vocabulary or a configuration.
    pub text_bytes: u64,
    /// Layers of a transformer.
    pub layers: usize,
}

impl Default for TextLimits {
    fn default() -> Self {
        Self {
            weight_bytes: 1 << 31,
            text_bytes: 1 << 26,
            layers: 64,
        }
    }
}

impl TextLimits {
    pub(crate) fn arrays(&self) -> ArrayLimits {
        ArrayLimits {
            bytes: self.weight_bytes,
            ..ArrayLimits::default()
        }
    }

    pub(crate) fn pickles(&self) -> PickleLimits {
        PickleLimits::default()
    }
}
