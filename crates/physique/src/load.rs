//! From a file of any supported format to a motion of a given body.

use std::path::Path;

use physique_body::{Body, Joint};
use physique_motion::mapping::{BodyRest, Mapped, MappingOptions, MappingReport, map_to_body};
use physique_motion::{Motion, ReadOptions, Recording, SkeletonClip, SourceMotion, read_motion};

use crate::Error;
use crate::report::MappingSummary;

/// How files are read and brought to the body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadOptions {
    /// Limits, and what files may not say.
    pub read: ReadOptions,
    /// How foreign skeletons are mapped.
    pub mapping: MappingOptions,
}

/// A motion of a given body, and how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The motion on the body's 22 joints.
    pub motion: Motion,
    /// How a foreign skeleton was mapped; `None` for motions of a body.
    pub mapping: Option<MappingReport>,
    /// What was converted, guessed or left out: full sentences.
    pub notes: Vec<String>,
}

impl Loaded {
    /// The mapping in a few figures.
    pub fn mapping_summary(&self) -> Option<MappingSummary> {
        self.mapping.as_ref().map(|report| {
            let error = report.fit_error.all;
            MappingSummary {
                skeleton: report.found_by.to_string(),
                mean_error_cm: f64::from(error.mean_cm),
                p95_error_cm: f64::from(error.percentile_95_cm),
                worst_error_cm: f64::from(error.max_cm),
            }
        })
    }
}

/// Reads a motion file and brings it to the body: foreign skeletons are mapped, motions of other
/// bodies keep their pelvis where it was.
///
/// # Errors
/// [`Error::Motion`] with file and place for what cannot be read or is not human.
pub fn load(path: &Path, body: &Body, options: &LoadOptions) -> Result<Loaded, Error> {
    match read_motion(path, &options.read)? {
        SourceMotion::Skeleton(clip) => load_clip(&clip, body, options),
        SourceMotion::Body(recording) => load_recording(recording, body),
    }
}

/// Maps a clip of any humanoid skeleton to the body.
///
/// # Errors
/// [`Error::Motion`] for a skeleton that is not human or a clip without frames.
pub fn load_clip(clip: &SkeletonClip, body: &Body, options: &LoadOptions) -> Result<Loaded, Error> {
    let Mapped { motion, report } = map_to_body(clip, &BodyRest::from(body), &options.mapping)?;
    Ok(Loaded {
        motion,
        notes: report.notes.clone(),
        mapping: Some(report),
    })
}

/// Puts a recording of another body onto this one: rotations and the pelvis's path stay as they
/// are, so that longer or shorter legs than the recorded person's sink or float by the difference.
///
/// # Errors
/// None today; the type leaves room for shapes that cannot be carried over.
pub fn load_recording(recording: Recording, body: &Body) -> Result<Loaded, Error> {
    let shift = recording.rest_pelvis - body.rest_joint(Joint::Pelvis);
    let motion = recording.motion;
    let root_translation = motion
        .root_translation()
        .iter()
        .map(|t| *t + shift)
        .collect();
    let motion = Motion::new(
        motion.frame_rate(),
        motion.shape().cloned(),
        root_translation,
        motion.rotations().to_vec(),
    )?;
    Ok(Loaded {
        motion,
        mapping: None,
        notes: recording.notes,
    })
}
