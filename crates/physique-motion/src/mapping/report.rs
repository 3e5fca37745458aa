//! What matched what.

use std::fmt;

use physique_body::Joint;

use super::{
    alignment::AlignedBy,
    find::{Found, FoundBy},
    fit_error::FitError,
    retarget::Outcome,
};
use crate::SkeletonClip;

/// The source of one body joint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointSource {
    /// The body's joint.
    pub joint: Joint,
    /// Names of the source's joints it follows: several where a chain is resampled, none where
    /// it stays at rest or follows its parent.
    pub source: Vec<String>,
}

/// How a clip was mapped to the body, and how well. `{}` prints it for people.
#[derive(Clone, Debug, PartialEq)]
pub struct MappingReport {
    /// How the joints were found.
    pub found_by: FoundBy,
    /// How the meaning of the joints' axes was found.
    pub aligned_by: AlignedBy,
    /// All 22 joints of the body with their sources.
    pub joints: Vec<JointSource>,
    /// Length of the body's legs over the source's: the path is scaled by it.
    pub scale: f32,
    /// Height of the source's ground in its own world that became height 0, in metres.
    pub ground: f32,
    /// Frames dropped at the start: a T-pose that is no part of the motion.
    pub dropped_frames: usize,
    /// Distances between the scaled source and the result.
    pub fit_error: FitError,
    /// Largest turn of a thigh or shin by which feet were kept in place, in degrees.
    pub largest_leg_correction_degrees: f32,
    /// What the reader inferred, what is missing, what looks wrong: a sentence each.
    pub notes: Vec<String>,
}

impl MappingReport {
    pub(super) fn new(
        clip: &SkeletonClip,
        found: Found,
        outcome: &Outcome,
        dropped_frames: usize,
        remarks: Vec<String>,
    ) -> Self {
        let name = |joint: usize| clip.skeleton().joints()[joint].name.clone();
        let human = &found.joints;
        let joints: Vec<JointSource> = Joint::ALL
            .into_iter()
            .map(|joint| JointSource {
                joint,
                source: match joint {
                    Joint::Spine1 | Joint::Spine2 if human.spine.len() > 1 => human.spine
                        [..human.spine.len() - 1]
                        .iter()
                        .copied()
                        .map(name)
                        .collect(),
                    Joint::Spine1 | Joint::Spine2 => {
                        human.spine.iter().copied().map(name).collect()
                    }
                    Joint::Spine3 => human.spine.last().copied().map(name).into_iter().collect(),
                    Joint::Neck => human.neck.iter().copied().map(name).collect(),
                    _ => human.source_of(joint).map(name).into_iter().collect(),
                },
            })
            .collect();
        let mut notes = clip.conversion().notes.clone();
        notes.extend(remarks);
        notes.extend(outcome.notes.iter().cloned());
        if dropped_frames > 0 {
            notes.push(format!(
                "dropped {dropped_frames} frames at the start: a T-pose, or arms held as in one, \
                 that is no part of the motion, and the way out of it"
            ));
        }
        let without: Vec<&str> = joints
            .iter()
            .filter(|joint| joint.source.is_empty())
            .map(|joint| joint.joint.name())
            .collect();
        if !without.is_empty() {
            let without = without.join(", ");
            notes.push(format!(
                "without a source, so following their parents: {without}"
            ));
        }
        Self {
            found_by: found.by,
            aligned_by: outcome.aligned_by,
            joints,
            scale: outcome.scale,
            ground: outcome.ground,
            dropped_frames,
            fit_error: outcome.fit_error.clone(),
            largest_leg_correction_degrees: outcome.largest_leg_correction_degrees,
            notes,
        }
    }
}

impl fmt::Display for FoundBy {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Names { family } => write!(formatter, "{family} names"),
            Self::Shape => formatter.write_str("the shape of the tree"),
            Self::File { rest: None } => formatter.write_str("the mapping file"),
            Self::File { rest: Some(rest) } => write!(formatter, "the mapping file over {rest}"),
        }
    }
}

impl fmt::Display for AlignedBy {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::RestPose => "the rest pose",
            Self::FirstFrame => "the T-pose in the first frame",
            Self::KnownTPose => "the T-pose that is known of the rig",
            Self::Anatomy => "hinges, soles and sides over the clip",
        })
    }
}

impl fmt::Display for MappingReport {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "Joints by {}, axes by {}; legs x {:.3}.",
            self.found_by, self.aligned_by, self.scale
        )?;
        for joint in &self.joints {
            let source = if joint.source.is_empty() {
                "-".to_owned()
            } else {
                joint.source.join(" + ")
            };
            write!(formatter, "  {:<15} {source:<32}", joint.joint.name())?;
            let error = self
                .fit_error
                .by_joint
                .iter()
                .find(|(of, _)| *of == joint.joint);
            if let Some((_, distances)) = error {
                write!(
                    formatter,
                    " {:5.1} cm mean {:5.1} p95 {:5.1} max",
                    distances.mean_cm, distances.percentile_95_cm, distances.max_cm
                )?;
            }
            let mut angles = self.fit_error.by_limb.iter();
            if let Some((_, angles)) = angles.find(|(of, _)| *of == joint.joint) {
                write!(
                    formatter,
                    ", bone off by {:4.1}° mean {:4.1}° max",
                    angles.mean_degrees, angles.max_degrees
                )?;
            }
            writeln!(formatter)?;
        }
        for note in &self.notes {
            writeln!(formatter, "  {note}.")?;
        }
        Ok(())
    }
}
