//! Is the zero moment point inside the base of support?

use rayon::prelude::*;

use crate::{FramePhysics, SupportPolygon, TimeFilter};

/// Sets the signed distances of the zero moment points to the bases of support around them.
///
/// The zero moment point is that of a motion averaged over time: a mean of the points around it.
/// At a step the true point runs from foot to foot within a tenth of a second, and the mean is on
/// its way while the base of one frame has already jumped. So it is held against the mean of the
/// bases of support by the same weights: it lies inside whenever the true points lie inside theirs.
/// Frames without contact, which bear nothing, are left out of the mean.
pub(crate) fn judge(frames: &mut [FramePhysics], filter: &TimeFilter) {
    let distances: Vec<_> = (0..frames.len())
        .into_par_iter()
        .map(|frame| distance(frames, frame, filter))
        .collect();
    for (frame, distance) in frames.iter_mut().zip(distances) {
        frame.zero_moment_distance_m = distance;
    }
}

fn distance(frames: &[FramePhysics], frame: usize, filter: &TimeFilter) -> Option<f64> {
    let point = frames[frame].zero_moment_point?;
    let around = &frames[frame - filter.reach()..=frame + filter.reach()];
    let bases = filter.taps(0).iter().zip(around);
    let bases =
        bases.filter_map(|(&weight, frame)| Some((weight, frame.base_of_support.as_ref()?)));
    Some(SupportPolygon::mean(bases)?.signed_distance(point))
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};
    use physique_motion::FrameRate;

    use super::*;
    use crate::{Centroid, GRAVITY, Support};

    const HEIGHT: f64 = 0.9;
    /// From one foot to the other: half the width of a step, and the time of a step.
    const HALF_WIDTH: f64 = 0.06;
    const STEP_S: f64 = 0.55;

    /// The foot, -1 or 1, that bears the walker, and the time since half-way through its step.
    fn step(time: f64) -> (f64, f64) {
        let steps = (time / STEP_S).floor();
        let foot = 1.0 - 2.0 * steps.rem_euclid(2.0);
        (foot, time - (steps + 0.5) * STEP_S)
    }

    /// Centre of mass of an inverted pendulum whose zero moment point jumps from foot to foot:
    /// the periodic solution of `c'' = (c - z) g / h`.
    fn centre(time: f64) -> f64 {
        let (foot, since) = step(time);
        let rate = (GRAVITY / HEIGHT).sqrt();
        foot * HALF_WIDTH * (1.0 - (rate * since).cosh() / (rate * STEP_S / 2.0).cosh())
    }

    fn walker(fps: f64, filter: &TimeFilter) -> Vec<FramePhysics> {
        let frame = |index: usize| {
            let taps = |order: usize| -> f64 {
                let first = index as f64 - filter.reach() as f64;
                let taps = filter.taps(order).iter().enumerate();
                taps.map(|(k, tap)| tap * centre((first + k as f64) / fps))
                    .sum()
            };
            let centroid = Centroid {
                mass: 70.0,
                centre: DVec3::new(taps(0), HEIGHT, 0.0),
                acceleration: DVec3::X * taps(2),
                ..Centroid::default()
            };
            let foot = step(index as f64 / fps).0 * HALF_WIDTH;
            let corner = |x: f64, z: f64| DVec2::new(foot + 0.04 * x, 0.1 * z);
            let mut corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, z)| corner(x, z))
                .to_vec();
            FramePhysics {
                lowest_m: 0.0,
                support: Support::Ground,
                slide_m_s: 0.0,
                centre_of_mass: DVec3::new(centre(index as f64 / fps), HEIGHT, 0.0),
                base_of_support: SupportPolygon::around(&mut corners),
                centre_of_pressure: None,
                centroid: Some(centroid),
                zero_moment_point: centroid.zero_moment_point(0.0),
                zero_moment_distance_m: None,
                margin_of_stability_m: None,
                smoothness: None,
            }
        };
        (0..(6.0 * fps) as usize)
            .map(|index| {
                let mut frame = frame(index);
                if !filter.covers(index, (6.0 * fps) as usize) {
                    frame.zero_moment_point = None;
                }
                frame
            })
            .collect()
    }

    #[test]
    fn a_walker_whose_true_points_are_in_the_middle_of_the_feet_is_stable_at_every_rate() {
        for fps in [20.0, 30.0, 60.0, 120.0] {
            let filter = TimeFilter::averaging(FrameRate::new(fps).unwrap(), 3.0).unwrap();
            let mut frames = walker(fps, &filter);
            judge(&mut frames, &filter);
            let found: Vec<_> = frames
                .iter()
                .filter_map(|f| f.zero_moment_distance_m)
                .collect();
            assert!(found.len() > frames.len() / 2);
            // 4 cm inside; sampling leaves half a frame in doubt when the point jumps, and a
            // frame next to it weighs 9 / fps.
            let tolerance = 2.0 * HALF_WIDTH * 0.5 * 9.0 / fps + 1e-3;
            for distance in found {
                assert!((distance + 0.04).abs() < tolerance, "{fps} fps: {distance}");
                assert!(distance < 0.0);
            }
        }
    }

    #[test]
    fn against_the_base_of_one_frame_the_same_walker_would_seem_to_fall() {
        let filter = TimeFilter::averaging(FrameRate::new(60.0).unwrap(), 3.0).unwrap();
        let outside = walker(60.0, &filter)
            .iter()
            .filter_map(|f| {
                Some(
                    f.base_of_support
                        .as_ref()?
                        .signed_distance(f.zero_moment_point?),
                )
            })
            .filter(|&distance| distance > 0.0)
            .count();
        assert!(outside > 20, "{outside}");
    }

    #[test]
    fn a_walker_beside_its_feet_is_unstable() {
        let filter = TimeFilter::averaging(FrameRate::new(60.0).unwrap(), 3.0).unwrap();
        let mut frames = walker(60.0, &filter);
        for frame in &mut frames {
            frame.zero_moment_point = frame.zero_moment_point.map(|p| p + DVec2::X * 0.06);
        }
        judge(&mut frames, &filter);
        for distance in frames.iter().filter_map(|f| f.zero_moment_distance_m) {
            assert!((distance - 0.02).abs() < 0.01, "{distance}");
        }
    }
}
