//! Joints that are elsewhere, or turned, from one frame to the next.

use std::ops::Range;

use physique_body::Joint;

use super::track::{JointTrack, Step};
use super::{Defect, DefectKind, DefectLimits};

/// Steps within this time on either side tell how fast a joint moves there, in seconds,
const AROUND_S: f64 = 0.15;
/// but at least so many of them.
const LEAST_AROUND: usize = 3;
/// A step may be so many times the upper quartile of those around before the limit counts: an
/// arm speeds up by less.
const USUAL: f32 = 3.0;

/// A step that its neighbours do not announce.
struct Jump {
    frame: usize,
    joint: Joint,
    step: Step,
    /// By how much the limit is exceeded; 1 is just at the limit.
    severity: f32,
    by_angle: bool,
}

pub(super) fn find(track: &JointTrack<'_>, limits: &DefectLimits) -> Option<Defect> {
    let mut jumping_frames = 0;
    let mut worst: Option<Jump> = None;
    for frame in 0..track.steps() {
        let jumps = Joint::ALL.map(|joint| jump(track, frame, joint, limits));
        let Some(jump) = jumps
            .into_iter()
            .flatten()
            .reduce(|a, b| if b.severity > a.severity { b } else { a })
        else {
            continue;
        };
        jumping_frames += 1;
        if worst
            .as_ref()
            .is_none_or(|worst| jump.severity > worst.severity)
        {
            worst = Some(jump);
        }
    }
    worst.map(|worst| describe(&worst, jumping_frames, track, limits))
}

fn jump(track: &JointTrack<'_>, frame: usize, joint: Joint, limits: &DefectLimits) -> Option<Jump> {
    let step = track.step(frame, joint);
    let [far, wide] = [
        limits.jump_cm as f32 / 100.0,
        (limits.jump_degrees as f32).to_radians(),
    ];
    // Hardly any step is that large: the neighbours are looked at only then.
    if step.metres <= far && step.radians <= wide {
        return None;
    }
    let around = neighbours(track, frame);
    let steps = || around.clone().filter(|&other| other != frame);
    let usual_metres = upper_quartile(steps().map(|other| track.step(other, joint).metres));
    let usual_radians = upper_quartile(steps().map(|other| track.step(other, joint).radians));
    let by_distance = (step.metres - USUAL * usual_metres) / far;
    let by_angle = (step.radians - USUAL * usual_radians) / wide;
    let severity = by_distance.max(by_angle);
    (severity > 1.0).then_some(Jump {
        frame,
        joint,
        step,
        severity,
        by_angle: by_angle > by_distance,
    })
}

fn neighbours(track: &JointTrack<'_>, frame: usize) -> Range<usize> {
    let reach = ((AROUND_S / track.frame_s()).round() as usize).max(LEAST_AROUND);
    frame.saturating_sub(reach)..(frame + reach + 1).min(track.steps())
}

/// The value that three of four lie below; 0 of nothing.
fn upper_quartile(values: impl Iterator<Item = f32>) -> f32 {
    let mut values: Vec<f32> = values.collect();
    let place = values.len() * 3 / 4;
    if values.is_empty() {
        return 0.0;
    }
    *values.select_nth_unstable_by(place, f32::total_cmp).1
}

fn describe(worst: &Jump, frames: usize, track: &JointTrack<'_>, limits: &DefectLimits) -> Defect {
    let at_s = (worst.frame + 1) as f64 * track.frame_s();
    let step = worst.step;
    let (what, value, limit) = if worst.by_angle {
        let degrees = f64::from(step.radians.to_degrees());
        (
            format!("turns by {degrees:.0} degrees"),
            degrees,
            limits.jump_degrees,
        )
    } else {
        let centimetres = 100.0 * f64::from(step.metres);
        (
            format!("moves {centimetres:.0} cm"),
            centimetres,
            limits.jump_cm,
        )
    };
    let more = match frames {
        1 => String::new(),
        frames => format!(" (the worst of {frames} such frames)"),
    };
    let message = format!(
        "At {at_s:.2} s (frame {}) the {} {what} in one frame{more}.",
        worst.frame + 1,
        worst.joint.name().replace('_', " "),
    );
    Defect::measured(DefectKind::Jump, message, Some(at_s), value, limit)
}
