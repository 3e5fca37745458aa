//! Measures of every frame, for charts and for finding the place.

use physique_physics::{FramePhysics, PhysicsMeasures, Support};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Group;
use crate::self_intersection::FrameIntersections;

/// Centimetres in a metre.
const CM: f64 = 100.0;

/// One value a frame; null where a frame has none. Measures of groups not asked for are null as a
/// whole.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Series {
    /// Time from the start of the clip, in seconds.
    pub time_s: Vec<f64>,
    /// Volume of parts inside other parts, in cm3.
    pub self_intersection_cm3: Option<Vec<f64>>,
    /// Volume of creases, in cm3.
    pub crease_cm3: Option<Vec<f64>>,
    /// Height of the lowest skin above the floor, in cm; negative in it.
    pub lowest_skin_cm: Option<Vec<f64>>,
    /// What carries the body.
    pub support: Option<Vec<SupportName>>,
    /// Mean horizontal speed of the sole points on the ground, in cm/s.
    pub slide_cm_s: Option<Vec<f64>>,
    /// Signed distance of the zero moment point to the base of support, in cm; negative inside.
    pub zero_moment_distance_cm: Option<Vec<Option<f64>>>,
    /// Margin of stability, in cm; positive inside.
    pub margin_of_stability_cm: Option<Vec<Option<f64>>>,
    /// Mean acceleration of the joints, in m/s2.
    pub acceleration_m_s2: Option<Vec<Option<f64>>>,
    /// Mean jerk of the joints, in m/s3.
    pub jerk_m_s3: Option<Vec<Option<f64>>>,
}

/// What carries the body in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SupportName {
    /// Slow skin touches the ground.
    Ground,
    /// The body falls freely.
    Flight,
    /// Nothing touches, yet the body does not fall.
    Nothing,
}

impl SupportName {
    /// The name by which reports call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ground => "ground",
            Self::Flight => "flight",
            Self::Nothing => "nothing",
        }
    }
}

impl From<Support> for SupportName {
    fn from(support: Support) -> Self {
        match support {
            Support::Ground => Self::Ground,
            Support::Flight => Self::Flight,
            Support::Nothing => Self::Nothing,
        }
    }
}

impl Series {
    pub(crate) fn new(frames: usize, frame_s: f64) -> Self {
        Self {
            time_s: (0..frames).map(|frame| frame as f64 * frame_s).collect(),
            ..Self::default()
        }
    }

    pub(crate) fn add_intersections(&mut self, frames: &[FrameIntersections]) {
        let volumes =
            |of: fn(&FrameIntersections) -> f64| Some(frames.iter().map(of).collect::<Vec<_>>());
        self.self_intersection_cm3 = volumes(|frame| frame.intersection_cm3);
        self.crease_cm3 = volumes(|frame| frame.crease_cm3);
    }

    pub(crate) fn add_physics(&mut self, found: &PhysicsMeasures, groups: &[Group]) {
        let frames = &found.frames;
        for group in groups {
            match group {
                Group::SelfIntersection => {}
                Group::Ground => {
                    self.lowest_skin_cm = all(frames, |frame| CM * frame.lowest_m);
                    self.support = all(frames, |frame| frame.support.into());
                }
                Group::Feet => self.slide_cm_s = all(frames, |frame| CM * frame.slide_m_s),
                Group::Balance => {
                    self.zero_moment_distance_cm =
                        all(frames, |frame| Some(CM * frame.zero_moment_distance_m?));
                    self.margin_of_stability_cm =
                        all(frames, |frame| Some(CM * frame.margin_of_stability_m?));
                }
                Group::Smoothness => {
                    self.acceleration_m_s2 =
                        all(frames, |frame| Some(frame.smoothness?.acceleration_m_s2));
                    self.jerk_m_s3 = all(frames, |frame| Some(frame.smoothness?.jerk_m_s3));
                }
            }
        }
    }

    /// Self-intersection of every frame, in cm3; empty where it was not measured.
    pub(crate) fn self_intersections(&self) -> &[f64] {
        self.self_intersection_cm3.as_deref().unwrap_or_default()
    }

    /// Names and values of the numbers a frame, those of other groups left out; `time_s` first.
    pub fn columns(&self) -> Vec<(&'static str, Vec<Option<f64>>)> {
        let full = |values: &Vec<f64>| values.iter().copied().map(Some).collect();
        let columns = [
            ("time_s", Some(full(&self.time_s))),
            (
                "self_intersection_cm3",
                self.self_intersection_cm3.as_ref().map(full),
            ),
            ("crease_cm3", self.crease_cm3.as_ref().map(full)),
            ("lowest_skin_cm", self.lowest_skin_cm.as_ref().map(full)),
            ("slide_cm_s", self.slide_cm_s.as_ref().map(full)),
            (
                "zero_moment_distance_cm",
                self.zero_moment_distance_cm.clone(),
            ),
            (
                "margin_of_stability_cm",
                self.margin_of_stability_cm.clone(),
            ),
            ("acceleration_m_s2", self.acceleration_m_s2.clone()),
            ("jerk_m_s3", self.jerk_m_s3.clone()),
        ];
        let named = columns.into_iter();
        named
            .filter_map(|(name, values)| Some((name, values?)))
            .collect()
    }
}

fn all<T>(frames: &[FramePhysics], of: impl Fn(&FramePhysics) -> T) -> Option<Vec<T>> {
    Some(frames.iter().map(of).collect())
}
