//! Frames in which nothing moves.

use physique_body::Joint;

use super::track::JointTrack;
use super::{Defect, DefectKind, DefectLimits};

/// A joint that moves less than this, in metres, stands still: below any recording's noise.
const STILL_M: f32 = 1e-5;
/// The same for turns, in radians.
const STILL_RADIANS: f32 = 1e-5;

/// Long standstills, and frames that are shown several times while the body moves.
pub(super) fn find(track: &JointTrack<'_>, limits: &DefectLimits) -> Vec<Defect> {
    let still: Vec<bool> = (0..track.steps())
        .map(|frame| is_still(track, frame))
        .collect();
    let frame_s = track.frame_s();
    let long = (limits.frozen_s / frame_s).ceil().max(1.0) as usize;
    let (mut longest, mut repeated, mut moving) = (0..0, 0, 0);
    let mut begin = 0;
    for run in still.chunk_by(|a, b| a == b) {
        let range = begin..begin + run.len();
        begin = range.end;
        match (run[0], run.len() >= long) {
            (true, true) if range.len() > longest.len() => longest = range,
            (true, true) => {}
            (true, false) => repeated += run.len(),
            (false, _) => moving += run.len(),
        }
    }
    let mut defects = Vec::new();
    if !longest.is_empty() {
        let [from, to] = [longest.start, longest.end].map(|frame| frame as f64 * frame_s);
        let message = format!("Nothing moves from {from:.2} to {to:.2} s.");
        let seconds = to - from;
        defects.push(Defect::measured(
            DefectKind::Frozen,
            message,
            Some(from),
            seconds,
            limits.frozen_s,
        ));
    }
    let share = 100.0 * repeated as f64 / (repeated + moving).max(1) as f64;
    if share > limits.repeated_percent {
        let stated = 1.0 / frame_s;
        let message = format!(
            "{share:.0} % of the frames repeat the one before: the true frame rate is probably \
             {:.0} a second, not {stated:.0}.",
            stated * (1.0 - share / 100.0),
        );
        defects.push(Defect::measured(
            DefectKind::RepeatedFrames,
            message,
            None,
            share,
            limits.repeated_percent,
        ));
    }
    defects
}

fn is_still(track: &JointTrack<'_>, frame: usize) -> bool {
    Joint::ALL.into_iter().all(|joint| {
        let step = track.step(frame, joint);
        step.metres < STILL_M && step.radians < STILL_RADIANS
    })
}
