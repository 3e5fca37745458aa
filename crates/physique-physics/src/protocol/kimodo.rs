//! Kimodo (arXiv 2603.15546), 30 fps: how toe joints move while they are low.
//!
//! Contact is a toe joint below 5 cm in two adjacent frames. The measures on the network's own
//! predicted contacts have no meaning for a motion without them; contacts found by speed below
//! 0.15 m/s and height below 0.10 m take their place.

use physique_body::Joint;

use super::ProtocolMeasure;
use super::track::Track;
use crate::measures::mean;

const TOES: [Joint; 2] = [Joint::LeftFoot, Joint::RightFoot];
const CONTACT: f64 = 0.05;
const SKATING: f64 = 0.2;
const LABEL_HEIGHT: f64 = 0.10;
const LABEL_SPEED: f64 = 0.15;

pub(super) fn measure(track: &Track) -> Vec<ProtocolMeasure> {
    let toe_frames = || track.pairs().flat_map(|frame| TOES.map(|toe| (frame, toe)));
    let speed = |(frame, toe)| track.step(frame, toe).length() * track.frames_per_second;
    let low = || toe_frames().filter(|&(frame, toe)| track.stays_below(frame, toe, CONTACT));
    let skating = low().map(|place| if speed(place) > SKATING { 1.0 } else { 0.0 });
    let labelled = || {
        toe_frames()
            .filter(|&(frame, toe)| track.height(frame, toe) < LABEL_HEIGHT)
            .map(speed)
            .filter(|&speed| speed < LABEL_SPEED)
    };
    vec![
        ProtocolMeasure::new("skating_contact_ratio", mean(skating)),
        ProtocolMeasure::new("toe_speed_in_contact_m_s", mean(low().map(speed))),
        ProtocolMeasure::new("labelled_contact_speed_mean_m_s", mean(labelled())),
        ProtocolMeasure::new(
            "labelled_contact_speed_max_m_s",
            labelled().reduce(f64::max),
        ),
    ]
}
