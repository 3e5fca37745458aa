//! What the motion itself says about its frame rate.
//!
//! Three things contradict a rate: flights that do not fall by gravity (see [`crate::defects`]);
//! bodies that fall faster than gravity, which nothing on Earth makes them do; and frames that lie
//! just between their neighbours, as when a slower recording was stretched by interpolation. A motion that never
//! leaves the ground and has no such frames can be played at twice its speed and look like a
//! brisk person: from it alone, the rate cannot be told, and nothing is said.

use glam::Vec3;
use physique_body::Joint;
use physique_motion::Motion;
use physique_motion::features::JointPositions;

use super::Warning;

const GRAVITY: f64 = 9.81;

/// Weights of joints in a rough centre of mass: half of each neighbouring segment's part of the
/// body, after de Leva 1996. Left and right are alike.
const WEIGHTS: [(Joint, f64); 13] = [
    (Joint::Pelvis, 0.055),
    (Joint::Spine1, 0.11),
    (Joint::Spine2, 0.105),
    (Joint::Spine3, 0.105),
    (Joint::Neck, 0.07),
    (Joint::Head, 0.045),
    (Joint::LeftHip, 0.0725),
    (Joint::LeftKnee, 0.0953),
    (Joint::LeftAnkle, 0.0295),
    (Joint::LeftFoot, 0.0067),
    (Joint::LeftShoulder, 0.0132),
    (Joint::LeftElbow, 0.0206),
    (Joint::LeftWrist, 0.0135),
];

/// What the motion says about its rate.
#[derive(Clone, Debug, Default)]
pub(super) struct RateEvidence {
    frame_rate: f64,
    /// See [`super::MotionInspection::hardest_fall_g`].
    pub(super) hardest_fall_g: Option<f64>,
    /// Turning of the smoother half of frames away from their neighbours' middle, over that of the
    /// other half.
    in_between: Option<f64>,
}

impl RateEvidence {
    /// `scale` is the body's size over the person's.
    pub(super) fn of(motion: &Motion, positions: &JointPositions, scale: f64) -> Self {
        let frame_rate = positions.frame_rate().per_second();
        let heights: Vec<f64> = positions
            .frames()
            .map(|joints| centre_of_mass_height(joints) / scale)
            .collect();
        Self {
            frame_rate,
            hardest_fall_g: hardest_fall(&heights, frame_rate).map(|fall| fall / GRAVITY),
            in_between: in_between(motion),
        }
    }

    pub(super) fn warnings(&self) -> Vec<Warning> {
        /// The rough centre of mass of recorded leaps falls by up to 1.8 g.
        const TOO_FAST: f64 = 2.5;
        /// Recordings have 0.3 and more, interpolated frames what mapping adds.
        const BETWEEN: f64 = 0.1;
        let mut warnings = Vec::new();
        let rate = self.frame_rate;
        if let Some(fall) = self.hardest_fall_g.filter(|fall| *fall > TOO_FAST) {
            let most = rate / fall.sqrt();
            warnings.push(Warning::new(
                "frame-rate",
                format!(
                    "The body falls with {fall:.1} times gravity: the true frame rate is probably {most:.0} a second or less, not {rate:.0}."
                ),
            ));
        }
        if self.in_between.is_some_and(|share| share < BETWEEN) {
            warnings.push(Warning::new(
                "in-between-frames",
                format!(
                    "Every second frame lies just between its neighbours: the motion was probably recorded at {:.0} frames a second.",
                    rate / 2.0
                ),
            ));
        }
        warnings
    }
}

fn centre_of_mass_height(joints: &[Vec3]) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (joint, weight) in WEIGHTS {
        let mirrored = joint.mirrored();
        sum += weight * f64::from(joints[joint.index()].y);
        weights += weight;
        if mirrored != joint {
            sum += weight * f64::from(joints[mirrored.index()].y);
            weights += weight;
        }
    }
    sum / weights
}

