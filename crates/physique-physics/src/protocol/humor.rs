//! HuMoR (Rempe et al., ICCV 2021), 30 fps: toe joints below the ground, and joint acceleration.

use physique_body::Joint;

use super::ProtocolMeasure;
use super::track::Track;
use crate::measures::mean;

const DEPTHS: [(&str, f64); 6] = [
    ("toes_below_0_cm_percent", 0.0),
    ("toes_below_3_cm_percent", 0.03),
    ("toes_below_6_cm_percent", 0.06),
    ("toes_below_9_cm_percent", 0.09),
    ("toes_below_12_cm_percent", 0.12),
    ("toes_below_15_cm_percent", 0.15),
];

pub(super) fn measure(track: &Track) -> Vec<ProtocolMeasure> {
    let depths = || {
        let frames = 0..track.joints.len();
        frames.flat_map(|frame| {
            [Joint::LeftFoot, Joint::RightFoot].map(|toe| -track.height(frame, toe))
        })
    };
    let mut measures: Vec<_> = DEPTHS
        .into_iter()
        .map(|(name, least)| {
            let deep = depths().map(|depth| if depth > least { 100.0 } else { 0.0 });
            ProtocolMeasure::new(name, mean(deep))
        })
        .collect();
    let penetrating = depths().filter(|&depth| depth > 0.0);
    measures.push(ProtocolMeasure::new(
        "penetration_depth_cm",
        mean(penetrating.map(|d| 100.0 * d)),
    ));
    let accelerations = track.joints.windows(3).flat_map(|three| {
        (0..Joint::COUNT).map(|joint| {
            let second = three[2][joint] - 2.0 * three[1][joint] + three[0][joint];
            second.length() * track.frames_per_second.powi(2)
        })
    });
    measures.push(ProtocolMeasure::new(
        "joint_acceleration_m_s2",
        mean(accelerations),
    ));
    measures
}
