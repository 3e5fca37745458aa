//! The physics of a whole motion. Means are over all frames unless a measure says otherwise.

use physique_motion::Motion;

use crate::frame::Filters;
use crate::{FramePhysics, Support};

/// Deeper than this is visible, in metres.
const VISIBLE_DEPTH: f64 = 0.01;
/// Faster than this is visible sliding, in m/s.
const VISIBLE_SLIDE: f64 = 0.1;
/// Friction of shoes on common floors.
const FRICTION: f64 = 0.8;

/// All measures of a motion, in metres and seconds; none depends on the frame rate beyond what the
/// motion loses by being sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct PhysicsMeasures {
    /// Height of the ground that was used, in metres.
    pub ground_height_m: f64,
    /// Skin and ground.
    pub ground: GroundMeasures,
    /// Feet on the ground.
    pub feet: FootMeasures,
    /// Balance.
    pub balance: BalanceMeasures,
    /// Smoothness; `None` for a clip too short to differentiate.
    pub smoothness: Option<SmoothnessMeasures>,
    /// Every frame.
    pub frames: Vec<FramePhysics>,
}

/// How deep the lowest skin is in the ground, and how high above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundMeasures {
    /// Mean depth of the lowest skin, frames above ground counting 0.
    pub penetration_mean_m: f64,
    /// Greatest depth.
    pub penetration_worst_m: f64,
    /// Frames deeper than 1 cm, in per cent.
    pub penetration_frames_percent: f64,
    /// Mean height of the lowest skin, frames on or in the ground or in flight counting 0.
    pub floating_mean_m: f64,
    /// Greatest such height.
    pub floating_worst_m: f64,
    /// Frames without contact that do not fall, in per cent.
    pub unsupported_frames_percent: f64,
    /// Frames of free flight, in per cent.
    pub flight_frames_percent: f64,
}

/// How much the soles slide while they stay on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootMeasures {
    /// Mean speed of the sole points on the ground, frames without any counting 0.
    pub slide_mean_m_s: f64,
    /// Greatest speed of a frame.
    pub slide_worst_m_s: f64,
    /// Frames faster than 0.1 m/s, in per cent.
    pub slide_frames_percent: f64,
}

/// Whether the body could stand as it moves. Frames near the ends, in flight, unsupported or with
/// hardly any load are counted, not judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BalanceMeasures {
    /// Frames that were judged.
    pub measured_frames: usize,
    /// Frames too near to the ends of the clip for derivatives.
    pub border_frames: usize,
    /// Frames in flight, the border aside.
    pub flight_frames: usize,
    /// Frames without contact that do not fall, the border aside.
    pub unsupported_frames: usize,
    /// Frames in contact, with less than 0.3 of the body's weight on the ground.
    pub unloaded_frames: usize,
    /// Measures of the judged frames; `None` where there are none.
    pub measured: Option<MeasuredBalance>,
    /// Cut-off of the derivatives, in Hz.
    pub cutoff_hz: f64,
}

/// Means and percentages of the judged frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredBalance {
    /// Frames whose zero moment point is inside the base of support, in per cent.
    pub stable_percent: f64,
    /// Mean distance of the zero moment point outside the base of support, 0 for those inside.
    pub outside_mean_m: f64,
    /// Mean signed distance of the zero moment point, negative inside.
    pub signed_distance_mean_m: f64,
    /// Mean margin of stability, positive inside.
    pub margin_mean_m: f64,
    /// Least margin of stability.
    pub margin_worst_m: f64,
    /// Mean horizontal distance from the zero moment point to the centre of pressure.
    pub pressure_distance_mean_m: f64,
    /// Frames that need more friction than 0.8, in per cent.
    pub slipping_percent: f64,
}

/// How smoothly the joints move, over all frames with derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothnessMeasures {
    /// Mean speed of the joints.
    pub speed_mean_m_s: f64,
    /// Mean magnitude of the joints' acceleration.
    pub acceleration_mean_m_s2: f64,
    /// Mean magnitude of the joints' jerk.
    pub jerk_mean_m_s3: f64,
    /// Greatest frame of the same.
    pub jerk_worst_m_s3: f64,
    /// Mean distance of the joints from their smoothed paths.
    pub jitter_mean_m: f64,
    /// `-ln(D^3 integral |jerk|^2 dt / v^2)` over the measured duration D with the greatest mean
    /// speed v (Balasubramanian et al., "On the analysis of movement smoothness", 2015): greater
    /// is smoother; `None` for a body at rest.
    pub log_dimensionless_jerk: Option<f64>,
    /// Cut-off of the derivatives, in Hz.
    pub cutoff_hz: f64,
}

impl PhysicsMeasures {
    pub(crate) fn summarise(
        frames: Vec<FramePhysics>,
        ground_height_m: f64,
        filters: &Filters,
        motion: &Motion,
    ) -> Option<Self> {
        if frames.is_empty() {
            return None;
        }
        Some(Self {
            ground_height_m,
            ground: GroundMeasures::of(&frames),
            feet: FootMeasures::of(&frames),
            balance: BalanceMeasures::of(&frames, filters.balance.cutoff_hz()),
            smoothness: SmoothnessMeasures::of(
                &frames,
                motion.frame_rate().frame_seconds(),
                filters.smoothness.cutoff_hz(),
            ),
            frames,
        })
    }
}

