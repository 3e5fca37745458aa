//! What a file holds before it is brought to the body.

use physique_body::Joint;
use physique_motion::features::FeatureSkeleton;
use physique_motion::{NamedMotion, SourceMotion, UpAxis};
use schemars::JsonSchema;
use serde::Serialize;

use crate::load::Loaded;

/// Skeleton, unit and axes of a motion as its file has them.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SourceInspection {
    /// What moves: `skeleton`, `body` (22 rotations) or `positions`.
    pub holds: &'static str,
    /// Joints of the file.
    pub joints: usize,
    /// Whose names or shape the joints have; null before they are matched.
    pub matched_by: Option<String>,
    /// How the meaning of the joints' axes was found; null where it is known.
    pub aligned_by: Option<String>,
    /// Metres in one unit of the file; null where the format leaves it open.
    pub metres_per_unit: Option<f64>,
    /// `Y` or `Z`.
    pub up_axis: &'static str,
    /// The body's joints and the file's that they follow.
    pub matches: Vec<JointMatch>,
    /// Joints of the file that no joint of the body follows.
    pub unmatched: Vec<String>,
    /// All names, to tell what is unmatched.
    #[serde(skip)]
    names: Vec<String>,
}

/// A joint of the body and what it follows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct JointMatch {
    /// SMPL's name.
    pub joint: &'static str,
    /// The file's names: several where a chain is resampled, none where nothing matches.
    pub source: Vec<String>,
}

impl SourceInspection {
    pub(super) fn of(motion: &NamedMotion) -> Self {
        let (holds, names, metres_per_unit, up) = match &motion.motion {
            SourceMotion::Skeleton(clip) => {
                let joints = clip.skeleton().joints().iter();
                let names = joints.map(|joint| joint.name.clone()).collect();
                let conversion = clip.conversion();
                let metres = Some(conversion.metres_per_unit);
                ("skeleton", names, metres, conversion.up_axis)
            }
            SourceMotion::Body(_) => {
                let up = if motion.format.contains("AMASS") {
                    UpAxis::Z
                } else {
                    UpAxis::Y
                };
                ("body", own_names(FeatureSkeleton::HumanMl3d), Some(1.0), up)
            }
            SourceMotion::Positions(clip) => {
                let skeleton = clip.positions.skeleton();
                let is_metric = skeleton == FeatureSkeleton::HumanMl3d;
                let names = own_names(skeleton);
                ("positions", names, is_metric.then_some(1.0), UpAxis::Y)
            }
        };
        Self {
            holds,
            joints: names.len(),
            matched_by: None,
            aligned_by: None,
            metres_per_unit,
            up_axis: match up {
                UpAxis::Y => "Y",
                UpAxis::Z => "Z",
            },
            matches: Vec::new(),
            unmatched: Vec::new(),
            names,
        }
    }

    /// The same with what loading found out.
    pub(super) fn mapped(mut self, loaded: &Loaded) -> Self {
        let Some(report) = &loaded.mapping else {
            return self;
        };
        self.matched_by = Some(report.found_by.to_string());
        self.aligned_by = Some(report.aligned_by.to_string());
        self.matches = report
            .joints
            .iter()
            .map(|joint| JointMatch {
                joint: joint.joint.name(),
                source: joint.source.clone(),
            })
            .collect();
        let matched = |name: &String| self.matches.iter().any(|m| m.source.contains(name));
        self.unmatched = self
            .names
            .iter()
            .filter(|name| !matched(name))
            .cloned()
            .collect();
        self
    }
}

fn own_names(skeleton: FeatureSkeleton) -> Vec<String> {
    let names = (0..skeleton.joint_count()).map(|joint| skeleton.joint_name(joint));
    names
        .map(|name| name.unwrap_or(Joint::Pelvis.name()).to_owned())
        .collect()
}
