//! PhysDiff (Yuan et al., ICCV 2023), 20 fps.
//!
//! Distance of the lowest vertex below and above ground with 5 mm tolerance; horizontal
//! displacement of foot joints in contact (within 5 mm, as the skin) in two adjacent frames. Means
//! over all frames, in mm; Phys-Err is their sum.

use physique_body::Joint;

use super::ProtocolMeasure;
use super::track::Track;
use crate::measures::mean;

/// Millimetres in a metre.
const MM: f64 = 1000.0;
const TOLERANCE: f64 = 0.005;

pub(super) fn measure(track: &Track) -> Vec<ProtocolMeasure> {
    let heights = || track.lowest_skin.iter();
    let below = heights().map(|&height| if height < -TOLERANCE { -height } else { 0.0 });
    let above = heights().map(|&height| if height > TOLERANCE { height } else { 0.0 });
    let skates = track.pairs().flat_map(|frame| {
        Joint::FEET.map(|joint| {
            let contact = track.stays_below(frame, joint, TOLERANCE);
            if contact {
                track.step_on_ground(frame, joint).length()
            } else {
                0.0
            }
        })
    });
    let [penetrate, float] = [mean(below), mean(above)].map(|value| value.map(|m| m * MM));
    let skate = mean(skates).map(|metres| metres * MM);
    let sum = penetrate
        .zip(float)
        .map(|(p, f)| p + f + skate.unwrap_or(0.0));
    vec![
        ProtocolMeasure::new("penetrate_mm", penetrate),
        ProtocolMeasure::new("float_mm", float),
        ProtocolMeasure::new("skate_mm_per_frame", skate),
        ProtocolMeasure::new("phys_err_mm", sum),
    ]
}
