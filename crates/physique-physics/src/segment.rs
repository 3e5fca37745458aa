//! Body segments of the biomechanics tables: densities and expected masses.

use glam::DVec3;
use physique_body::{Body, Joint, Sex};

/// A segment of the body; left and right apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // The names are the documentation.
pub enum Segment {
    HeadAndNeck,
    Trunk,
    LeftUpperArm,
    RightUpperArm,
    LeftForearm,
    RightForearm,
    LeftHand,
    RightHand,
    LeftThigh,
    RightThigh,
    LeftShank,
    RightShank,
    LeftFoot,
    RightFoot,
}

impl Segment {
    /// All segments.
    pub const ALL: [Self; 14] = [
        Self::HeadAndNeck,
        Self::Trunk,
        Self::LeftUpperArm,
        Self::RightUpperArm,
        Self::LeftForearm,
        Self::RightForearm,
        Self::LeftHand,
        Self::RightHand,
        Self::LeftThigh,
        Self::RightThigh,
        Self::LeftShank,
        Self::RightShank,
        Self::LeftFoot,
        Self::RightFoot,
    ];

    /// The segment that the part moved by a joint belongs to.
    pub const fn of(joint: Joint) -> Self {
        match joint {
            Joint::Neck | Joint::Head => Self::HeadAndNeck,
            Joint::Pelvis
            | Joint::Spine1
            | Joint::Spine2
            | Joint::Spine3
            | Joint::LeftCollar
            | Joint::RightCollar => Self::Trunk,
            Joint::LeftShoulder => Self::LeftUpperArm,
            Joint::RightShoulder => Self::RightUpperArm,
            Joint::LeftElbow => Self::LeftForearm,
            Joint::RightElbow => Self::RightForearm,
            Joint::LeftWrist => Self::LeftHand,
            Joint::RightWrist => Self::RightHand,
            Joint::LeftHip => Self::LeftThigh,
            Joint::RightHip => Self::RightThigh,
            Joint::LeftKnee => Self::LeftShank,
            Joint::RightKnee => Self::RightShank,
            Joint::LeftAnkle | Joint::LeftFoot => Self::LeftFoot,
            Joint::RightAnkle | Joint::RightFoot => Self::RightFoot,
        }
    }

    /// The segment of a point of the rest body, by the part it moves with and the anatomists' cuts:
    /// the arm ends at an upright plane through the shoulder, the thigh at a plane through the hip
    /// that rises outwards at 37 degrees to the midline (Zatsiorsky, 1983, as de Leva adjusted).
    pub fn at(body: &Body, part: Joint, position: DVec3) -> Self {
        /// Outer and lower side of the cut through the left hip.
        const HIP_CUT: DVec3 = DVec3::new(0.798_6, -0.601_8, 0.0);
        let left = position.x >= 0.0;
        let mirror = DVec3::new(if left { 1.0 } else { -1.0 }, 1.0, 1.0);
        let beyond = |joint: Joint, normal: DVec3| {
            let joint = if left { joint } else { joint.mirrored() };
            let offset = position - body.rest_joint(joint).as_dvec3();
            (offset * mirror).dot(normal) > 0.0
        };
        let cut = match Self::of(part) {
            Self::Trunk | Self::LeftThigh | Self::RightThigh if beyond_waist(body, position) => {
                beyond(Joint::LeftHip, HIP_CUT).then_some(Self::LeftThigh)
            }
            Self::Trunk | Self::LeftUpperArm | Self::RightUpperArm => {
                beyond(Joint::LeftShoulder, DVec3::X).then_some(Self::LeftUpperArm)
            }
            other => return other,
        };
        match cut {
            None => Self::Trunk,
            Some(Self::LeftThigh) if !left => Self::RightThigh,
            Some(Self::LeftUpperArm) if !left => Self::RightUpperArm,
            Some(segment) => segment,
        }
    }

    /// Mass in per cent of the body, mean of the young adults of de Leva, "Adjustments to
    /// Zatsiorsky-Seluyanov's segment inertia parameters", J. Biomechanics 29(9), 1996, table 4.
    /// Neutral is half-way.
    pub fn de_leva_percent(self, sex: Sex) -> f64 {
        let (female, male) = match self {
            Self::HeadAndNeck => (6.68, 6.94),
            Self::Trunk => (42.57, 43.46),
            Self::LeftUpperArm | Self::RightUpperArm => (2.55, 2.71),
            Self::LeftForearm | Self::RightForearm => (1.38, 1.62),
            Self::LeftHand | Self::RightHand => (0.56, 0.61),
            Self::LeftThigh | Self::RightThigh => (14.78, 14.16),
            Self::LeftShank | Self::RightShank => (4.81, 4.33),
            Self::LeftFoot | Self::RightFoot => (1.29, 1.37),
        };
        match sex {
            Sex::Female => female,
            Sex::Neutral => (female + male) / 2.0,
            Sex::Male => male,
        }
    }

    /// Name in everyday words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::HeadAndNeck => "head and neck",
            Self::Trunk => "trunk",
            Self::LeftUpperArm => "left upper arm",
            Self::RightUpperArm => "right upper arm",
            Self::LeftForearm => "left forearm",
            Self::RightForearm => "right forearm",
            Self::LeftHand => "left hand",
            Self::RightHand => "right hand",
            Self::LeftThigh => "left thigh",
            Self::RightThigh => "right thigh",
            Self::LeftShank => "left shank",
            Self::RightShank => "right shank",
            Self::LeftFoot => "left foot",
            Self::RightFoot => "right foot",
        }
    }
}

/// Whether a point is low enough for the thigh: below the first joint of the spine.
fn beyond_waist(body: &Body, position: DVec3) -> bool {
    position.y < f64::from(body.rest_joint(Joint::Spine1).y)
}

/// Density of the flesh that a joint moves, in kg/m3: Dempster, "Space requirements of the seated
/// operator", WADC 55-159, 1955, as tabulated by Winter, "Biomechanics and Motor Control of Human
/// Movement", table 4.1. The chest holds the lungs.
pub(crate) const fn density(joint: Joint) -> f64 {
    match joint {
        Joint::Neck | Joint::Head => 1110.0,
        Joint::Spine3 => 920.0,
        Joint::Pelvis | Joint::Spine1 | Joint::Spine2 => 1010.0,
        Joint::LeftCollar | Joint::RightCollar => 1040.0,
        Joint::LeftShoulder | Joint::RightShoulder => 1070.0,
        Joint::LeftElbow | Joint::RightElbow => 1130.0,
        Joint::LeftWrist | Joint::RightWrist => 1160.0,
        Joint::LeftHip | Joint::RightHip => 1050.0,
        Joint::LeftKnee | Joint::RightKnee => 1090.0,
        Joint::LeftAnkle | Joint::RightAnkle | Joint::LeftFoot | Joint::RightFoot => 1100.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_adds_up_to_a_whole_body() {
        for sex in [Sex::Female, Sex::Neutral, Sex::Male] {
            let total: f64 = Segment::ALL.iter().map(|s| s.de_leva_percent(sex)).sum();
            assert!((total - 100.0).abs() < 0.02, "{total}");
        }
    }
}
