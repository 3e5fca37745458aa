//! What a file holds, before anything is made of it: format, skeleton, rate, units, sides, how far
//! joints turn, who moves where, and what looks wrong.
//!
//! [`Inspector::file`] looks at motions and bodies alike. Everything about a motion is measured
//! on the body that it is mapped to, and told in the lengths of the person recorded.

mod body_file;
mod human_range;
mod movement;
mod range_of_motion;
mod rate;
mod report;
mod source;

pub use body_file::BodyInspection;
pub use movement::Movement;
pub use range_of_motion::{AxisRange, JointRange};
pub use report::{FileInspection, InspectReport, MotionInspection, SCHEMA, Warning};
pub use source::{JointMatch, SourceInspection};

use std::path::Path;

use physique_body::Body;
use physique_motion::features::JointPositions;
use physique_motion::mapping::BodyRest;
use physique_motion::{NamedMotion, read_each};

use crate::Error;
use crate::defects::{Defect, DefectFinder, DefectLimits};
use crate::load::{LoadOptions, load_motion};

/// Looks at files, motions on one body.
#[derive(Clone, Debug)]
pub struct Inspector {
    body: Body,
    rest: BodyRest,
    stature: f64,
    options: LoadOptions,
    defects: DefectFinder,
}

impl Inspector {
    /// Prepares a body: a tenth of a second, once.
    ///
    /// # Errors
    /// [`Error::Physics`] for a body without inside or feet.
    pub fn new(body: &Body, options: LoadOptions) -> Result<Self, Error> {
        Ok(Self {
            rest: BodyRest::from(body),
            stature: body.stature(),
            defects: DefectFinder::new(body, DefectLimits::default())?,
            body: body.clone(),
            options,
        })
    }

    /// All there is to say about a file. What cannot be read is told in it, not an error.
    ///
    /// Costs about 0.2 ms a frame on one core.
    pub fn file(&self, path: &Path) -> FileInspection {
        let bytes = std::fs::metadata(path).ok().map(|file| file.len());
        let mut found = FileInspection {
            file: path.display().to_string(),
            bytes,
            motions: Vec::new(),
            body: None,
            unreadable: None,
        };
        match read_each(path, &self.options.read) {
            Ok(motions) => {
                let motions = motions.into_iter().map(|(name, motion)| match motion {
                    Ok(motion) => self.motion(motion),
                    Err(problem) => MotionInspection::unreadable(name, &Error::from(problem)),
                });
                found.motions = motions.collect();
            }
            // What is no motion may be a body.
            Err(problem) => match body_file::inspect(path, &problem) {
                Some(body) => found.body = Some(body),
                None => found.unreadable = Some(problem.to_string()),
            },
        }
        found
    }

    /// All there is to say about a motion.
    pub fn motion(&self, motion: NamedMotion) -> MotionInspection {
        let source = SourceInspection::of(&motion);
        let mut found = MotionInspection {
            name: motion.name.clone(),
            text: motion.text.clone(),
            format: Some(motion.format),
            ..MotionInspection::default()
        };
        match load_motion(motion, &self.body, &self.options) {
            Ok(loaded) => {
                if let Err(problem) = self.measure(&loaded, &mut found) {
                    found
                        .warnings
                        .push(Warning::from(Defect::of_error(&problem)));
                }
                found.source = Some(source.mapped(&loaded));
            }
            Err(problem) => {
                found
                    .warnings
                    .push(Warning::from(Defect::of_error(&problem)));
                found.source = Some(source);
            }
        }
        found
    }

    /// Everything that is measured on the body.
    fn measure(
        &self,
        loaded: &crate::load::Loaded,
        found: &mut MotionInspection,
    ) -> Result<(), Error> {
        let motion = &loaded.motion;
        let scale = [
            loaded.mapping.as_ref().map(|mapping| mapping.scale),
            loaded.inverse_kinematics.as_ref().map(|fit| fit.scale),
        ];
        let scale = f64::from(scale.into_iter().flatten().next().unwrap_or(1.0));
        found.frames = motion.frame_count();
        found.frame_rate_fps = motion.frame_rate().per_second();
        found.seconds = motion.seconds();
        found.stature_m = Some(self.stature / scale);
        found.fit = loaded.mapping_summary();
        found.notes.clone_from(&loaded.notes);
        found.range_of_motion = range_of_motion::of(motion);
        let defects = self.defects.find(motion)?;
        found.warnings.extend(report::of_mapping(loaded));
        found
            .warnings
            .extend(defects.into_iter().map(Warning::from));
        if motion.frame_count() > 0 {
            let positions = JointPositions::from_motion(motion, &self.rest)?;
            let movement = Movement::of(&positions, scale);
            found.warnings.extend(movement.warnings());
            found.movement = Some(movement);
            let rate = rate::RateEvidence::of(motion, &positions, scale);
            found.hardest_fall_g = rate.hardest_fall_g;
            found.warnings.extend(rate.warnings());
        }
        found
            .warnings
            .extend(range_of_motion::warnings(&found.range_of_motion));
        Ok(())
    }
}
