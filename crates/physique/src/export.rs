//! From a motion of a body to a file of any format that is written.

mod format;

pub use format::ExportFormat;

use std::path::Path;

use physique_body::{Body, Joint};
use physique_motion::bvh::{self, BvhWriteOptions, LengthUnit};
use physique_motion::features::{self, FeatureSkeleton, JointPositions};
use physique_motion::glb::{self, SkinnedMesh};
use physique_motion::mapping::BodyRest;
use physique_motion::{FrameRate, Motion, Recording, SkeletonClip, UpAxis, amass, csv, native};

use crate::Error;

/// How a file is written.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportOptions {
    /// The format.
    pub format: ExportFormat,
    /// Frame rate of the file; otherwise [`ExportFormat::frame_rate`], or else the motion's.
    pub frame_rate: Option<FrameRate>,
    /// Axis that points up in a BVH file.
    pub up_axis: UpAxis,
    /// Length unit of a BVH file.
    pub unit: LengthUnit,
}

impl ExportOptions {
    /// A format as its readers expect it: BVH in centimetres, Y up.
    pub const fn new(format: ExportFormat) -> Self {
        Self {
            format,
            frame_rate: None,
            up_axis: UpAxis::Y,
            unit: LengthUnit::Centimetre,
        }
    }
}

/// What a file says about a motion, where its format has room for it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Provenance {
    /// What to call the motion.
    pub name: String,
    /// Where it comes from.
    pub source: Option<String>,
    /// What happened to it on the way: full sentences.
    pub notes: Vec<String>,
}

/// Writes a motion of a body, beside the file first, then renamed.
///
/// Returns what was changed and what the format could not carry: full sentences.
///
/// # Errors
/// [`Error::Motion`]: the file system's, motions without frames, and what the format cannot hold.
pub fn export(
    path: &Path,
    motion: &Motion,
    body: &Body,
    provenance: Provenance,
    options: &ExportOptions,
) -> Result<Vec<String>, Error> {
    let mut notes = Vec::new();
    let resampled = resampled(motion, options, &mut notes)?;
    let motion = resampled.as_ref().unwrap_or(motion);
    let rest = BodyRest::from(body);
    let rest_pelvis = body.rest_joint(Joint::Pelvis);
    let positions = || JointPositions::from_motion(motion, &rest);
    match options.format {
        ExportFormat::Bvh => {
            let clip = SkeletonClip::from_motion(motion, &rest)?;
            let options = BvhWriteOptions {
                unit: options.unit,
                up_axis: options.up_axis,
            };
            bvh::write_clip(path, &clip, &options)?;
        }
        ExportFormat::Amass => notes.extend(amass::write(path, motion, Some(rest_pelvis))?),
        ExportFormat::Glb => glb::write(path, &SkinnedMesh::of(body), motion)?,
        ExportFormat::Native => {
            let recording = Recording {
                name: provenance.name,
                motion: motion.clone(),
                rest_pelvis,
                source: provenance.source,
                licence: None,
                notes: provenance.notes,
            };
            native::write(path, &recording)?;
        }
        ExportFormat::HumanMl3d => {
            features::write_features(path, &extract(&positions()?)?)?;
        }
        ExportFormat::Kit => {
            features::write_features(path, &extract(&positions()?.to_kit_joints()?)?)?;
        }
        ExportFormat::Positions => features::write_positions(path, &positions()?)?,
        ExportFormat::PositionCsv => {
            csv::write_positions(path, &positions()?)?;
        }
        ExportFormat::RotationCsv => csv::write_rotations(path, motion, rest_pelvis)?,
    }
    Ok(notes)
}

/// The motion at the rate of the file, if that is another; a note says so.
fn resampled(
    motion: &Motion,
    options: &ExportOptions,
    notes: &mut Vec<String>,
) -> Result<Option<Motion>, Error> {
    let format = options.format;
    let from = motion.frame_rate().per_second();
    let own = format.frame_rate();
    let to = options
        .frame_rate
        .map_or(own, |rate| Some(rate.per_second()));
    let to = to.unwrap_or(from);
    if let Some(own) = own
        && (to - own).abs() > 1e-6 * own
    {
        notes.push(format!(
            "{} files do not state their rate: readers take them for {own} fps, this one has {to} fps",
            format.name()
        ));
    }
    if (to - from).abs() <= 1e-6 * from {
        return Ok(None);
    }
    notes.push(format!(
        "resampled from {} to {} fps by spherical interpolation",
        rounded(from),
        rounded(to)
    ));
    Ok(Some(motion.resampled(FrameRate::new(to)?)?))
}

/// A rate as people write it.
fn rounded(rate: f64) -> f64 {
    (rate * 1000.0).round() / 1000.0
}

fn extract(positions: &JointPositions) -> Result<features::MotionFeatures, Error> {
    if positions.frame_count() < 2 {
        let format = match positions.skeleton() {
            FeatureSkeleton::HumanMl3d => ExportFormat::HumanMl3d,
            FeatureSkeleton::Kit => ExportFormat::Kit,
        };
        let rate = rounded(positions.frame_rate().per_second());
        return Err(Error::Motion(physique_motion::Error::Unwritable {
            format: format.name(),
            reason: format!(
                "a row of features is a step, and at {rate} fps there is one frame only"
            ),
        }));
    }
    Ok(features::extract(positions)?)
}
