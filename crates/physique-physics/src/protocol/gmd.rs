//! GMD (Karunratanakul et al., ICCV 2023) and OmniControl: foot skating ratio, 20 fps.
//!
//! A toe joint skates when it is below 5 cm in two adjacent frames, its horizontal speed is above
//! 0.5 m/s, and so is the mean of five frames' speeds (zeros beyond the ends). The ratio is the
//! fraction of frame pairs in which either foot skates.

use physique_body::Joint;

use super::ProtocolMeasure;
use super::track::Track;
use crate::measures::mean;

const CONTACT: f64 = 0.05;
const SPEED: f64 = 0.5;
const WINDOW_REACH: usize = 2;

pub(super) fn measure(track: &Track) -> Vec<ProtocolMeasure> {
    let skates = [Joint::LeftFoot, Joint::RightFoot].map(|toe| skating(track, toe));
    let either = track
        .pairs()
        .map(|frame| skates.iter().any(|foot| foot[frame]));
    let ratio = mean(either.map(|skates| if skates { 1.0 } else { 0.0 }));
    vec![ProtocolMeasure::new("skating_ratio", ratio)]
}

fn skating(track: &Track, toe: Joint) -> Vec<bool> {
    let speeds: Vec<_> = track
        .pairs()
        .map(|frame| track.step_on_ground(frame, toe).length() * track.frames_per_second)
        .collect();
    let smoothed = |frame: usize| {
        let from = frame.saturating_sub(WINDOW_REACH);
        let to = (frame + WINDOW_REACH + 1).min(speeds.len());
        speeds[from..to].iter().sum::<f64>() / (2 * WINDOW_REACH + 1) as f64
    };
    track
        .pairs()
        .map(|frame| {
            track.stays_below(frame, toe, CONTACT)
                && speeds[frame] > SPEED
                && smoothed(frame) > SPEED
        })
        .collect()
}
