//! The self-intersection loss of generated motions.

use physique_motion::FrameRate;
use physique_motion::features::{FeatureStatistics, MotionFeatures};
use physique_proxy::FeatureLoss;

use super::{LossAndGradient, MotionLoss};
use crate::Error;

/// How much bodies of generated motions pass through themselves: "Self-intersection-aware motion
/// generation", BMVC 2025, equation 8.
///
/// Features are taken out of their normalisation and posed by [`FeatureLoss`]; a motion's loss is
/// the mean over its own frames. Where the paper is silent: frames behind the end do not count,
/// every step of diffusion counts alike, and each motion as much as any other.
#[derive(Debug)]
pub struct SelfIntersectionLoss {
    loss: FeatureLoss,
    statistics: FeatureStatistics,
    frame_rate: FrameRate,
}

impl SelfIntersectionLoss {
    /// A loss for features that are normalised by `statistics`, and of their skeleton.
    pub const fn new(
        loss: FeatureLoss,
        statistics: FeatureStatistics,
        frame_rate: FrameRate,
    ) -> Self {
        Self {
            loss,
            statistics,
            frame_rate,
        }
    }
}

impl MotionLoss for SelfIntersectionLoss {
    fn evaluate(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<LossAndGradient, Error> {
        let columns = self.statistics.mean().len();
        let motion = frames * columns;
        let fits = motions.len() == lengths.len() * motion;
        if !fits || lengths.iter().any(|length| !(1..=frames).contains(length)) {
            let expected = format!("{} of up to {frames} x {columns}", lengths.len());
            let found = format!("{} numbers, lengths {lengths:?}", motions.len());
            return Err(Error::input("Motions", expected, found));
        }
        let mut batch = Vec::with_capacity(lengths.len());
        for (motion, &length) in motions.chunks_exact(motion.max(1)).zip(lengths) {
            let mut features = motion[..length * columns].to_vec();
            self.statistics.denormalise(&mut features);
            let skeleton = self.statistics.skeleton();
            let features = MotionFeatures::new(self.frame_rate, skeleton, features)?;
            batch.push((features, vec![1.0 / length as f32; length]));
        }
        let found = self.loss.batch(&batch)?;
        let mut gradient = vec![0.0; motions.len()];
        for (found, gradient) in found.iter().zip(gradient.chunks_exact_mut(motion.max(1))) {
            let deviations = self.statistics.deviation().iter().cycle();
            let by_features = found.by_features.iter().zip(deviations);
            for (by, (by_feature, &deviation)) in gradient.iter_mut().zip(by_features) {
                *by = (by_feature * f64::from(deviation)) as f32;
            }
        }
        let mean = |losses: &[f32]| {
            let sum: f64 = losses.iter().copied().map(f64::from).sum();
            (sum / losses.len() as f64) as f32
        };
        Ok(LossAndGradient {
            losses: found.iter().map(|motion| mean(&motion.losses)).collect(),
            gradient,
        })
    }
}
