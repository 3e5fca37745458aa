//! The height of the ground, from the soles.

use glam::DVec3;
use physique_body::Body;
use physique_motion::Motion;

use crate::soles::{SolePoint, skinned};
use crate::transforms::Transforms;
use crate::{PhysicsOptions, Rig};

/// The height that this part of the lowest slow soles lie below.
const QUANTILE: f64 = 0.05;
/// Frames posed at once.
const BLOCK: usize = 256;

/// Height of the ground that the slow soles stand on; of the lowest soles of all frames where no
/// sole is ever slow.
pub(crate) fn estimate(
    body: &Body,
    rig: &Rig,
    soles: &[SolePoint],
    motion: &Motion,
    options: &PhysicsOptions,
) -> f64 {
    let (mut slow, mut all) = (Vec::new(), Vec::new());
    let mut before: Option<Vec<DVec3>> = None;
    for begin in (0..motion.frame_count()).step_by(BLOCK) {
        let end = (begin + BLOCK).min(motion.frame_count());
        let transforms = Transforms::of(rig, motion, begin..end);
        for frame in begin..end {
            let points: Vec<_> = soles
                .iter()
                .map(|sole| skinned(body, sole.vertex, transforms.frame(frame)))
                .collect();
            let lowest = (0..points.len()).min_by(|&a, &b| points[a].y.total_cmp(&points[b].y));
            if let Some(lowest) = lowest {
                let height = points[lowest].y;
                all.push(height);
                let moved = before
                    .as_ref()
                    .map(|before| points[lowest].distance(before[lowest]));
                let limit = options.contact_speed * motion.frame_rate().frame_seconds();
                if moved.is_some_and(|moved| moved < limit) {
                    slow.push(height);
                }
            }
            before = Some(points);
        }
    }
    quantile(&mut slow)
        .or_else(|| quantile(&mut all))
        .unwrap_or(0.0)
}

fn quantile(heights: &mut [f64]) -> Option<f64> {
    heights.sort_unstable_by(f64::total_cmp);
    let place = (heights.len() as f64 * QUANTILE) as usize;
    heights.get(place).copied()
}
