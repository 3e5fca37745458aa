//! EDGE's physical foot contact score, and MANN's skating.

use glam::DVec3;
use physique_body::Joint;

use super::ProtocolMeasure;
use super::track::Track;
use crate::measures::{greatest, mean};

/// EDGE (Tseng et al., CVPR 2023), 30 fps: the root may only accelerate while a foot stands.
///
/// `|a| / max |a|` of the root, upward part of its acceleration only, times the smaller of ankle's
/// and toe's horizontal displacement a frame, left times right; mean over frames, times 10^4.
pub(super) fn edge_pfc(track: &Track) -> Vec<ProtocolMeasure> {
    let root = Joint::Pelvis.index();
    let accelerations: Vec<_> = track
        .joints
        .windows(3)
        .map(|three| {
            let second = three[2][root] - 2.0 * three[1][root] + three[0][root];
            let scaled = second * track.frames_per_second.powi(2);
            DVec3::new(scaled.x, scaled.y.max(0.0), scaled.z).length()
        })
        .collect();
    let largest = greatest(accelerations.iter().copied());
    let slower = |frame, ankle, toe| {
        let step = |joint| track.step_on_ground(frame, joint).length();
        f64::min(step(ankle), step(toe))
    };
    let terms = accelerations
        .iter()
        .enumerate()
        .map(|(frame, acceleration)| {
            acceleration
                * slower(frame, Joint::LeftAnkle, Joint::LeftFoot)
                * slower(frame, Joint::RightAnkle, Joint::RightFoot)
        });
    let score = mean(terms).map(|mean| {
        if largest > 0.0 {
            1e4 * mean / largest
        } else {
            0.0
        }
    });
    vec![ProtocolMeasure::new("pfc", score)]
}

/// MANN (Zhang et al., SIGGRAPH 2018), 60 fps, as NeMF took it over: `v clamp(2 - 2^(h / H), 0, 1)`
/// of the toe joints with H = 2.5 cm, mean over toe frames below H, in cm a frame.
pub(super) fn mann(track: &Track) -> Vec<ProtocolMeasure> {
    const HIGHEST: f64 = 0.025;
    let toes = [Joint::LeftFoot, Joint::RightFoot];
    let low = track.pairs().flat_map(|frame| {
        let low = toes.map(|toe| (toe, track.height(frame, toe)));
        low.into_iter()
            .filter(|&(_, height)| height < HIGHEST)
            .map(move |(toe, height)| (frame, toe, height))
    });
    let skates = low.map(|(frame, toe, height)| {
        let weight = (2.0 - (height / HIGHEST).exp2()).clamp(0.0, 1.0);
        100.0 * track.step_on_ground(frame, toe).length() * weight
    });
    vec![ProtocolMeasure::new("skate_cm_per_frame", mean(skates))]
}