/// The second-hardest of separate falls, as acceleration downwards: the hardest may be a fault of
/// the recording. A parabola over a fifth of a second is fitted around each frame.
fn hardest_fall(heights: &[f64], frame_rate: f64) -> Option<f64> {
    let reach = (0.1 * frame_rate).round().max(2.0) as usize;
    if heights.len() < 4 * reach {
        return None;
    }
    // Least-squares second derivative over evenly spaced values: the quadratic Gram polynomial.
    let spread = (reach * (reach + 1)) as f64 / 3.0;
    let taps: Vec<f64> = (0..=2 * reach)
        .map(|index| (index as f64 - reach as f64).powi(2) - spread)
        .collect();
    let norm: f64 = taps.iter().map(|tap| tap * tap).sum();
    let fall = |window: &[f64]| {
        let along: f64 = window
            .iter()
            .zip(&taps)
            .map(|(value, tap)| value * tap)
            .sum();
        -2.0 * along / norm * frame_rate * frame_rate
    };
    let falls: Vec<f64> = heights.windows(taps.len()).map(fall).collect();
    // One value a fall: the largest between two risings.
    let mut events: Vec<f64> = falls
        .chunk_by(|a, b| (*a > 0.0) == (*b > 0.0))
        .map(|run| run.iter().copied().fold(0.0, f64::max))
        .filter(|fall| *fall > 0.0)
        .collect();
    events.sort_by(|a, b| b.total_cmp(a));
    events.get(1).copied()
}

/// Over all joints, how far the smoother half of frames, even or odd, turns away from the middle
/// of its neighbours, over how far the other half does; `None` for clips that are short or do not
/// move.
fn in_between(motion: &Motion) -> Option<f64> {
    const LEAST_FRAMES: usize = 40;
    /// Less is rounding, in radians a joint and frame.
    const STILL: f64 = 1e-4;
    let frames = motion.frame_count();
    if frames < LEAST_FRAMES {
        return None;
    }
    let mut turns = [0.0_f64; 2];
    for frame in 1..frames - 1 {
        let [before, now, after] =
            [frame - 1, frame, frame + 1].map(|frame| motion.frame_rotations(frame));
        for ((before, now), after) in before.iter().zip(now).zip(after) {
            let middle = before.slerp(*after, 0.5);
            // By the sine: exact for the small turns, where the cosine is all 1.
            let away = (middle.conjugate() * *now).xyz().length();
            turns[frame % 2] += 2.0 * f64::from(away.min(1.0)).asin();
        }
    }
    let (less, more) = (turns[0].min(turns[1]), turns[0].max(turns[1]));
    let still = STILL * (Joint::COUNT * frames / 2) as f64;
    (more > still).then(|| less / more)
}

#[cfg(test)]
mod tests {
    use super::hardest_fall;

    /// Hops of a second each: half on the ground, half in flight.
    fn hops(frame_rate: f64, gravity: f64) -> Vec<f64> {
        let height = |frame: usize| {
            let t = (frame as f64 / frame_rate).fract();
            if t < 0.5 {
                gravity / 2.0 * t * (0.5 - t)
            } else {
                0.0
            }
        };
        (0..(5.0 * frame_rate) as usize).map(height).collect()
    }

    #[test]
    fn flights_fall_by_gravity_and_four_times_that_at_twice_the_speed() {
        for rate in [30.0, 60.0, 120.0] {
            let right = hardest_fall(&hops(rate, 9.81), rate).unwrap();
            assert!((right / 9.81 - 1.0).abs() < 0.02, "{rate}: {right}");
            let twice = hardest_fall(&hops(rate, 9.81), 2.0 * rate).unwrap();
            assert!(twice > 3.5 * 9.81, "{rate}: {twice}");
        }
        assert_eq!(hardest_fall(&[0.0; 9], 30.0), None);
    }
}
