//! From a file of any supported format to motions of a given body.

use std::path::Path;

use physique_body::{Body, Joint};
use physique_motion::inverse_kinematics::{
    IkOptions, IkSolution, are_directions_of, are_joints_of, solve, solve_by_paper_layer,
};
use physique_motion::mapping::{
    BodyRest, FitError, Mapped, MappingOptions, MappingReport, map_to_body,
};
use physique_motion::{
    Motion, NamedMotion, PositionClip, ReadOptions, Recording, SkeletonClip, SourceMotion,
    read_each, read_motions,
};

use crate::Error;
use crate::report::MappingSummary;

/// How files are read and brought to the body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadOptions {
    /// Limits, and what files may not say.
    pub read: ReadOptions,
    /// How foreign skeletons are mapped.
    pub mapping: MappingOptions,
    /// How motions known by their joints' positions get rotations.
    pub rotations: RotationsFrom,
    /// What inverse kinematics takes for granted.
    pub inverse_kinematics: IkOptions,
}

/// How joint positions become rotations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RotationsFrom {
    /// [`physique_motion::inverse_kinematics`]: joints are met, the pelvis keeps its tilt.
    #[default]
    InverseKinematics,
    /// [`physique_motion::features::RotationLayer`], the self-intersection paper's own layer, for comparison with its
    /// figures: heading only, no twist, joints are missed by some 10 cm.
    PaperLayer,
}

/// A motion of a given body, and how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The file's name, with `#` and a number or key where it holds several: `results.npy#3`.
    pub name: String,
    /// What the motion shows, where the file says: the prompt of a generator.
    pub text: Option<String>,
    /// The motion on the body's 22 joints.
    pub motion: Motion,
    /// How a foreign skeleton was mapped; `None` for motions of a body or of positions.
    pub mapping: Option<MappingReport>,
    /// How rotations were found from joint positions; `None` for files that hold rotations.
    pub inverse_kinematics: Option<PositionFit>,
    /// What was converted, guessed or left out: full sentences.
    pub notes: Vec<String>,
}

/// How well rotations found from positions meet them.
#[derive(Clone, Debug, PartialEq)]
pub struct PositionFit {
    /// By which way, in words.
    pub method: &'static str,
    /// Distances of the posed joints from the positions, in centimetres of the body.
    pub fit: FitError,
    /// From the positions' unit to the body's metres.
    pub scale: f32,
}

impl Loaded {
    /// The mapping or the inverse kinematics in a few figures; `None` for motions of a body.
    pub fn mapping_summary(&self) -> Option<MappingSummary> {
        let (skeleton, fit) = match (&self.mapping, &self.inverse_kinematics) {
            (Some(report), _) => (report.found_by.to_string(), &report.fit_error),
            (None, Some(found)) => (found.method.to_owned(), &found.fit),
            (None, None) => return None,
        };
        Some(MappingSummary {
            skeleton,
            mean_error_cm: f64::from(fit.all.mean_cm),
            p95_error_cm: f64::from(fit.all.percentile_95_cm),
            worst_error_cm: f64::from(fit.all.max_cm),
        })
    }
}

/// Reads all motions of a file and brings them to the body: foreign skeletons are mapped, motions
/// of other bodies keep their pelvis where it was, positions get rotations.
///
/// # Errors
/// [`Error::Motion`] with file and place for what cannot be read or is not human; the first
/// broken motion is the error of all, where [`load_each`] goes on.
pub fn load_all(path: &Path, body: &Body, options: &LoadOptions) -> Result<Vec<Loaded>, Error> {
    let motions = read_motions(path, &options.read)?;
    let loaded = motions
        .into_iter()
        .map(|motion| load_motion(motion, body, options));
    loaded.collect()
}

