//! What `score` says of many motions: the stable contract of `--json` and `--csv`.

use physique_body::Body;
use schemars::JsonSchema;
use serde::Serialize;

use crate::physics_score::PhysicsScore;
use crate::{MotionScore, Protocol};

/// Name and version of the JSON that [`Report`] becomes. The number grows when a field changes its
/// meaning or goes away; new fields may come without.
pub const SCHEMA: &str = "physique.score/1";

/// Scores of many motions on one body.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Report {
    /// Name and version of this format: `physique.score/1`.
    pub schema: &'static str,
    /// Version of Physique that measured.
    pub physique_version: &'static str,
    /// Which definition of the measures.
    pub protocol: Protocol,
    /// The body that was scored.
    pub body: BodyDescription,
    /// One entry a motion, in the order asked for.
    pub motions: Vec<MotionReport>,
}

impl Report {
    /// A report that says what measured, on what.
    pub fn new(protocol: Protocol, body: &Body, motions: Vec<MotionReport>) -> Self {
        Self {
            schema: SCHEMA,
            physique_version: env!("CARGO_PKG_VERSION"),
            protocol,
            body: BodyDescription::of(body),
            motions,
        }
    }
}

/// Which body was scored.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BodyDescription {
    /// Name of the model.
    pub model: String,
    /// Stature in metres.
    pub stature_m: f64,
    /// Mass in kilograms.
    pub mass_kg: f64,
    /// Shape coefficients; missing ones are 0.
    pub betas: Vec<f32>,
}

impl BodyDescription {
    /// Describes a body.
    pub fn of(body: &Body) -> Self {
        Self {
            model: body.model().name().to_owned(),
            stature_m: body.stature(),
            mass_kg: body.mass(),
            betas: body.betas().to_vec(),
        }
    }
}

/// The score of one motion, or why there is none.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MotionReport {
    /// The file, or the name of an embedded clip.
    pub file: String,
    /// What was measured; null if the motion could not be scored.
    pub score: Option<MotionScore>,
    /// Why there is no score; null if there is one.
    pub unscorable: Option<String>,
    /// How the motion was brought to the body; null for motions of the body itself.
    pub mapping: Option<MappingSummary>,
    /// What a reader of the figures should know: conversions, guesses, things left out.
    pub notes: Vec<String>,
}

/// How well a foreign skeleton's motion fits the body's 22 joints.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
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

/// Every measure by name, for tables, conditions and `--csv`; those not measured are left out.
///
/// Names end in their unit.
pub fn measures(score: &MotionScore) -> Vec<(&'static str, f64)> {
    let mut measures = vec![
        ("frames", score.frames as f64),
        ("frame_rate_fps", score.frame_rate_fps),
        ("duration_s", score.duration_s),
    ];
    if let Some(found) = &score.self_intersection {
        measures.extend([
            ("self_intersection_mean_cm3", found.mean_cm3),
            (
                "self_intersection_mean_percent_of_body",
                found.mean_percent_of_body,
            ),
            ("self_intersection_worst_cm3", found.worst_cm3),
            ("self_intersection_worst_s", found.worst_s),
            (
                "self_intersection_frames_above_50_cm3_percent",
                found.frames_above_50_cm3_percent,
            ),
            ("crease_mean_cm3", found.crease_mean_cm3),
        ]);
    }
    if let Some(found) = &score.physics {
        measures.extend(found.measures());
    }
    if let Some(found) = &score.sia {
        measures.extend([
            ("sia_self_intersection_cm3", found.self_intersection_cm3),
            ("sia_volume_cm3", found.volume_cm3),
            (
                "sia_self_intersection_percent",
                found.self_intersection_percent,
            ),
        ]);
    }
    measures
}

/// Names of all measures of a protocol, in the order of [`measures`].
pub fn measure_names(protocol: Protocol) -> Vec<&'static str> {
    let mut names = vec!["frames", "frame_rate_fps", "duration_s"];
    match protocol {
        Protocol::Native => {
            names.extend([
                "self_intersection_mean_cm3",
                "self_intersection_mean_percent_of_body",
                "self_intersection_worst_cm3",
                "self_intersection_worst_s",
                "self_intersection_frames_above_50_cm3_percent",
                "crease_mean_cm3",
            ]);
            names.extend(PhysicsScore::NAMES);
        }
        Protocol::Sia => names.extend([
            "sia_self_intersection_cm3",
            "sia_volume_cm3",
            "sia_self_intersection_percent",
        ]),
    }
    names
}
