//! Ground, feet, balance and smoothness as a report tells them: see [`physique_physics`].

use physique_physics::PhysicsMeasures;
use schemars::JsonSchema;
use serde::Serialize;

/// Centimetres in a metre.
const CM: f64 = 100.0;

/// The physics of a motion on the ground at height 0. Means are over all frames, unless said.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PhysicsScore {
    /// Skin and ground.
    pub ground: GroundScore,
    /// Feet on the ground.
    pub feet: FeetScore,
    /// Balance of the frames that can be judged; null where there are none.
    pub balance: Option<BalanceScore>,
    /// Frames that balance is not judged in: near the ends of the clip, in flight, without support.
    pub unjudged_frames: usize,
    /// How smoothly the joints move; null for clips of less than half a second or so.
    pub smoothness: Option<SmoothnessScore>,
}

/// How deep in the ground the lowest skin is, and how high above.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct GroundScore {
    /// Mean depth of the lowest skin, in cm.
    pub penetration_mean_cm: f64,
    /// Greatest depth, in cm.
    pub penetration_worst_cm: f64,
    /// Mean height of the lowest skin outside flight, in cm.
    pub floating_mean_cm: f64,
    /// Frames that neither touch the ground nor fall, in per cent.
    pub unsupported_percent: f64,
    /// Frames of free flight, in per cent.
    pub flight_percent: f64,
}

/// How the soles move while they are on the ground.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FeetScore {
    /// Mean speed of the sole points on the ground, in cm/s.
    pub slide_mean_cm_s: f64,
    /// Frames faster than 10 cm/s, in per cent.
    pub slide_frames_percent: f64,
}

/// Whether the body could stand as it moves: zero moment point against base of support.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BalanceScore {
    /// Judged frames with the zero moment point inside the base of support, in per cent.
    pub stable_percent: f64,
    /// Mean distance of the zero moment point outside, in cm; inside counts 0.
    pub outside_mean_cm: f64,
    /// Mean margin of stability (capture point inside the base of support), in cm.
    pub margin_mean_cm: f64,
}

/// Means over the 22 joints, by derivatives with a cut-off of 6 Hz.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SmoothnessScore {
    /// Mean acceleration, in m/s2.
    pub acceleration_mean_m_s2: f64,
    /// Mean jerk, in m/s3.
    pub jerk_mean_m_s3: f64,
    /// Mean distance from the smoothed path, in mm.
    pub jitter_mean_mm: f64,
}

impl From<&PhysicsMeasures> for PhysicsScore {
    fn from(found: &PhysicsMeasures) -> Self {
        let balance = found.balance.measured.map(|balance| BalanceScore {
            stable_percent: balance.stable_percent,
            outside_mean_cm: CM * balance.outside_mean_m,
            margin_mean_cm: CM * balance.margin_mean_m,
        });
        let smoothness = found.smoothness.map(|smoothness| SmoothnessScore {
            acceleration_mean_m_s2: smoothness.acceleration_mean_m_s2,
            jerk_mean_m_s3: smoothness.jerk_mean_m_s3,
            jitter_mean_mm: 1000.0 * smoothness.jitter_mean_m,
        });
        Self {
            ground: GroundScore {
                penetration_mean_cm: CM * found.ground.penetration_mean_m,
                penetration_worst_cm: CM * found.ground.penetration_worst_m,
                floating_mean_cm: CM * found.ground.floating_mean_m,
                unsupported_percent: found.ground.unsupported_frames_percent,
                flight_percent: found.ground.flight_frames_percent,
            },
            feet: FeetScore {
                slide_mean_cm_s: CM * found.feet.slide_mean_m_s,
                slide_frames_percent: found.feet.slide_frames_percent,
            },
            balance,
            unjudged_frames: found.frames.len() - found.balance.measured_frames,
            smoothness,
        }
    }
}

impl PhysicsScore {
    /// Names of all measures, in the order of [`PhysicsScore::measures`].
    pub(crate) const NAMES: [&'static str; 13] = [
        "ground_penetration_mean_cm",
        "ground_penetration_worst_cm",
        "ground_floating_mean_cm",
        "ground_unsupported_percent",
        "ground_flight_percent",
        "feet_slide_mean_cm_s",
        "feet_slide_frames_percent",
        "balance_stable_percent",
        "balance_outside_mean_cm",
        "balance_margin_mean_cm",
        "smoothness_acceleration_mean_m_s2",
        "smoothness_jerk_mean_m_s3",
        "smoothness_jitter_mean_mm",
    ];

    /// Measures by name; those that the clip does not have are left out.
    pub(crate) fn measures(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let balance = self.balance.as_ref();
        let smoothness = self.smoothness.as_ref();
        let values = [
            Some(self.ground.penetration_mean_cm),
            Some(self.ground.penetration_worst_cm),
            Some(self.ground.floating_mean_cm),
            Some(self.ground.unsupported_percent),
            Some(self.ground.flight_percent),
            Some(self.feet.slide_mean_cm_s),
            Some(self.feet.slide_frames_percent),
            balance.map(|balance| balance.stable_percent),
            balance.map(|balance| balance.outside_mean_cm),
            balance.map(|balance| balance.margin_mean_cm),
            smoothness.map(|smoothness| smoothness.acceleration_mean_m_s2),
            smoothness.map(|smoothness| smoothness.jerk_mean_m_s3),
            smoothness.map(|smoothness| smoothness.jitter_mean_mm),
        ];
        let named = Self::NAMES.into_iter().zip(values);
        named.filter_map(|(name, value)| Some((name, value?)))
    }
}
