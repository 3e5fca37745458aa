//! Even frames for keys at any times.

use super::Context;
use super::track::{Moment, Track};
use crate::frame_rate::customary_rate;
use crate::{Error, FrameRate};

/// The frames of an animation.
pub(super) struct Clock {
    pub(super) rate: FrameRate,
    pub(super) frames: usize,
    start: f64,
    /// Why this rate, in words.
    pub(super) note: String,
}

impl Clock {
    /// Frames from the first key to the last, at the rate given or else at the keys' own.
    pub(super) fn new(tracks: &[&Track], context: &Context<'_>) -> Result<Self, Error> {
        let seconds = |time: Option<&f32>| time.map_or(0.0, |&time| f64::from(time));
        let firsts = tracks.iter().map(|track| seconds(track.times.first()));
        let lasts = tracks.iter().map(|track| seconds(track.times.last()));
        let start = firsts.fold(f64::INFINITY, f64::min);
        let length = lasts.fold(f64::NEG_INFINITY, f64::max) - start;
        let fullest = tracks.iter().map(|track| &track.times[..]);
        let fullest =
            fullest.reduce(|best, next| if next.len() > best.len() { next } else { best });
        let (rate, note) = match context.options.frame_rate {
            Some(given) => (given.per_second(), String::new()),
            None => keys_rate(fullest.unwrap_or_default()),
        };
        // Times of 32 bits round: the last key may come just before its frame.
        let frames = (length * rate + 0.01).floor().max(0.0) + 1.0;
        let most = context.options.limits.frames as u64;
        context.check("the number of frames", frames as u64, most)?;
        Ok(Self {
            rate: FrameRate::new(rate)?,
            frames: frames as usize,
            start,
            note,
        })
    }

    pub(super) fn moment(&self, frame: usize) -> Moment {
        let step = self.rate.frame_seconds();
        let seconds = self.start + frame as f64 * step;
        Moment {
            seconds,
            tolerance: 1e-3 * step + 2.0 * f64::from(f32::EPSILON) * seconds.abs(),
        }
    }
}

/// The rate of a track's keys, and how it was found.
fn keys_rate(times: &[f32]) -> (f64, String) {
    const USUAL: f64 = 30.0;
    const MOST: f64 = 240.0;
    /// Farther apart than this, keys are poses that an animator set.
    const SPARSE_SECONDS: f64 = 0.1;
    let gaps = times
        .windows(2)
        .map(|pair| f64::from(pair[1]) - f64::from(pair[0]));
    let smallest = gaps
        .clone()
        .filter(|&gap| gap > 0.5 / MOST)
        .fold(f64::INFINITY, f64::min);
    if smallest > SPARSE_SECONDS {
        let why = "keys are few and far between";
        return (
            USUAL,
            format!("frame rate: resampled at {USUAL}, since {why}"),
        );
    }
    let length = gaps.clone().sum::<f64>();
    let even = (times.len() - 1) as f64 / length;
    // Times are 32 bits wide, and exporters round them.
    let mut ends = gaps.scan(0.0, |end, gap| {
        *end += gap;
        Some(*end)
    });
    let mut count = 0.0;
    let on_grid = ends.all(|end| {
        count += 1.0;
        (end * even - count).abs() < 0.1
    });
    if on_grid && even <= MOST * 1.01 {
        let customary = customary_rate(1.0 / even);
        // Frames must stay on the keys to the end.
        let drifts = (customary - even).abs() * length > 1e-3;
        let rate = if drifts { even } else { customary };
        return (
            rate,
            format!("frame rate: {rate:.6}, as the keys are spaced"),
        );
    }
    let rate = customary_rate(smallest).min(MOST);
    (
        rate,
        format!("frame rate: resampled at {rate:.6}, since the keys are uneven"),
    )
}

#[cfg(test)]
mod tests {
    use super::keys_rate;

    #[test]
    fn keys_tell_their_rate() {
        let even = |rate: f64, keys: i32| (0..keys).map(move |key| (f64::from(key) / rate) as f32);
        let rate = |times: &[f32]| keys_rate(times).0;
        for known in [24.0, 30.0, 60.0, 120.0] {
            assert_eq!(rate(&even(known, 5000).collect::<Vec<_>>()), known);
        }
        // What is truly another rate stays so.
        let odd: Vec<f32> = even(60.0024, 50_000).collect();
        assert!((rate(&odd) - 60.0024).abs() < 1e-4);
        assert_eq!(rate(&[0.0, 0.033_333, 0.066_667, 0.1, 0.2, 0.5]), 30.0);
        assert_eq!(rate(&[0.0, 1.0, 2.0]), 30.0);
        assert_eq!(rate(&[0.0]), 30.0);
        assert_eq!(rate(&[]), 30.0);
        assert_eq!(rate(&[0.0, 1e-9, 2e-9]), 30.0);
        assert_eq!(rate(&[0.0, 0.003, 0.1]), 240.0);
    }
}
