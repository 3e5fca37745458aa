//! Frames a second, checked once.

use crate::Error;

/// Frames a second: finite and positive.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct FrameRate(f64);

impl FrameRate {
    /// Frames `per_second`, which must be finite and positive.
    ///
    /// # Errors
    /// [`Error::FrameRate`] with the value found.
    pub fn new(per_second: f64) -> Result<Self, Error> {
        if per_second.is_finite() && per_second > 0.0 {
            Ok(Self(per_second))
        } else {
            Err(Error::FrameRate { found: per_second })
        }
    }

    /// Frames a second.
    pub const fn per_second(self) -> f64 {
        self.0
    }

    /// Time from one frame to the next, in seconds.
    pub const fn frame_seconds(self) -> f64 {
        1.0 / self.0
    }
}
