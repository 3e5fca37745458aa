//! Losses of where joints are, as losses of features.

use glam::DVec3;
use physique_motion::FrameRate;
use physique_motion::features::{
    FeatureStatistics, MotionFeatures, recover_from_positions, recover_from_positions_gradient,
};
use rayon::prelude::*;

use super::{LossAndGradient, check};
use crate::Error;

/// Joints of the feet.
pub(super) const FEET: usize = 4;

/// Feet of a motion.
pub(super) struct Feet {
    /// `[frames]` positions of ankle and toes of one side, then of the other, in metres, Y up, the
    /// ground at 0.
    pub(super) positions: Vec<[DVec3; FEET]>,
    /// `[frames]` how surely each rests until the next frame, 0 to 1, as the features say.
    pub(super) contacts: Vec<[f64; FEET]>,
    pub(super) frame_seconds: f64,
}

/// A mean over a motion's frames, in f64.
pub(super) trait FeetLoss: Sync {
    /// The loss; adds its gradient by the positions.
    fn of(&self, feet: &Feet, by_positions: &mut [[DVec3; FEET]]) -> f64;
}

/// A loss of all motions of a batch and its gradient by their normalised features.
///
/// Positions are those that published motions are made of: the root's path, and joints relative to
/// it. Contacts are constants: to lift a foot, or to say that it is lifted, is no way out.
pub(super) fn evaluate(
    loss: &impl FeetLoss,
    statistics: &FeatureStatistics,
    motions: &[f32],
    frames: usize,
    lengths: &[usize],
) -> Result<LossAndGradient, Error> {
    let columns = statistics.mean().len();
    check(motions, frames, lengths, columns)?;
    let mut gradient = vec![0.0; motions.len()];
    let motions = motions.par_chunks(frames * columns).zip(lengths);
    let motions = motions.zip(gradient.par_chunks_mut(frames * columns));
    let losses = motions.map(|((motion, &length), by_motion)| {
        let within = length * columns;
        one(
            loss,
            statistics,
            &motion[..within],
            &mut by_motion[..within],
        )
    });
    let losses: Vec<Result<f32, Error>> = losses.collect();
    Ok(LossAndGradient {
        losses: losses.into_iter().collect::<Result<_, _>>()?,
        gradient,
    })
}

/// One motion, without what lies behind its end.
fn one(
    loss: &impl FeetLoss,
    statistics: &FeatureStatistics,
    motion: &[f32],
    by_motion: &mut [f32],
) -> Result<f32, Error> {
    let skeleton = statistics.skeleton();
    let mut values = motion.to_vec();
    statistics.denormalise(&mut values);
    let rate = FrameRate::new(skeleton.frames_per_second())?;
    let features = MotionFeatures::new(rate, skeleton, values)?;
    let positions = recover_from_positions(&features)?;
    let metres = skeleton.metres_per_unit();
    let joints = skeleton.joint_count();
    let foot_joints = skeleton.foot_joints();
    let frames = positions.positions().chunks_exact(joints);
    let frames = frames.map(|frame| foot_joints.map(|joint| frame[joint].as_dvec3() * metres));
    let contact_columns = features.layout().contacts.clone();
    let contacts = features.rows().map(|row| {
        let mut contacts = [0.0; FEET];
        for (contact, number) in contacts.iter_mut().zip(&row[contact_columns.clone()]) {
            *contact = f64::from(*number).clamp(0.0, 1.0);
        }
        contacts
    });
    let feet = Feet {
        positions: frames.collect(),
        contacts: contacts.collect(),
        frame_seconds: rate.frame_seconds(),
    };
    let mut by_feet = vec![[DVec3::ZERO; FEET]; feet.positions.len()];
    let found = loss.of(&feet, &mut by_feet);
    let mut by_positions = vec![DVec3::ZERO; positions.positions().len()];
    for (by_frame, by_feet) in by_positions.chunks_exact_mut(joints).zip(by_feet) {
        for (joint, by_foot) in foot_joints.into_iter().zip(by_feet) {
            by_frame[joint] = by_foot * metres;
        }
    }
    let by_features = recover_from_positions_gradient(&features, &by_positions)?;
    let deviations = statistics.deviation().iter().cycle();
    for ((by, by_feature), &deviation) in by_motion.iter_mut().zip(by_features).zip(deviations) {
        *by = (by_feature * f64::from(deviation)) as f32;
    }
    Ok(found as f32)
}