impl GroundMeasures {
    fn of(frames: &[FramePhysics]) -> Self {
        let depths = || frames.iter().map(|frame| (-frame.lowest_m).max(0.0));
        let heights = || {
            frames.iter().map(|frame| match frame.support {
                Support::Flight => 0.0,
                Support::Ground | Support::Nothing => frame.lowest_m.max(0.0),
            })
        };
        let percent_of = |kind| percent(frames.iter().map(|frame| frame.support == kind));
        Self {
            penetration_mean_m: mean(depths()).unwrap_or(0.0),
            penetration_worst_m: greatest(depths()),
            penetration_frames_percent: percent(depths().map(|depth| depth > VISIBLE_DEPTH)),
            floating_mean_m: mean(heights()).unwrap_or(0.0),
            floating_worst_m: greatest(heights()),
            unsupported_frames_percent: percent_of(Support::Nothing),
            flight_frames_percent: percent_of(Support::Flight),
        }
    }
}

impl FootMeasures {
    fn of(frames: &[FramePhysics]) -> Self {
        let speeds = || frames.iter().map(|frame| frame.slide_m_s);
        Self {
            slide_mean_m_s: mean(speeds()).unwrap_or(0.0),
            slide_worst_m_s: greatest(speeds()),
            slide_frames_percent: percent(speeds().map(|speed| speed > VISIBLE_SLIDE)),
        }
    }
}

impl BalanceMeasures {
    fn of(frames: &[FramePhysics], cutoff_hz: f64) -> Self {
        let inner = || frames.iter().filter(|frame| frame.centroid.is_some());
        let count = |kind| inner().filter(|frame| frame.support == kind).count();
        let measured = MeasuredBalance::of(frames);
        let measured_frames = judged(frames).count();
        Self {
            measured_frames,
            border_frames: frames.len() - inner().count(),
            flight_frames: count(Support::Flight),
            unsupported_frames: count(Support::Nothing),
            unloaded_frames: count(Support::Ground) - measured_frames,
            measured,
            cutoff_hz,
        }
    }
}

fn judged(frames: &[FramePhysics]) -> impl Iterator<Item = (&FramePhysics, f64)> {
    frames
        .iter()
        .filter_map(|frame| Some((frame, frame.zero_moment_distance_m?)))
}

impl MeasuredBalance {
    fn of(frames: &[FramePhysics]) -> Option<Self> {
        let distances = || judged(frames).map(|(_, distance)| distance);
        let margins = || judged(frames).filter_map(|(frame, _)| frame.margin_of_stability_m);
        let to_pressure = judged(frames).filter_map(|(frame, _)| {
            Some(frame.zero_moment_point?.distance(frame.centre_of_pressure?))
        });
        let slipping = judged(frames)
            .filter_map(|(frame, _)| frame.centroid)
            .map(|centroid| centroid.needed_friction() > FRICTION);
        Some(Self {
            stable_percent: percent(distances().map(|distance| distance < 0.0)),
            outside_mean_m: mean(distances().map(|distance| distance.max(0.0)))?,
            signed_distance_mean_m: mean(distances())?,
            margin_mean_m: mean(margins())?,
            margin_worst_m: margins().fold(f64::MAX, f64::min),
            pressure_distance_mean_m: mean(to_pressure)?,
            slipping_percent: percent(slipping),
        })
    }
}

impl SmoothnessMeasures {
    fn of(frames: &[FramePhysics], frame_s: f64, cutoff_hz: f64) -> Option<Self> {
        let motions = || frames.iter().filter_map(|frame| frame.smoothness);
        let fastest = greatest(motions().map(|joints| joints.speed_m_s));
        let duration = motions().count() as f64 * frame_s;
        let effort = motions()
            .map(|joints| joints.squared_jerk * frame_s)
            .sum::<f64>();
        let dimensionless = duration.powi(3) * effort / (fastest * fastest);
        Some(Self {
            speed_mean_m_s: mean(motions().map(|joints| joints.speed_m_s))?,
            acceleration_mean_m_s2: mean(motions().map(|joints| joints.acceleration_m_s2))?,
            jerk_mean_m_s3: mean(motions().map(|joints| joints.jerk_m_s3))?,
            jerk_worst_m_s3: greatest(motions().map(|joints| joints.jerk_m_s3)),
            jitter_mean_m: mean(motions().map(|joints| joints.jitter_m))?,
            log_dimensionless_jerk: (fastest > 1e-3 && effort > 0.0).then(|| -dimensionless.ln()),
            cutoff_hz,
        })
    }
}

/// Mean; `None` of nothing.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| {
        (sum + value, count + 1)
    });
    (count > 0).then(|| sum / count as f64)
}

/// The greatest, at least 0.
pub(crate) fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

/// How many hold, in per cent; 0 of nothing.
pub(crate) fn percent(values: impl Iterator<Item = bool>) -> f64 {
    100.0 * mean(values.map(|holds| if holds { 1.0 } else { 0.0 })).unwrap_or(0.0)
}
