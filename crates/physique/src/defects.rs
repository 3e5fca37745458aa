//! What is wrong with a clip before anyone scores it: too short, jumping, frozen, told at a wrong
//! frame rate, sunk, floating, or deep in itself.
//!
//! [`DefectFinder`] looks at a motion on a body; [`Defect::of_error`] says the same of a file that
//! cannot be read. [`DefectLimits`] holds every threshold with the reason for it. Defects are
//! warnings: a clip that has one may be fine, and a person or a filter decides.

mod finder;
mod flight;
mod ground;
mod jump;
mod limits;
mod still;
mod track;

pub use finder::DefectFinder;
pub use limits::DefectLimits;

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Error;

/// What kind of thing is wrong.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum DefectKind {
    /// The file cannot be read, or holds no human.
    Unreadable,
    /// A number of the motion is NaN or infinite.
    NotFinite,
    /// Hardly any frames.
    TooShort,
    /// A joint is elsewhere or turned from one frame to the next.
    Jump,
    /// Nothing moves for a while.
    Frozen,
    /// Frames are shown several times.
    RepeatedFrames,
    /// The stated frame rate cannot be right.
    FrameRate,
    /// Feet or other skin are in the ground.
    BelowGround,
    /// The body hovers.
    Floating,
    /// The body is deep in itself.
    SelfIntersection,
}

impl DefectKind {
    /// All kinds, in the order of reports.
    pub const ALL: [Self; 10] = [
        Self::Unreadable,
        Self::NotFinite,
        Self::TooShort,
        Self::Jump,
        Self::Frozen,
        Self::RepeatedFrames,
        Self::FrameRate,
        Self::BelowGround,
        Self::Floating,
        Self::SelfIntersection,
    ];

    /// The name by which commands and reports call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unreadable => "unreadable",
            Self::NotFinite => "not-finite",
            Self::TooShort => "too-short",
            Self::Jump => "jump",
            Self::Frozen => "frozen",
            Self::RepeatedFrames => "repeated-frames",
            Self::FrameRate => "frame-rate",
            Self::BelowGround => "below-ground",
            Self::Floating => "floating",
            Self::SelfIntersection => "self-intersection",
        }
    }
}

impl fmt::Display for DefectKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// Something wrong with a clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Defect {
    /// What kind of thing.
    pub kind: DefectKind,
    /// What was found, how much and when: a full sentence.
    pub message: String,
    /// When it is worst, or begins, in seconds; null for the clip as a whole.
    pub at_s: Option<f64>,
    /// How much was found, in the unit of the limit; null where there is nothing to measure.
    pub value: Option<f64>,
    /// What was allowed; null where there is no threshold.
    pub limit: Option<f64>,
}

impl Defect {
    /// Why a file or motion could not even be looked at.
    pub fn of_error(error: &Error) -> Self {
        let kind = match error {
            Error::Motion(physique_motion::Error::NotFinite { .. }) => DefectKind::NotFinite,
            Error::NoFrames | Error::Motion(physique_motion::Error::NoFrames) => {
                DefectKind::TooShort
            }
            _ => DefectKind::Unreadable,
        };
        Self {
            kind,
            message: error.to_string(),
            at_s: None,
            value: None,
            limit: None,
        }
    }

    const fn measured(
        kind: DefectKind,
        message: String,
        at_s: Option<f64>,
        value: f64,
        limit: f64,
    ) -> Self {
        Self {
            kind,
            message,
            at_s,
            value: Some(value),
            limit: Some(limit),
        }
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", self.kind, self.message)
    }
}
