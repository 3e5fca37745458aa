//! What is told about files: the data behind `physique inspect --json`.

use schemars::JsonSchema;
use serde::Serialize;

use super::{BodyInspection, JointRange, Movement, SourceInspection};
use crate::Error;
use crate::defects::Defect;
use crate::load::Loaded;
use crate::report::MappingSummary;

/// Name and version of the JSON that [`InspectReport`] becomes. The number grows when a field
/// changes its meaning or goes away; new fields may come without.
pub const SCHEMA: &str = "physique.inspect/1";

/// What files hold.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct InspectReport {
    /// Name and version of this format: `physique.inspect/1`.
    pub schema: &'static str,
    /// Version of Physique that looked.
    pub physique_version: &'static str,
    /// One entry a file, in the order asked for.
    pub files: Vec<FileInspection>,
}

impl InspectReport {
    /// A report that says what looked.
    pub const fn new(files: Vec<FileInspection>) -> Self {
        Self {
            schema: SCHEMA,
            physique_version: env!("CARGO_PKG_VERSION"),
            files,
        }
    }
}

/// What a file holds.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FileInspection {
    /// The file.
    pub file: String,
    /// Its size; null where it cannot be read.
    pub bytes: Option<u64>,
    /// The motions in it.
    pub motions: Vec<MotionInspection>,
    /// The body model in it; null for files of motions.
    pub body: Option<BodyInspection>,
    /// Why nothing could be read; null where something could.
    pub unreadable: Option<String>,
}

/// What a motion is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct MotionInspection {
    /// The file's name, with `#` and a number or key where it holds several.
    pub name: String,
    /// What it shows, where the file says.
    pub text: Option<String>,
    /// Kind of file, in words; null where it could not be read.
    pub format: Option<&'static str>,
    /// Frames, those left out while loading excepted.
    pub frames: usize,
    /// Frames a second, as stated or taken for granted.
    pub frame_rate_fps: f64,
    /// From the first frame to the end of the last.
    pub seconds: f64,
    /// Stature of the person recorded, as the length of the legs has it; null where unknown.
    pub stature_m: Option<f64>,
    /// What the file holds before it is brought to the body; null where it could not be read.
    pub source: Option<SourceInspection>,
    /// How well the body follows; null for motions of the body itself.
    pub fit: Option<MappingSummary>,
    /// Where the person goes; null without frames.
    pub movement: Option<Movement>,
    /// Largest downward acceleration of the whole body that lasts a fifth of a second and comes at
    /// least twice, over that of gravity. Above 1 by far, the frame rate is wrong; below, it tells
    /// nothing. Null for short clips.
    pub hardest_fall_g: Option<f64>,
    /// How far each joint turns.
    pub range_of_motion: Vec<JointRange>,
    /// What looks wrong.
    pub warnings: Vec<Warning>,
    /// What was converted, guessed or left out: full sentences.
    pub notes: Vec<String>,
}

impl MotionInspection {
    /// One that could not be read.
    pub(super) fn unreadable(name: String, problem: &Error) -> Self {
        Self {
            name,
            warnings: vec![Warning::from(Defect::of_error(problem))],
            ..Self::default()
        }
    }
}

/// Something that looks wrong; it may be right all the same.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Warning {
    /// What kind of thing: the names of [`crate::defects::DefectKind`], and `t-pose`, `sides`,
    /// `ground-height`, `uneven-ground`, `in-between-frames`, `beyond-human-range`.
    pub kind: &'static str,
    /// What was found, how much and when: a full sentence.
    pub message: String,
    /// When it begins or is worst; null for the clip as a whole.
    pub at_s: Option<f64>,
}

impl Warning {
    /// A warning about the clip as a whole.
    pub(super) const fn new(kind: &'static str, message: String) -> Self {
        Self {
            kind,
            message,
            at_s: None,
        }
    }
}

impl From<Defect> for Warning {
    fn from(defect: Defect) -> Self {
        Self {
            kind: defect.kind.name(),
            message: defect.message,
            at_s: defect.at_s,
        }
    }
}

/// What looked wrong while the motion was brought to the body.
pub(super) fn of_mapping(loaded: &Loaded) -> Vec<Warning> {
    /// The ground may lie so far from height 0 in the file, in metres.
    const GROUND: f32 = 0.1;
    let Some(mapping) = &loaded.mapping else {
        return Vec::new();
    };
    let mut warnings = Vec::new();
    if mapping.dropped_frames > 0 {
        let left_out = match mapping.dropped_frames {
            1 => "it is left out".to_owned(),
            frames => format!("{frames} frames are left out"),
        };
        let message = "The first frame is a T-pose that is no part of the motion";
        warnings.push(Warning::new("t-pose", format!("{message}: {left_out}.")));
    }
    if let Some(note) = mapping.notes.iter().find(|note| note.contains("exchanged")) {
        warnings.push(Warning::new("sides", format!("{note}.")));
    }
    if mapping.ground.abs() > GROUND {
        let centimetres = 100.0 * mapping.ground;
        warnings.push(Warning::new(
            "ground-height",
            format!("The soles stand at a height of {centimetres:.0} cm in the file, not at 0."),
        ));
    }
    warnings
}
