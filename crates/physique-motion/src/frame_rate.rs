//! Frames a second, checked once.

use crate::Error;

/// Frames a second: a number from [`FrameRate::SLOWEST`] to [`FrameRate::FASTEST`].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct FrameRate(f64);

impl FrameRate {
    /// A frame in a quarter of an hour.
    pub const SLOWEST: f64 = 1e-3;
    /// Faster than any camera follows a person; frames of a second can be counted.
    pub const FASTEST: f64 = 1e6;

    /// Frames `per_second`.
    ///
    /// # Errors
    /// [`Error::FrameRate`] with the value found, for numbers out of range.
    pub fn new(per_second: f64) -> Result<Self, Error> {
        if (Self::SLOWEST..=Self::FASTEST).contains(&per_second) {
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

/// Frames a second for a frame time, which exporters print with few digits: 0.0333333 is 30.
pub(crate) fn customary_rate(seconds: f64) -> f64 {
    const RATES: [f64; 20] = [
        10.0, 12.0, 12.5, 15.0, 20.0, 23.976, 24.0, 25.0, 29.97, 30.0, 48.0, 50.0, 59.94, 60.0,
        72.0, 90.0, 100.0, 119.88, 120.0, 240.0,
    ];
    let rate = 1.0 / seconds;
    let distance = |customary: f64| (rate / customary - 1.0).abs();
    RATES
        .into_iter()
        .filter(|&customary| distance(customary) < 5e-4)
        .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(rate)
}

#[cfg(test)]
mod tests {
    use super::{FrameRate, customary_rate};

    #[test]
    fn rates_that_no_motion_has_are_refused() {
        for wrong in [0.0, -30.0, 1e-300, 1e300, f64::INFINITY, f64::NAN] {
            let message = FrameRate::new(wrong).map_err(|error| error.to_string());
            assert!(
                message
                    .as_ref()
                    .is_err_and(|text| text.contains("1,000,000")),
                "{message:?}"
            );
        }
        assert!(FrameRate::new(12.5).is_ok());
    }

    #[test]
    fn few_digits_of_a_frame_time_name_the_customary_rate() {
        for (seconds, rate) in [
            (0.0333333, 30.0),
            (0.03333, 30.0),
            (0.0333667, 29.97),
            (0.016667, 60.0),
            (0.00833333, 120.0),
            (0.00833, 120.0),
            (0.0416667, 24.0),
        ] {
            assert_eq!(customary_rate(seconds), rate, "{seconds}");
        }
        assert_eq!(customary_rate(0.03), 1.0 / 0.03);
        assert!(customary_rate(0.0).is_infinite());
    }
}
