//! Ground, feet, balance and smoothness as a report tells them: see [`physique_physics`].

use physique_physics::PhysicsMeasures;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::measures::Named;

/// Centimetres in a metre.
const CM: f64 = 100.0;

/// How deep in the ground the lowest skin is, and how high above. Means are over all frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GroundScore {
    /// Mean depth of the lowest skin, frames above ground counting 0, in cm.
    pub penetration_mean_cm: f64,
    /// Greatest depth, in cm.
    pub penetration_worst_cm: f64,
    /// Frames deeper than 1 cm, in per cent.
    pub penetration_frames_percent: f64,
    /// Mean height of the lowest skin, frames in the ground or in flight counting 0, in cm.
    pub floating_mean_cm: f64,
    /// Frames that neither touch the ground nor fall, in per cent.
    pub unsupported_percent: f64,
    /// Frames of free flight, in per cent.
    pub flight_percent: f64,
}

/// How the soles move while they are on the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FeetScore {
    /// Mean speed of the sole points on the ground, frames without any counting 0, in cm/s.
    pub slide_mean_cm_s: f64,
    /// Greatest speed of a frame, in cm/s.
    pub slide_worst_cm_s: f64,
    /// Frames faster than 10 cm/s, in per cent.
    pub slide_frames_percent: f64,
}

/// Whether the body could stand as it moves: zero moment point against base of support.
///
/// Frames near the ends of the clip, in flight, without support or with hardly any load are not
/// judged, neither as stable nor as unstable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BalanceScore {
    /// Frames that are judged, in per cent.
    pub judged_percent: f64,
    /// Judged frames with the zero moment point inside the base of support, in per cent; null, as
    /// the others, where no frame is judged.
    pub stable_percent: Option<f64>,
    /// Mean distance of the zero moment point outside, in cm; inside counts 0.
    pub outside_mean_cm: Option<f64>,
    /// Mean margin of stability (capture point inside the base of support), in cm.
    pub margin_mean_cm: Option<f64>,
}

/// Means over the 22 joints, by derivatives with a cut-off of 6 Hz.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SmoothnessScore {
    /// Mean acceleration, in m/s2.
    pub acceleration_mean_m_s2: f64,
    /// Mean jerk, in m/s3.
    pub jerk_mean_m_s3: f64,
    /// Greatest jerk of a frame, in m/s3.
    pub jerk_worst_m_s3: f64,
    /// Mean distance from the smoothed path, in mm.
    pub jitter_mean_mm: f64,
}

impl GroundScore {
    pub(crate) fn of(found: &PhysicsMeasures) -> Self {
        let ground = &found.ground;
        Self {
            penetration_mean_cm: CM * ground.penetration_mean_m,
            penetration_worst_cm: CM * ground.penetration_worst_m,
            penetration_frames_percent: ground.penetration_frames_percent,
            floating_mean_cm: CM * ground.floating_mean_m,
            unsupported_percent: ground.unsupported_frames_percent,
            flight_percent: ground.flight_frames_percent,
        }
    }

    pub(crate) const NAMED: [Named<Self>; 6] = [
        ("ground_penetration_mean_cm", |g| {
            Some(g.penetration_mean_cm)
        }),
        ("ground_penetration_worst_cm", |g| {
            Some(g.penetration_worst_cm)
        }),
        ("ground_penetration_frames_percent", |g| {
            Some(g.penetration_frames_percent)
        }),
        ("ground_floating_mean_cm", |g| Some(g.floating_mean_cm)),
        ("ground_unsupported_percent", |g| {
            Some(g.unsupported_percent)
        }),
        ("ground_flight_percent", |g| Some(g.flight_percent)),
    ];
}

impl FeetScore {
    pub(crate) fn of(found: &PhysicsMeasures) -> Self {
        Self {
            slide_mean_cm_s: CM * found.feet.slide_mean_m_s,
            slide_worst_cm_s: CM * found.feet.slide_worst_m_s,
            slide_frames_percent: found.feet.slide_frames_percent,
        }
    }

    pub(crate) const NAMED: [Named<Self>; 3] = [
        ("feet_slide_mean_cm_s", |f| Some(f.slide_mean_cm_s)),
        ("feet_slide_worst_cm_s", |f| Some(f.slide_worst_cm_s)),
        ("feet_slide_frames_percent", |f| {
            Some(f.slide_frames_percent)
        }),
    ];
}

impl BalanceScore {
    pub(crate) fn of(found: &PhysicsMeasures) -> Self {
        let measured = found.balance.measured;
        let frames = found.frames.len() as f64;
        Self {
            judged_percent: 100.0 * found.balance.measured_frames as f64 / frames,
            stable_percent: measured.map(|balance| balance.stable_percent),
            outside_mean_cm: measured.map(|balance| CM * balance.outside_mean_m),
            margin_mean_cm: measured.map(|balance| CM * balance.margin_mean_m),
        }
    }

    pub(crate) const NAMED: [Named<Self>; 4] = [
        ("balance_judged_percent", |b| Some(b.judged_percent)),
        ("balance_stable_percent", |b| b.stable_percent),
        ("balance_outside_mean_cm", |b| b.outside_mean_cm),
        ("balance_margin_mean_cm", |b| b.margin_mean_cm),
    ];
}

impl SmoothnessScore {
    /// `None` for a clip too short to differentiate.
    pub(crate) fn of(found: &PhysicsMeasures) -> Option<Self> {
        found.smoothness.map(|smoothness| Self {
            acceleration_mean_m_s2: smoothness.acceleration_mean_m_s2,
            jerk_mean_m_s3: smoothness.jerk_mean_m_s3,
            jerk_worst_m_s3: smoothness.jerk_worst_m_s3,
            jitter_mean_mm: 1000.0 * smoothness.jitter_mean_m,
        })
    }

    pub(crate) const NAMED: [Named<Self>; 4] = [
        ("smoothness_acceleration_mean_m_s2", |s| {
            Some(s.acceleration_mean_m_s2)
        }),
        ("smoothness_jerk_mean_m_s3", |s| Some(s.jerk_mean_m_s3)),
        ("smoothness_jerk_worst_m_s3", |s| Some(s.jerk_worst_m_s3)),
        ("smoothness_jitter_mean_mm", |s| Some(s.jitter_mean_mm)),
    ];
}
