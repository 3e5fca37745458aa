//! What counts as ground, contact and sliding.

use crate::Error;

/// Where the ground is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GroundChoice {
    /// At this height, in metres.
    Given(f64),
    /// Found from the clip: the height that 5 of 100 lowest sole points of slow frames lie below.
    Estimated,
}

/// Options of the native measures. All in metres and seconds, none in frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhysicsOptions {
    /// Where the ground is: at height 0 unless told otherwise.
    pub ground: GroundChoice,
    /// Skin lower than this above the ground may touch it, in metres.
    pub contact_height: f64,
    /// Skin faster than this does not bear the body, in m/s.
    pub contact_speed: f64,
    /// Low soles slower than this slide; faster ones swing past, in m/s.
    pub swing_speed: f64,
    /// Cut-off of the averages for balance, in Hz: see [`crate::TimeFilter::averaging`]. 3 Hz
    /// averages over about one frame of the slowest common rate, 20 fps, to either side.
    pub balance_cutoff_hz: f64,
    /// Cut-off of the derivatives for smoothness, in Hz.
    pub smoothness_cutoff_hz: f64,
}

impl Default for PhysicsOptions {
    fn default() -> Self {
        Self {
            ground: GroundChoice::Given(0.0),
            contact_height: 0.03,
            contact_speed: 0.4,
            swing_speed: 1.0,
            balance_cutoff_hz: 3.0,
            smoothness_cutoff_hz: 6.0,
        }
    }
}

impl PhysicsOptions {
    /// Refuses what is not a number in its range; the filters check the cut-offs.
    pub(crate) fn check(&self) -> Result<(), Error> {
        if let GroundChoice::Given(height) = self.ground
            && !height.is_finite()
        {
            return Err(Error::Option {
                option: "ground",
                expected: "a finite height in metres",
                found: height,
            });
        }
        for (option, found) in [
            ("contact_height", self.contact_height),
            ("contact_speed", self.contact_speed),
            ("swing_speed", self.swing_speed),
        ] {
            if !(found.is_finite() && found > 0.0) {
                return Err(Error::Option {
                    option,
                    expected: "a positive number",
                    found,
                });
            }
        }
        Ok(())
    }
}
