//! Groups of Physique's own measures.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A group of measures.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Group {
    /// Parts of the body inside others. Takes most of the time.
    SelfIntersection,
    /// Skin in the ground and above.
    Ground,
    /// Feet that slide.
    Feet,
    /// Whether the body could stand as it moves.
    Balance,
    /// Acceleration and jerk of the joints.
    Smoothness,
}

impl Group {
    /// All groups, in the order of reports.
    pub const ALL: [Self; 5] = [
        Self::SelfIntersection,
        Self::Ground,
        Self::Feet,
        Self::Balance,
        Self::Smoothness,
    ];

    /// The name by which reports and people call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SelfIntersection => "self-intersection",
            Self::Ground => "ground",
            Self::Feet => "feet",
            Self::Balance => "balance",
            Self::Smoothness => "smoothness",
        }
    }
}

impl fmt::Display for Group {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}
