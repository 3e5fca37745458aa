//! The part of a repair that can be had: where in time it makes something worse, it gives way.
//!
//! A clip is divided into windows. Every frame's share in every measure is known, so each window's
//! part in what got worse is, too. Windows that do most harm for what they mend go half-way back,
//! then farther, until the promise holds.

use super::change::UNKNOWNS;
use super::promise::{PROMISE, Tolerance, Worse};
use crate::series::{Series, SupportName};

/// Length of a window, in seconds.
const WINDOW_S: f64 = 0.6;
/// A window that gives way keeps this part of its repair, and nothing below [`LEAST`].
const KEPT: f64 = 0.5;
const LEAST: f64 = 0.2;
/// So much more than needed is taken back: windows blend into each other.
const MARGIN: f64 = 1.3;
/// Slides above this are visible, in cm/s, as `score` counts them.
const VISIBLE_SLIDE_CM_S: f64 = 10.0;

/// How much of a repair each window keeps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Blend {
    window_s: f64,
    kept: Vec<f64>,
}

impl Blend {
    /// All of it.
    pub(super) fn new(seconds: f64) -> Self {
        let count = (seconds / WINDOW_S).round().max(1.0);
        Self {
            window_s: (seconds / count).max(f64::MIN_POSITIVE),
            kept: vec![1.0; count as usize],
        }
    }

    /// Whether anything is left.
    pub(super) fn is_empty(&self) -> bool {
        self.kept.iter().all(|&kept| kept == 0.0)
    }

    /// From `base`, as far towards `change` as windows keep; both by knots.
    pub(super) fn between(&self, base: &[f64], change: &[f64], knot_s: f64) -> Vec<f64> {
        let frames = base
            .chunks_exact(UNKNOWNS)
            .zip(change.chunks_exact(UNKNOWNS));
        let mut blended = Vec::with_capacity(base.len());
        for (knot, (base, change)) in frames.enumerate() {
            let kept = self.at(knot as f64 * knot_s);
            let pairs = base.iter().zip(change);
            blended.extend(pairs.map(|(base, change)| match kept {
                0.0 => *base,
                1.0 => *change,
                kept => base + kept * (change - base),
            }));
        }
        blended
    }

    /// A smooth step from the middle of one window to that of the next.
    fn at(&self, time_s: f64) -> f64 {
        let place = (time_s / self.window_s - 0.5).clamp(0.0, (self.kept.len() - 1) as f64);
        let (window, t) = (place as usize, place.fract());
        let next = self.kept[(window + 1).min(self.kept.len() - 1)];
        let smooth = t * t * (3.0 - 2.0 * t);
        self.kept[window] + smooth * (next - self.kept[window])
    }

    /// Lets those windows give way that did most of what broke the promise, compared with what
    /// they mended.
    pub(super) fn give_way(&mut self, before: &Series, after: &Series, worse: &[Worse]) {
        let mended = self.sums(before, after, faults);
        for worse in worse {
            let Some(promise) = PROMISE.iter().find(|p| p.measure == worse.measure) else {
                continue;
            };
            let bad = |series: &Series| badness(series, promise, worse.before);
            let harm = self.sums(after, before, bad);
            let total: f64 = harm.iter().sum();
            let allowed = promise.allowed(worse.before);
            let part = match (worse.after - worse.before).abs() {
                grown if grown > allowed => 1.0 - allowed / grown,
                _ => 1.0,
            };
            let mut order: Vec<usize> = (0..self.kept.len())
                .filter(|&window| harm[window] > 0.0 && self.kept[window] > 0.0)
                .collect();
            let price = |window: usize| harm[window] / (mended[window].max(0.0) + 1e-3);
            order.sort_by(|&a, &b| price(b).total_cmp(&price(a)));
            let mut taken_back = 0.0;
            let needed = MARGIN * part * total.max(0.0);
            for window in order {
                let kept = self.kept[window] * KEPT;
                self.kept[window] = if kept < LEAST { 0.0 } else { kept };
                taken_back += harm[window];
                if taken_back >= needed {
                    break;
                }
            }
        }
    }

    /// Nothing that can be told from single frames helps: everything gives way.
    pub(super) fn give_way_everywhere(&mut self) {
        for kept in &mut self.kept {
            let less = *kept * KEPT;
            *kept = if less < LEAST { 0.0 } else { less };
        }
    }

    /// By windows, what a quantity of frames is greater by in the one series than in the other.
    fn sums(
        &self,
        one: &Series,
        other: &Series,
        quantity: impl Fn(&Series) -> Vec<f64>,
    ) -> Vec<f64> {
        let mut sums = vec![0.0; self.kept.len()];
        let pairs = quantity(one).into_iter().zip(quantity(other));
        for (&time, (one, other)) in one.time_s.iter().zip(pairs) {
            let window = (time / self.window_s) as usize;
            sums[window.min(self.kept.len() - 1)] += one - other;
        }
        sums
    }
}

