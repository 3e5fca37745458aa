//! What a clip may do before it counts as bad.

/// Thresholds of [`crate::defects::DefectFinder`]. The defaults come from 3,209 clips of motion
/// capture: see the page on physics in the project's `docs/`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DefectLimits {
    /// A clip must last so long, in seconds.
    pub least_s: f64,
    /// A joint may move so much farther in one frame than three times its usual step around it, in
    /// cm.
    pub jump_cm: f64,
    /// The same for the turn of a joint, in degrees.
    pub jump_degrees: f64,
    /// Nothing may stand still to ten micrometres for so long, in seconds: bodies breathe.
    pub frozen_s: f64,
    /// So many frames may repeat the one before, in per cent.
    pub repeated_percent: f64,
    /// Frames a second that people record, animate or generate at.
    pub frame_rates_fps: [f64; 2],
    /// In flight, bodies fall by gravity times the square of stated over true frame rate. That
    /// ratio may differ from 1 by this factor.
    pub frame_rate_factor: f64,
    /// The lowest skin may be so deep in the ground on average, in cm.
    pub below_ground_cm: f64,
    /// The lowest skin may be so high above ground on average, flight left out, in cm.
    pub floating_cm: f64,
    /// Parts of the body may share so much volume on average, in cm3.
    pub self_intersection_cm3: f64,
}

impl Default for DefectLimits {
    fn default() -> Self {
        Self {
            least_s: 0.5,
            jump_cm: 10.0,
            jump_degrees: 45.0,
            frozen_s: 0.5,
            repeated_percent: 20.0,
            frame_rates_fps: [8.0, 240.0],
            frame_rate_factor: 1.3,
            below_ground_cm: 5.0,
            floating_cm: 5.0,
            self_intersection_cm3: 300.0,
        }
    }
}
