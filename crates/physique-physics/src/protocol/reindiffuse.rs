//! ReinDiffuse (Han et al., WACV 2025), 20 fps.
//!
//! Skate: frame pairs in which a toe joint in contact (below 5 cm) moves more than 2.5 or 5 cm.
//! Float: mean height of the lowest joint over frames where it is above 5 cm, others 0. Penetrate:
//! mean depth of the lowest joint below ground. Clip: frames with the feet closer than 5 cm.

use physique_body::Joint;

use super::ProtocolMeasure;
use super::track::Track;
use crate::measures::mean;

const CONTACT: f64 = 0.05;
const CLIP: f64 = 0.05;
const TOES: [Joint; 2] = [Joint::LeftFoot, Joint::RightFoot];

pub(super) fn measure(track: &Track) -> Vec<ProtocolMeasure> {
    let fraction = |holds: bool| if holds { 1.0 } else { 0.0 };
    let skate = |least: f64| {
        mean(track.pairs().map(|frame| {
            fraction(TOES.into_iter().any(|toe| {
                track.stays_below(frame, toe, CONTACT)
                    && track.step_on_ground(frame, toe).length() > least
            }))
        }))
    };
    let lowest = || {
        track.joints.iter().map(|joints| {
            let heights = joints.iter().map(|joint| joint.y);
            heights.fold(f64::MAX, f64::min)
        })
    };
    let feet_apart = |joints: &[glam::DVec3; Joint::COUNT]| {
        joints[TOES[0].index()].distance(joints[TOES[1].index()])
    };
    let clips = track
        .joints
        .iter()
        .map(|joints| fraction(feet_apart(joints) < CLIP));
    vec![
        ProtocolMeasure::new("skate_2_5_cm_ratio", skate(0.025)),
        ProtocolMeasure::new("skate_5_cm_ratio", skate(0.05)),
        ProtocolMeasure::new(
            "float_m",
            mean(lowest().map(|height| if height > CONTACT { height } else { 0.0 })),
        ),
        ProtocolMeasure::new(
            "penetrate_m",
            mean(lowest().map(|height| (-height).max(0.0))),
        ),
        ProtocolMeasure::new("clip_ratio", mean(clips)),
    ]
}
