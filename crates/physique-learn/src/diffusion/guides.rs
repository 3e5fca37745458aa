//! Which losses guide, by name.

use std::str::FromStr;

use physique_motion::features::FeatureStatistics;
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::motion_loss::{
    GroundLoss, SelfIntersectionLoss, SelfIntersectionSettings, SlidingLoss, WeightedLoss,
};

/// How much each of the losses guides that need no file; 0 does nothing, 1 is a full step. Written
/// `self=1,feet=0.5,ground=1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GuideWeights {
    /// `self`: bodies should not pass through themselves.
    #[serde(rename = "self")]
    pub self_intersection: f64,
    /// `ground`: feet should be neither in the ground nor, at rest, above it.
    pub ground: f64,
    /// `feet`: feet that stand should not slide.
    pub feet: f64,
}

impl GuideWeights {
    /// Names of the losses.
    pub const NAMES: [&'static str; 3] = ["self", "ground", "feet"];

    /// The losses that have a weight, for features normalised by `statistics`.
    ///
    /// # Errors
    /// [`Error::Setting`] for a weight that is none; those of
    /// [`SelfIntersectionLoss::embedded`].
    pub fn guides(&self, statistics: &FeatureStatistics) -> Result<Vec<WeightedLoss>, Error> {
        let mut guides = Vec::new();
        if self.self_intersection != 0.0 {
            let loss =
                SelfIntersectionLoss::embedded(statistics, SelfIntersectionSettings::default())?;
            guides.push(WeightedLoss::new("self", self.self_intersection, loss)?);
        }
        if self.ground != 0.0 {
            let loss = GroundLoss::new(statistics.clone());
            guides.push(WeightedLoss::new("ground", self.ground, loss)?);
        }
        if self.feet != 0.0 {
            let loss = SlidingLoss::new(statistics.clone());
            guides.push(WeightedLoss::new("feet", self.feet, loss)?);
        }
        Ok(guides)
    }
}

impl FromStr for GuideWeights {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let mut weights = Self::default();
        for part in text.split(',').filter(|_| !text.is_empty()) {
            let refuse = || {
                let expected = format!("NAME=WEIGHT, of {}", Self::NAMES.join(", "));
                Error::setting("guide", expected, format!("`{}`", part.escape_debug()))
            };
            let (name, weight) = part.split_once('=').ok_or_else(refuse)?;
            let weight: f64 = weight.trim().parse().map_err(|_| refuse())?;
            let place = match name.trim() {
                "self" => &mut weights.self_intersection,
                "ground" => &mut weights.ground,
                "feet" => &mut weights.feet,
                _ => return Err(refuse()),
            };
            if !(weight.is_finite() && weight >= 0.0) {
                return Err(refuse());
            }
            *place = weight;
        }
        Ok(weights)
    }
}

#[cfg(test)]
mod tests {
    use super::GuideWeights;

    #[test]
    fn weights_are_read() {
        let read: GuideWeights = "self=1, feet=0.5".parse().expect("weights");
        let expected = GuideWeights {
            self_intersection: 1.0,
            feet: 0.5,
            ground: 0.0,
        };
        assert_eq!(read, expected);
        assert_eq!(
            "".parse::<GuideWeights>().expect("none"),
            GuideWeights::default()
        );
        for wrong in [
            "self",
            "self=",
            "self=-1",
            "feet=NaN",
            "hands=1",
            "self=1;feet=1",
        ] {
            let told = wrong.parse::<GuideWeights>().expect_err(wrong).to_string();
            assert!(
                told.contains("NAME=WEIGHT, of self, ground, feet"),
                "{told}"
            );
        }
    }
}