/// What a repair mends, frame by frame, in units of what is hardly visible.
fn faults(series: &Series) -> Vec<f64> {
    let volumes = values(series.self_intersection_cm3.as_ref(), |volume| volume / 5.0);
    let heights = values(series.lowest_skin_cm.as_ref(), |lowest| lowest.abs() / 0.3);
    let slides = values(series.slide_cm_s.as_ref(), |slide| slide / 2.0);
    let frames = 0..series.time_s.len();
    let at = |values: &[f64], frame: usize| values.get(frame).copied().unwrap_or(0.0);
    frames
        .map(|frame| at(&volumes, frame) + at(&heights, frame) + at(&slides, frame))
        .collect()
}

/// How bad each frame is by a measure; empty where a measure is not one of single frames.
fn badness(series: &Series, promise: &Tolerance, before: f64) -> Vec<f64> {
    let volumes = series.self_intersection_cm3.as_ref();
    let lowest = series.lowest_skin_cm.as_ref();
    let slides = series.slide_cm_s.as_ref();
    let most = before + promise.allowed(before);
    match promise.measure {
        "self_intersection_mean_cm3" => values(volumes, |volume| volume),
        "self_intersection_worst_cm3" => values(volumes, |volume| (volume - most).max(0.0)),
        "ground_penetration_mean_cm" => values(lowest, |lowest| (-lowest).max(0.0)),
        "ground_penetration_worst_cm" => values(lowest, |lowest| (-lowest - most).max(0.0)),
        "ground_floating_mean_cm" => values(lowest, |lowest| lowest.max(0.0)),
        "ground_unsupported_percent" => {
            let support = series.support.iter().flatten();
            let nothing = |support: &SupportName| *support == SupportName::Nothing;
            support
                .map(|name| f64::from(u8::from(nothing(name))))
                .collect()
        }
        "feet_slide_mean_cm_s" => values(slides, |slide| slide),
        "feet_slide_frames_percent" => values(slides, |slide| {
            f64::from(u8::from(slide > VISIBLE_SLIDE_CM_S))
        }),
        "balance_stable_percent" => {
            distances(series, |distance| f64::from(u8::from(distance >= 0.0)))
        }
        "balance_outside_mean_cm" => distances(series, |distance| distance.max(0.0)),
        "smoothness_jerk_mean_m_s3" | "smoothness_jitter_mean_mm" => {
            let jerks = series.jerk_m_s3.iter().flatten();
            jerks.map(|jerk| jerk.unwrap_or(0.0)).collect()
        }
        _ => Vec::new(),
    }
}

fn values(of_frames: Option<&Vec<f64>>, value: impl Fn(f64) -> f64) -> Vec<f64> {
    let of_frames = of_frames.into_iter().flatten();
    of_frames.map(|&found| value(found)).collect()
}

fn distances(series: &Series, value: impl Fn(f64) -> f64) -> Vec<f64> {
    let distances = series.zero_moment_distance_cm.iter().flatten();
    distances
        .map(|distance| distance.map_or(0.0, &value))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_that_do_harm_give_way_and_others_stay() {
        let frames = 180;
        let series = |slide: &dyn Fn(usize) -> f64| Series {
            time_s: (0..frames).map(|frame| frame as f64 / 30.0).collect(),
            self_intersection_cm3: Some(vec![10.0; frames]),
            slide_cm_s: Some((0..frames).map(slide).collect()),
            ..Series::default()
        };
        let before = series(&|_| 1.0);
        // The fourth second slides.
        let after = series(&|frame| if frame / 30 == 3 { 9.0 } else { 0.9 });
        let worse = [Worse {
            measure: "feet_slide_mean_cm_s".into(),
            before: 1.0,
            after: 2.25,
        }];
        let mut blend = Blend::new(6.0);
        for _ in 0..3 {
            blend.give_way(&before, &after, &worse);
        }
        let knots = 180;
        let (base, change) = (vec![0.0; knots * UNKNOWNS], vec![1.0; knots * UNKNOWNS]);
        let blended = blend.between(&base, &change, 1.0 / 30.0);
        let at = |second: f64| blended[(second * 30.0) as usize * UNKNOWNS];
        assert_eq!([at(0.5), at(1.5), at(5.5)], [1.0; 3]);
        assert_eq!(at(3.4), 0.0);
        assert!(!blend.is_empty());
    }
}
