//! Two bodies against each other.

use glam::DVec3;
use rayon::prelude::*;

use super::actor::{PosedActor, finite, length};
use super::{Actor, ActorGradient, SceneOptions};
use crate::{Error, PoseMatrices};

/// Every frame's loss, `sum over all pairs of a sphere of one body and one of the other of
/// penalty(max(0, r_i + r_j - |c_i - c_j| - tolerance))`, into `losses`; and, where asked for, the
/// gradient of `sum of weight * loss` for both.
///
/// # Errors
/// As [`super::obstacle_loss`]; the bodies must have as many frames.
pub fn body_loss(
    actors: [&Actor<'_>; 2],
    options: &SceneOptions,
    weights: &[f32],
    losses: &mut [f32],
    gradients: Option<[ActorGradient<'_>; 2]>,
) -> Result<(), Error> {
    let frames = actors[0].poses.len();
    for actor in actors {
        actor.check()?;
    }
    length("Poses of the second body", frames, actors[1].poses.len())?;
    length("Weights", frames, weights.len())?;
    length("Losses", frames, losses.len())?;
    let evaluate = |frame: usize| {
        let mut posed = actors.map(|actor| actor.posed(frame));
        let loss = touch(&mut posed, options, f64::from(weights[frame]));
        (loss as f32, posed)
    };
    match gradients {
        None => losses
            .par_iter_mut()
            .enumerate()
            .for_each(|(frame, loss)| *loss = evaluate(frame).0),
        Some([first, second]) => {
            first.check(frames)?;
            second.check(frames)?;
            let results: Vec<_> = (0..frames)
                .into_par_iter()
                .map(|frame| {
                    let (loss, posed) = evaluate(frame);
                    (loss, posed.map(|posed| posed.gradient()))
                })
                .collect();
            for (frame, (loss, [by_first, by_second])) in results.into_iter().enumerate() {
                losses[frame] = loss;
                (first.by_poses[frame], first.by_translations[frame]) = by_first;
                (second.by_poses[frame], second.by_translations[frame]) = by_second;
            }
        }
    }
    // The first body's poses may be sound where the second's are not.
    let sound = |pose: &PoseMatrices| pose.as_flattened().iter().all(|number| number.is_finite());
    let frame = losses.iter().position(|loss| !loss.is_finite());
    let first = frame.is_none_or(|frame| !sound(&actors[0].poses[frame]));
    finite(actors[usize::from(!first)].poses, losses)
}

/// The loss of one frame; adds `weight` times its gradient.
fn touch(posed: &mut [PosedActor<'_>; 2], options: &SceneOptions, weight: f64) -> f64 {
    let [first, second] = posed;
    let (low, high) = bounds(second);
    let mut loss = first.poison() + second.poison();
    for i in 0..first.body.sphere_count() {
        let (centre, radius) = (first.posed.centres[i], f64::from(first.body.radii[i]));
        // Far from the whole other body; NaN is not far.
        if ((centre + radius).cmplt(low) | (centre - radius).cmpgt(high)).any() {
            continue;
        }
        for j in 0..second.body.sphere_count() {
            let apart = centre - second.posed.centres[j];
            let touching = radius + f64::from(second.body.radii[j]);
            let depth = touching - apart.length() - options.tolerance;
            if depth > 0.0 || depth.is_nan() {
                let (cost, by_depth) = options.penalty.of(depth);
                loss += cost;
                let push = apart.normalize_or_zero() * (by_depth * weight);
                first.by_centres[i] -= push;
                second.by_centres[j] += push;
            }
        }
    }
    loss
}

/// The box around all spheres.
fn bounds(posed: &PosedActor<'_>) -> (DVec3, DVec3) {
    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    posed
        .spheres()
        .fold(nothing, |(low, high), (centre, radius)| {
            (low.min(centre - radius), high.max(centre + radius))
        })
}