/// As [`load_all`], but every motion comes by its name with its own error.
///
/// # Errors
/// [`Error::Motion`] for a file that cannot be read at all.
#[allow(clippy::type_complexity)] // A list of results with their names.
pub fn load_each(
    path: &Path,
    body: &Body,
    options: &LoadOptions,
) -> Result<Vec<(String, Result<Loaded, Error>)>, Error> {
    let motions = read_each(path, &options.read)?.into_iter();
    let loaded = motions.map(|(name, motion)| {
        let loaded = motion.map_err(Error::from);
        (
            name,
            loaded.and_then(|motion| load_motion(motion, body, options)),
        )
    });
    Ok(loaded.collect())
}

/// Reads a file that holds exactly one motion, or one of many by its number (`results.npy#3`), and
/// brings it to the body.
///
/// # Errors
/// As [`load_all`]; a file of several is an error that says how to name one.
pub fn load(path: &Path, body: &Body, options: &LoadOptions) -> Result<Loaded, Error> {
    let mut loaded = load_all(path, body, options)?;
    match (loaded.pop(), loaded.len()) {
        (Some(only), 0) => Ok(only),
        (last, others) => Err(Error::from(physique_motion::Error::ManyMotions {
            path: path.into(),
            found: others + usize::from(last.is_some()),
        })),
    }
}

/// Brings a motion of any kind to the body.
///
/// # Errors
/// [`Error::Motion`] for a skeleton that is not human or positions without bones.
pub fn load_motion(
    motion: NamedMotion,
    body: &Body,
    options: &LoadOptions,
) -> Result<Loaded, Error> {
    let loaded = match motion.motion {
        SourceMotion::Skeleton(clip) => load_clip(&clip, body, options)?,
        SourceMotion::Body(recording) => load_recording(recording, body)?,
        SourceMotion::Positions(clip) => load_positions(&clip, body, options)?,
    };
    Ok(Loaded {
        name: motion.name,
        text: motion.text,
        ..loaded
    })
}

/// Maps a clip of any humanoid skeleton to the body.
///
/// # Errors
/// [`Error::Motion`] for a skeleton that is not human or a clip without frames.
pub fn load_clip(clip: &SkeletonClip, body: &Body, options: &LoadOptions) -> Result<Loaded, Error> {
    let Mapped { motion, report } = map_to_body(clip, &BodyRest::from(body), &options.mapping)?;
    Ok(Loaded {
        name: String::new(),
        text: None,
        motion,
        notes: report.notes.clone(),
        mapping: Some(report),
        inverse_kinematics: None,
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
        name: recording.name,
        text: None,
        motion,
        mapping: None,
        inverse_kinematics: None,
        notes: recording.notes,
    })
}

/// Finds the body's rotations from joint positions.
///
/// # Errors
/// [`Error::Motion`] for a bone that has no length in most frames.
pub fn load_positions(
    clip: &PositionClip,
    body: &Body,
    options: &LoadOptions,
) -> Result<Loaded, Error> {
    let rest = BodyRest::from(body);
    let mut notes = clip.notes.clone();
    let mut ik = options.inverse_kinematics.clone();
    if ik.rest_directions.is_none() {
        let own = IkOptions::for_joints_of(&rest).rest_directions;
        if are_joints_of(&clip.positions, &rest) {
            (ik.rest_directions, ik.soles_on_ground) = (own, false);
            notes.push("The bones are this body's own: it stands where the positions say.".into());
        } else if are_directions_of(&clip.positions, &rest) {
            ik.rest_directions = own;
            notes.push("The bones lie at rest as this body's own do.".into());
        }
    }
    let (method, solution) = match options.rotations {
        RotationsFrom::InverseKinematics => {
            let solution = solve(&clip.positions, &rest, &ik)?;
            ("joint positions, by inverse kinematics", solution)
        }
        RotationsFrom::PaperLayer => {
            let solution = solve_by_paper_layer(&clip.positions, &rest, ik.soles_on_ground)?;
            ("joint positions, by the paper's layer", solution)
        }
    };
    let IkSolution { motion, fit, scale } = solution;
    Ok(Loaded {
        name: String::new(),
        text: None,
        motion,
        mapping: None,
        inverse_kinematics: Some(PositionFit { method, fit, scale }),
        notes,
    })
}
