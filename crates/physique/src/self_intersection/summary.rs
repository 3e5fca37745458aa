//! Self-intersection of a whole motion.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::FrameIntersections;

/// A frame counts as intersecting above this volume: half a hand's worth of noise is let pass.
const THRESHOLD_CM3: f64 = 50.0;
/// A pair counts as overlapping above this volume, about one line of the scan through a finger.
const PAIR_THRESHOLD_CM3: f64 = 1.0;

/// How much a body passes through itself over a motion. Means are over all frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SelfIntersection {
    /// Distance between the lines of the scan, in metres.
    pub spacing_m: f64,
    /// Mean volume of parts inside other parts, in cm3.
    pub mean_cm3: f64,
    /// The same in per cent of the body's volume.
    pub mean_percent_of_body: f64,
    /// Largest volume of a frame, in cm3.
    pub worst_cm3: f64,
    /// Which frame that is, from 0.
    pub worst_frame: usize,
    /// When that is, in seconds.
    pub worst_s: f64,
    /// Frames with more than 50 cm3, in per cent.
    pub frames_above_50_cm3_percent: f64,
    /// Mean volume of creases (skin folds between neighbouring parts), in cm3. Not part of the
    /// other figures.
    pub crease_mean_cm3: f64,
    /// Pairs of parts that overlap in some frame, worst mean first; creases behind the others.
    pub pairs: Vec<PairSummary>,
}

/// How much two parts of the body overlap over a motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PairSummary {
    /// The two parts, in everyday words.
    pub parts: [String; 2],
    /// Whether this is a crease between neighbours.
    pub crease: bool,
    /// Mean volume over all frames, in cm3.
    pub mean_cm3: f64,
    /// Largest volume of a frame, in cm3.
    pub worst_cm3: f64,
    /// When that is, in seconds.
    pub worst_s: f64,
    /// Frames with more than 1 cm3, in per cent.
    pub frames_percent: f64,
    /// When the pair overlaps by more than 1 cm3: start and end in seconds.
    pub intervals_s: Vec<[f64; 2]>,
}

impl SelfIntersection {
    /// Summarises frames that are `frame_s` seconds apart; `None` without frames.
    pub(crate) fn summarise(
        frames: &[FrameIntersections],
        frame_s: f64,
        spacing_m: f64,
        body_cm3: f64,
    ) -> Option<Self> {
        let count = frames.len();
        let mean =
            |of: fn(&FrameIntersections) -> f64| frames.iter().map(of).sum::<f64>() / count as f64;
        // The first of equals, so that the time does not depend on the direction of the search.
        let (worst_frame, worst) = frames.iter().enumerate().reduce(|best, next| {
            if next.1.intersection_cm3 > best.1.intersection_cm3 {
                next
            } else {
                best
            }
        })?;
        let mean_cm3 = mean(|frame| frame.intersection_cm3);
        let above = frames
            .iter()
            .filter(|frame| frame.intersection_cm3 > THRESHOLD_CM3)
            .count();
        Some(Self {
            spacing_m,
            mean_cm3,
            mean_percent_of_body: 100.0 * mean_cm3 / body_cm3,
            worst_cm3: worst.intersection_cm3,
            worst_frame,
            worst_s: worst_frame as f64 * frame_s,
            frames_above_50_cm3_percent: percent(above, count),
            crease_mean_cm3: mean(|frame| frame.crease_cm3),
            pairs: pairs(frames, frame_s),
        })
    }
}

fn percent(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole as f64
}

fn pairs(frames: &[FrameIntersections], frame_s: f64) -> Vec<PairSummary> {
    let mut series = BTreeMap::<_, Vec<(usize, f64)>>::new();
    for (number, frame) in frames.iter().enumerate() {
        for pair in &frame.pairs {
            let key = (pair.crease, pair.parts);
            series.entry(key).or_default().push((number, pair.cm3));
        }
    }
    let mut pairs: Vec<_> = series
        .into_iter()
        .map(|((crease, parts), volumes)| {
            let (worst_frame, worst_cm3) = volumes
                .iter()
                .copied()
                .reduce(|best, next| if next.1 > best.1 { next } else { best })
                .unwrap_or_default();
            let overlapping: Vec<usize> = volumes
                .iter()
                .filter(|&&(_, cm3)| cm3 > PAIR_THRESHOLD_CM3)
                .map(|&(number, _)| number)
                .collect();
            PairSummary {
                parts: parts.map(|part| part.part_name().to_owned()),
                crease,
                mean_cm3: volumes.iter().map(|&(_, cm3)| cm3).sum::<f64>() / frames.len() as f64,
                worst_cm3,
                worst_s: worst_frame as f64 * frame_s,
                frames_percent: percent(overlapping.len(), frames.len()),
                intervals_s: intervals(&overlapping)
                    .map(|[first, last]| [first as f64 * frame_s, (last + 1) as f64 * frame_s])
                    .collect(),
            }
        })
        .collect();
    // Stable: equal means stay in the order of the parts.
    pairs.sort_by(|a, b| (a.crease.cmp(&b.crease)).then(b.mean_cm3.total_cmp(&a.mean_cm3)));
    pairs
}

/// Runs of consecutive numbers: first and last of each.
fn intervals(numbers: &[usize]) -> impl Iterator<Item = [usize; 2]> + '_ {
    numbers
        .chunk_by(|a, b| a + 1 == *b)
        .map(|run| [run[0], run[run.len() - 1]])
}

#[cfg(test)]
mod tests {
    use physique_body::Joint;

    use super::*;
    use crate::self_intersection::PairVolume;

    fn frame(cm3: f64) -> FrameIntersections {
        let pairs = if cm3 > 0.0 {
            vec![PairVolume {
                parts: [Joint::Spine3, Joint::LeftWrist],
                crease: false,
                cm3,
            }]
        } else {
            Vec::new()
        };
        FrameIntersections {
            intersection_cm3: cm3,
            crease_cm3: 10.0,
            pairs,
        }
    }

    #[test]
    fn tells_which_how_much_and_when() {
        let frames: Vec<_> = [0.0, 60.0, 80.0, 0.0, 20.0].map(frame).into();
        let summary = SelfIntersection::summarise(&frames, 0.5, 0.01, 1000.0).unwrap();
        assert_eq!(summary.mean_cm3, 32.0);
        assert_eq!(summary.mean_percent_of_body, 3.2);
        assert_eq!(
            (summary.worst_cm3, summary.worst_frame, summary.worst_s),
            (80.0, 2, 1.0)
        );
        assert_eq!(summary.frames_above_50_cm3_percent, 40.0);
        assert_eq!(summary.crease_mean_cm3, 10.0);
        let [pair] = &summary.pairs[..] else {
            panic!("one pair")
        };
        assert_eq!(pair.parts, ["chest", "left hand"]);
        assert_eq!(
            (pair.mean_cm3, pair.worst_cm3, pair.worst_s),
            (32.0, 80.0, 1.0)
        );
        assert_eq!(pair.frames_percent, 60.0);
        assert_eq!(pair.intervals_s, [[0.5, 1.5], [2.0, 2.5]]);
    }

    #[test]
    fn nothing_has_no_summary() {
        assert_eq!(SelfIntersection::summarise(&[], 0.1, 0.01, 1.0), None);
    }
}
