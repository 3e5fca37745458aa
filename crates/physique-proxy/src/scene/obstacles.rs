//! A body against things that stand still.

use glam::Vec3;
use rayon::prelude::*;

use super::actor::{finite, length};
use super::{Actor, ActorGradient, Obstacle, SceneOptions};
use crate::{Error, PoseMatrices};

/// Every frame's loss, `sum over spheres and obstacles of penalty(max(0, radius - distance -
/// tolerance))`, into `losses`; and, where asked for, the gradient of `sum of weight * loss`.
///
/// # Errors
/// As [`crate::SphereBody::check`]; [`Error::Length`] for slices that disagree;
/// [`Error::NotFinite`] or [`Error::Overflow`] for poses that are no numbers.
pub fn obstacle_loss(
    actor: &Actor<'_>,
    obstacles: &[&dyn Obstacle],
    options: &SceneOptions,
    weights: &[f32],
    losses: &mut [f32],
    gradient: Option<ActorGradient<'_>>,
) -> Result<(), Error> {
    actor.check()?;
    let frames = actor.poses.len();
    length("Weights", frames, weights.len())?;
    length("Losses", frames, losses.len())?;
    let evaluate = |frame: usize| {
        let mut posed = actor.posed(frame);
        let mut loss = posed.poison();
        let mut by_centres = std::mem::take(&mut posed.by_centres);
        for ((centre, radius), by_centre) in posed.spheres().zip(&mut by_centres) {
            for obstacle in obstacles {
                let (distance, outwards) = obstacle.distance(centre);
                let depth = radius - distance - options.tolerance;
                if depth > 0.0 || depth.is_nan() {
                    let (cost, by_depth) = options.penalty.of(depth);
                    loss += cost;
                    *by_centre -= outwards * (by_depth * f64::from(weights[frame]));
                }
            }
        }
        posed.by_centres = by_centres;
        (loss as f32, posed)
    };
    match gradient {
        None => losses
            .par_iter_mut()
            .enumerate()
            .for_each(|(frame, loss)| *loss = evaluate(frame).0),
        Some(gradient) => {
            gradient.check(frames)?;
            let each = |(frame, ((loss, by_pose), by_translation)): (
                usize,
                ((&mut f32, &mut PoseMatrices), &mut Vec3),
            )| {
                let (value, posed) = evaluate(frame);
                *loss = value;
                (*by_pose, *by_translation) = posed.gradient();
            };
            let by_poses = gradient.by_poses.par_iter_mut();
            let frames = losses.par_iter_mut().zip(by_poses);
            frames
                .zip(gradient.by_translations)
                .enumerate()
                .for_each(each);
        }
    }
    finite(actor.poses, losses)
}
