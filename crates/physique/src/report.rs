//! What `score` says of many motions: the stable contract of `--json` and the other formats.

use physique_body::Body;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{BodyDescription, Floor, Group, MotionScore, Protocol, ScoreOptions};

/// Name and version of the JSON that [`Report`] becomes. The number grows when a field changes its
/// meaning or goes away; new fields may come without.
pub const SCHEMA: &str = "physique.score/2";

/// Scores of many motions on one body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Report {
    /// What measured, on what.
    #[serde(flatten)]
    pub head: ReportHead,
    /// One entry a motion, in the order asked for.
    pub motions: Vec<MotionReport>,
}

/// What a report holds beside the motions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReportHead {
    /// Name and version of this format: `physique.score/2`.
    pub schema: String,
    /// Version of Physique that measured.
    pub physique_version: String,
    /// Which definitions of the measures.
    pub protocols: Vec<Protocol>,
    /// Which groups of Physique's own measures.
    pub groups: Vec<Group>,
    /// Where the floor was taken to be.
    pub floor: Floor,
    /// The body that was scored.
    pub body: BodyDescription,
}

impl ReportHead {
    /// What measures by these options, on this body.
    pub fn new(options: &ScoreOptions, body: &Body) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            physique_version: env!("CARGO_PKG_VERSION").to_owned(),
            protocols: options.protocols.clone(),
            groups: options.groups.clone(),
            floor: options.floor,
            body: BodyDescription::of(body),
        }
    }
}

/// The score of one motion, or why there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MotionReport {
    /// The file.
    pub file: String,
    /// The file's name, with `#` and a number or key where it holds several motions, such as
    /// `results.npy#3`; or the name of an embedded clip.
    pub name: String,
    /// What the motion shows, where the file says: the prompt of a generator.
    pub text: Option<String>,
    /// What was measured; null if the motion could not be scored.
    pub score: Option<MotionScore>,
    /// Why there is no score; null if there is one.
    pub unscorable: Option<String>,
    /// How the motion was brought to the body; null for motions of the body itself.
    pub mapping: Option<MappingSummary>,
    /// What a reader of the figures should know: conversions, guesses, things left out.
    pub notes: Vec<String>,
}

impl MotionReport {
    /// Why a motion has no score.
    pub fn unscorable(file: String, name: String, reason: String) -> Self {
        Self {
            file,
            name,
            text: None,
            score: None,
            unscorable: Some(reason),
            mapping: None,
            notes: Vec::new(),
        }
    }
}

/// How well a foreign skeleton's motion fits the body's 22 joints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MappingSummary {
    /// How joints were recognised.
    pub skeleton: String,
    /// Mean distance between joints of the source, scaled to the body, and of the result, in cm.
    pub mean_error_cm: f64,
    /// The same, 95th percentile.
    pub p95_error_cm: f64,
    /// The same, largest.
    pub worst_error_cm: f64,
}
