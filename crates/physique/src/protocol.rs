//! Which definitions of the measures: Physique's own, and the published ones.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use physique_physics::Protocol as Published;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::Error;

/// A definition of the measures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Protocol {
    /// Physique's own: volumes exact along lines, intersections told apart from creases; ground,
    /// feet, balance and smoothness in metres and seconds.
    #[default]
    Native,
    /// The voxel metric of the self-intersection-aware papers: see [`physique_geometry::sia`].
    Sia,
    /// Another one of the field: see [`physique_physics::protocol`].
    Published(Published),
}

/// What a protocol is, for people.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct About {
    /// What it measures.
    pub measures: &'static str,
    /// Where it is defined.
    pub source: &'static str,
}

impl Protocol {
    /// All protocols, in the order of reports.
    pub const ALL: [Self; 12] = [
        Self::Native,
        Self::Sia,
        Self::Published(Published::HumosReleased),
        Self::Published(Published::HumosCorrected),
        Self::Published(Published::PhysDiff),
        Self::Published(Published::Gmd),
        Self::Published(Published::ReinDiffuse),
        Self::Published(Published::Kimodo),
        Self::Published(Published::EdgePfc),
        Self::Published(Published::Mann),
        Self::Published(Published::Humor),
        Self::Published(Published::Ipman),
    ];

    /// The name by which commands and reports call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Native => "native",
            Self::Sia => "sia",
            Self::Published(published) => published.name(),
        }
    }

    /// Frames a second to which motions are resampled, because the definition counts in frames;
    /// `None` where the motion's own rate will do.
    pub const fn frame_rate(self) -> Option<f64> {
        match self {
            Self::Native | Self::Sia => None,
            Self::Published(published) => published.frame_rate(),
        }
    }

    /// What it measures, and where it is defined.
    pub const fn about(self) -> About {
        let (measures, source) = match self {
            Self::Native => (
                "self-intersection, ground, feet, balance, smoothness in metres and seconds",
                "Physique",
            ),
            Self::Sia => (
                "self-intersection counted in voxels of the unit ball",
                "Herrmann et al., BMVC 2025, arXiv 2605.26744",
            ),
            Self::Published(Published::HumosReleased) => (
                "penetrate, float, skate, dynamic stability as the released pipeline computes them",
                "Tripathi et al., ECCV 2024, arXiv 2409.03944",
            ),
            Self::Published(Published::HumosCorrected) => (
                "the same with the right zero moment point, unconditional means, flight left out",
                "Tripathi et al., ECCV 2024, corrected",
            ),
            Self::Published(Published::PhysDiff) => (
                "penetrate, float, skate and their sum, 5 mm tolerance",
                "Yuan et al., ICCV 2023",
            ),
            Self::Published(Published::Gmd) => (
                "foot skating ratio of the toes (GMD, OmniControl)",
                "Karunratanakul et al., ICCV 2023",
            ),
            Self::Published(Published::ReinDiffuse) => (
                "skate, float, penetrate of the lowest joint, feet that clip",
                "Han et al., WACV 2025",
            ),
            Self::Published(Published::Kimodo) => {
                ("toe skating and speed in contact", "arXiv 2603.15546")
            }
            Self::Published(Published::EdgePfc) => (
                "physical foot contact score of the root's acceleration",
                "Tseng et al., CVPR 2023 (EDGE)",
            ),
            Self::Published(Published::Mann) => (
                "skating weighted by height (MANN, NeMF)",
                "Zhang et al., SIGGRAPH 2018",
            ),
            Self::Published(Published::Humor) => (
                "toes below ground by depth, acceleration of the joints",
                "Rempe et al., ICCV 2021",
            ),
            Self::Published(Published::Ipman) => (
                "centre of mass against centre of pressure and base of support, frame by frame",
                "Tripathi et al., CVPR 2023",
            ),
        };
        About { measures, source }
    }
}

impl fmt::Display for Protocol {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl FromStr for Protocol {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        let known = Self::ALL.into_iter().find(|known| known.name() == name);
        known.ok_or_else(|| Error::Protocol { found: name.into() })
    }
}

impl Serialize for Protocol {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Protocol {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = Cow::<str>::deserialize(deserializer)?;
        name.parse().map_err(serde::de::Error::custom)
    }
}

impl JsonSchema for Protocol {
    fn schema_name() -> Cow<'static, str> {
        "Protocol".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let names = Self::ALL.map(Self::name);
        json_schema!({
            "description": "A definition of the measures.",
            "type": "string",
            "enum": names,
        })
    }
}

/// The measures of a published protocol, by their published names, which end in their units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PublishedScore {
    /// Whose definition.
    pub protocol: Protocol,
    /// Frames a second to which the motion was resampled; null for its own rate.
    pub frame_rate_fps: Option<f64>,
    /// Measures; null where no frame meets the definition's condition.
    pub measures: BTreeMap<String, Option<f64>>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_there_and_back() {
        for protocol in Protocol::ALL {
            assert_eq!(protocol.name().parse::<Protocol>().unwrap(), protocol);
            let json = serde_json::to_string(&protocol).unwrap();
            assert_eq!(serde_json::from_str::<Protocol>(&json).unwrap(), protocol);
        }
        let all = Published::ALL.map(Protocol::Published);
        assert!(all.iter().all(|protocol| Protocol::ALL.contains(protocol)));
        let error = "voxels".parse::<Protocol>().unwrap_err().to_string();
        assert!(error.contains("humos-corrected"), "{error}");
    }
}
