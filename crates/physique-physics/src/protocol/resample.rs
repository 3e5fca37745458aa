//! A motion at another frame rate.

use physique_body::Joint;
use physique_motion::{FrameRate, Motion};

use crate::Error;

/// The motion at another frame rate, from its first frame to at most its last: rotations by
/// spherical, translations by linear interpolation. At its own rate, the same motion.
///
/// # Errors
/// None for a valid motion; the type keeps [`Motion::new`]'s checks.
pub fn resampled(motion: &Motion, frame_rate: FrameRate) -> Result<Motion, Error> {
    let step = motion.frame_rate().per_second() / frame_rate.per_second();
    if (step - 1.0).abs() < 1e-9 || motion.frame_count() < 2 {
        return Ok(motion.clone());
    }
    let last = motion.frame_count() - 1;
    // A hair of tolerance: 120 over 20 fps must not lose its last frame to rounding.
    let count = (last as f64 / step + 1e-6).floor() as usize + 1;
    let mut rotations = Vec::with_capacity(count * Joint::COUNT);
    let mut roots = Vec::with_capacity(count);
    for frame in 0..count {
        let place = (frame as f64 * step).min(last as f64);
        let before = place.floor() as usize;
        let after = (before + 1).min(last);
        let share = (place - before as f64) as f32;
        let pairs = motion
            .frame_rotations(before)
            .iter()
            .zip(motion.frame_rotations(after));
        rotations.extend(pairs.map(|(a, b)| a.slerp(*b, share)));
        let root = motion.root_translation();
        roots.push(root[before].lerp(root[after], share));
    }
    Ok(Motion::new(
        frame_rate,
        motion.shape().cloned(),
        roots,
        rotations,
    )?)
}
