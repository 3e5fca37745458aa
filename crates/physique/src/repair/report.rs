//! What `repair` says of many motions: the stable contract of `--json`.

use physique_body::Body;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{RepairOptions, Repaired, Worse};
use crate::{BodyDescription, MotionScore};

/// Name and version of the JSON that [`RepairReport`] becomes. The number grows when a field changes
/// its meaning or goes away; new fields may come without.
pub const SCHEMA: &str = "physique.repair/1";

/// Repairs of many motions on one body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RepairReport {
    /// What repaired, on what.
    #[serde(flatten)]
    pub head: RepairHead,
    /// One entry a motion, in the order asked for.
    pub motions: Vec<RepairedMotion>,
}

/// What a report holds beside the motions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RepairHead {
    /// Name and version of this format: `physique.repair/1`.
    pub schema: String,
    /// Version of Physique that repaired.
    pub physique_version: String,
    /// The body that the motions were repaired for.
    pub body: BodyDescription,
    /// How it was done.
    #[serde(flatten)]
    pub options: RepairOptions,
}

impl RepairHead {
    /// What repairs by these options, on this body.
    pub fn new(options: RepairOptions, body: &Body) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            physique_version: env!("CARGO_PKG_VERSION").to_owned(),
            body: BodyDescription::of(body),
            options,
        }
    }
}

/// How a repair ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Nothing was found that is worth a change: the motion is the source, bit for bit.
    Sound,
    /// The motion was repaired.
    Repaired,
    /// The motion was repaired as far as the promise allows; `held_back_by` says what going on
    /// would have made worse.
    RepairedInPart,
    /// Every repair would have broken the promise: the motion is the source, bit for bit.
    HeldBack,
    /// The motion could not be read, repaired or written.
    Failed,
}

impl Outcome {
    /// In words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Sound => "sound",
            Self::Repaired => "repaired",
            Self::RepairedInPart => "in part",
            Self::HeldBack => "held back",
            Self::Failed => "failed",
        }
    }
}

/// The repair of one motion, or why there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RepairedMotion {
    /// The file.
    pub file: String,
    /// The file's name, with `#` and a number or key where it holds several motions.
    pub name: String,
    /// Where the repaired motion was written.
    pub output: Option<String>,
    /// How it ended.
    pub outcome: Outcome,
    /// Why it failed; null if it did not.
    pub failure: Option<String>,
    /// The source, measured.
    pub before: Option<MotionScore>,
    /// The result, measured.
    pub after: Option<MotionScore>,
    /// Measures that kept the repair from going further.
    pub held_back_by: Vec<Worse>,
    /// What was done; null for a failure.
    pub change: Option<Change>,
    /// What a reader of the figures should know: conversions, guesses, things left out.
    pub notes: Vec<String>,
    /// How long it took, in seconds.
    pub took_s: f64,
}

/// How much a motion was changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Change {
    /// Frames that were changed, in per cent.
    pub frames_percent: f64,
    /// Mean turn of a joint, in degrees, over all joints and frames.
    pub mean_turn_degrees: f64,
    /// Greatest turn of a joint, in degrees.
    pub greatest_turn_degrees: f64,
    /// Mean displacement of the root, in centimetres.
    pub mean_displacement_cm: f64,
    /// Frames in which a hand touches the body on purpose, as far as can be seen.
    pub touching_frames: usize,
    /// Rounds of descent and measurement.
    pub rounds: usize,
}

impl RepairedMotion {
    /// Why a motion was not repaired.
    pub fn failed(file: String, name: String, reason: String) -> Self {
        Self {
            file,
            name,
            output: None,
            outcome: Outcome::Failed,
            failure: Some(reason),
            before: None,
            after: None,
            held_back_by: Vec::new(),
            change: None,
            notes: Vec::new(),
            took_s: 0.0,
        }
    }

    /// What a repair did, which took so many seconds.
    pub fn of(file: String, name: String, repaired: &Repaired, took_s: f64) -> Self {
        Self {
            outcome: repaired.outcome,
            before: Some(repaired.before.clone()),
            after: Some(repaired.after.clone()),
            held_back_by: repaired.held_back_by.clone(),
            change: Some(repaired.change),
            took_s,
            failure: None,
            ..Self::failed(file, name, String::new())
        }
    }
}
