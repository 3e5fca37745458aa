//! The native physics measures as columns of a table, for the examples beside this folder.

use physique::physics::PhysicsMeasures;

pub(crate) const MEASURES: [&str; 11] = [
    "in ground, cm",
    "floating, cm",
    "unsupported, %",
    "flight, %",
    "sliding, cm/s",
    "inside, %",
    "outside, cm",
    "margin, cm",
    "acceleration, m/s²",
    "jerk, m/s³",
    "jitter, mm",
];

pub(crate) fn measured(found: &PhysicsMeasures) -> [Option<f64>; MEASURES.len()] {
    let (balance, smooth) = (found.balance.measured, found.smoothness);
    [
        Some(100.0 * found.ground.penetration_mean_m),
        Some(100.0 * found.ground.floating_mean_m),
        Some(found.ground.unsupported_frames_percent),
        Some(found.ground.flight_frames_percent),
        Some(100.0 * found.feet.slide_mean_m_s),
        balance.map(|balance| balance.stable_percent),
        balance.map(|balance| 100.0 * balance.outside_mean_m),
        balance.map(|balance| 100.0 * balance.margin_mean_m),
        smooth.map(|smooth| smooth.acceleration_mean_m_s2),
        smooth.map(|smooth| smooth.jerk_mean_m_s3),
        smooth.map(|smooth| 1000.0 * smooth.jitter_mean_m),
    ]
}

/// NaN of nothing.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
