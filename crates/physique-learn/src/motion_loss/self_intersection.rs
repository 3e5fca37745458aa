//! The self-intersection loss of generated motions.

use physique_motion::features::{FeatureStatistics, GradientRule};
use physique_proxy::{FeatureBatch, FeatureLoss, Pairs, open_proxy_with};
use serde::{Deserialize, Serialize};

use super::{LossAndGradient, MotionLoss, check};
use crate::Error;

/// How much bodies of generated motions pass through themselves: "Self-intersection-aware motion
/// generation", BMVC 2025, equation 8.
///
/// Features are taken out of their normalisation and posed by [`FeatureLoss`]. Where the paper is
/// silent: a motion's loss is the mean over its own frames, padding does not count; every motion
/// counts as much as any other, and so does every step of diffusion; the body has one shape and its
/// spheres do not learn.
#[derive(Debug)]
pub struct SelfIntersectionLoss {
    loss: FeatureLoss,
    statistics: FeatureStatistics,
    #[cfg(feature = "cubecl")]
    on_gpu: super::GpuSelfIntersection,
}

/// By what the self-intersection of the embedded body is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SelfIntersectionSettings {
    /// Spheres: 128, 192 or 256.
    pub spheres: usize,
    /// Which pairs of them are compared.
    pub pairs: SpherePairs,
    /// How far gradients reach through the rotation layer. That of the published program,
    /// [`GradientRule::ParentsConstant`], is no derivative, and training by it raised the loss:
    /// docs/training.md has numbers.
    pub gradient: GradientRule,
}

impl Default for SelfIntersectionSettings {
    fn default() -> Self {
        Self {
            spheres: 192,
            pairs: SpherePairs::Reduced,
            gradient: GradientRule::Full,
        }
    }
}

/// Which pairs of spheres the loss compares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpherePairs {
    /// Those that do not touch in most poses of real motion.
    #[default]
    Reduced,
    /// All, those too that always touch: neighbours in a limb.
    All,
}

impl SelfIntersectionLoss {
    /// A loss for features that are normalised by `statistics`; `loss` must be for their skeleton.
    pub fn new(loss: FeatureLoss, statistics: FeatureStatistics) -> Self {
        Self {
            #[cfg(feature = "cubecl")]
            on_gpu: super::GpuSelfIntersection::new(&loss, &statistics),
            loss,
            statistics,
        }
    }

    /// The loss of the embedded open body in its mean shape.
    ///
    /// # Errors
    /// For a number of spheres that no embedded proxy has.
    pub fn embedded(
        statistics: &FeatureStatistics,
        settings: SelfIntersectionSettings,
    ) -> Result<Self, Error> {
        let proxy = open_proxy_with(settings.spheres)?;
        let pairs = match settings.pairs {
            SpherePairs::Reduced => proxy.pairs()?,
            SpherePairs::All => Pairs::all(settings.spheres)?,
        };
        let loss = FeatureLoss::of_open_body_with(&proxy, &pairs, settings.gradient)?;
        Ok(Self::new(loss, statistics.clone()))
    }
}

impl MotionLoss for SelfIntersectionLoss {
    fn evaluate(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<LossAndGradient, Error> {
        check(motions, frames, lengths, self.statistics.mean().len())?;
        let weights = lengths
            .iter()
            .flat_map(|&length| std::iter::repeat_n(1.0 / length as f32, length));
        let found = self.loss.batch(&FeatureBatch {
            skeleton: self.statistics.skeleton(),
            statistics: Some(&self.statistics),
            features: motions,
            frames,
            lengths,
            weights: &weights.collect::<Vec<_>>(),
        })?;
        let mut rest = found.losses.as_slice();
        let means = lengths.iter().map(|&length| {
            let of_motion;
            (of_motion, rest) = rest.split_at(length);
            let sum: f64 = of_motion.iter().copied().map(f64::from).sum();
            (sum / length as f64) as f32
        });
        Ok(LossAndGradient {
            losses: means.collect(),
            gradient: found.by_features,
        })
    }

    #[cfg(feature = "cubecl")]
    fn on_gpu(&self) -> Option<&super::GpuSelfIntersection> {
        Some(&self.on_gpu)
    }
}
