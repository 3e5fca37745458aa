//! Feet that ought to stand.

use glam::DVec3;

use super::stream::check;
use super::{FrameLoss, LossBody, MotionSlices, Window};
use crate::Error;
use crate::soles::SOLE_POINTS;

/// How surely a point at this height above ground and speed stands: the product of two logistic
/// steps at 2 cm (5 mm wide) and 0.3 m/s (0.05 m/s wide).
pub fn soft_contact(height_m: f64, speed_m_s: f64) -> f64 {
    let step = |x: f64| 1.0 / (1.0 + (-x).exp());
    step((0.02 - height_m) / 0.005) * step((0.3 - speed_m_s) / 0.05)
}

/// `[frames][12]` how surely each sole point of a motion stands, by [`soft_contact`] with speeds from
/// the frame before to the one after.
///
/// # Errors
/// As [`super::evaluate`].
pub fn sole_contacts(
    body: &LossBody,
    motion: &MotionSlices<'_>,
    ground: f64,
) -> Result<Vec<f64>, Error> {
    let joints = check(body, motion)?;
    let shaped = body.shaped(motion.betas);
    let (mut world_from_rest, mut soles) = (Vec::new(), Vec::new());
    for (rotations, &root) in motion.rotations.chunks(joints).zip(motion.root) {
        let rotations = rotations.iter().copied();
        shaped.rig.pose(rotations, root, &mut world_from_rest);
        soles.push(std::array::from_fn::<_, SOLE_POINTS, _>(|point| {
            shaped.posed_skin(point, &world_from_rest)
        }));
    }
    let last = soles.len() - 1;
    let frames = soles.iter().enumerate().flat_map(|(frame, now)| {
        let (before, after) = (frame.saturating_sub(1), (frame + 1).min(last));
        let seconds = motion.frame_rate.frame_seconds() * (after - before).max(1) as f64;
        let (before, after) = (&soles[before], &soles[after]);
        (0..SOLE_POINTS).map(move |point| {
            let step = after[point] - before[point];
            soft_contact(now[point].y - ground, step.length() / seconds)
        })
    });
    Ok(frames.collect())
}

/// Horizontal speed of sole points that ought to stand: the mean over frames of
/// `sum_j w_j (sqrt(v_j^2 + e^2) - e)` in m/s, with `v` from the frame before to the one after.
///
/// The contact weights are given, from the source motion by [`soft_contact`] or from labels, and
/// take no gradient: lifting a foot is no way out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliding<'a> {
    /// `[frames][12]` contact weights of the sole points, flat; missing frames are not judged.
    pub contacts: &'a [f64],
    /// Speeds far below this cost their square, those far above their size; in m/s.
    pub softness: f64,
}

impl FrameLoss for Sliding<'_> {
    fn reach(&self) -> usize {
        1
    }

    fn term(&self, window: &mut Window<'_>, scale: f64) -> f64 {
        let begin = window.frame * SOLE_POINTS;
        let Some(weights) = self.contacts.get(begin..begin + SOLE_POINTS) else {
            return 0.0;
        };
        let per_second = window.frame_rate.per_second() / 2.0;
        let mut sum = 0.0;
        for (point, &weight) in weights.iter().enumerate() {
            if weight == 0.0 {
                continue;
            }
            let step = window.skin_point(1, point) - window.skin_point(-1, point);
            let velocity = DVec3::new(step.x, 0.0, step.z) * per_second;
            let soft = velocity.length_squared() + self.softness * self.softness;
            let speed = soft.sqrt();
            sum += weight * (speed - self.softness);
            if speed > 0.0 {
                let gradient = velocity * (weight * per_second * scale / speed);
                window.add_skin_gradient(1, point, gradient);
                window.add_skin_gradient(-1, point, -gradient);
            }
        }
        sum
    }
}
