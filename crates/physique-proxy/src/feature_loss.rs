//! The self-intersection loss of what networks generate: HumanML3D's and KIT's features.

mod joints;

use physique_body::{Body, Joint, open_body};
use physique_motion::features::{
    FeatureSkeleton, FeatureStatistics, GradientRule, MotionFeatures, RotationLayer,
};
use physique_motion::mapping::BodyRest;

use crate::kernel::Swings;
use crate::{Error, Pairs, SelfIntersection, SphereProxy, open_proxy};

/// Positions of one frame's 22 joints, in [`Joint`]'s order, of any unit of length.
pub type JointFrame = [[f32; 3]; Joint::COUNT];

/// The loss on features, through the paper's rotation layer: features to joint positions, positions
/// to swings of 22 joints, swings to spheres.
///
/// As published, no gradient reaches a joint by its parents' rotations
/// ([`GradientRule::ParentsConstant`]); [`GradientRule::Full`] is the derivative of what is computed.
/// Where the published quaternion formula is 0/0 (bones along their rest direction, a body that
/// faces +Z exactly), value and gradient are finite here.
///
/// A body passes through itself wherever it stands and faces: its path is not recovered, and the
/// columns of the root's velocity have no gradient. The layer is part of the fused kernel, in 32
/// bits; [`RotationLayer`] is its reference. Cost: as [`SelfIntersection`], and a tenth more.
#[derive(Debug)]
pub struct FeatureLoss {
    loss: SelfIntersection,
    layer: RotationLayer,
    swings: Swings,
    rule: GradientRule,
}

/// Features of motions that are measured together.
#[derive(Clone, Copy, Debug)]
pub struct FeatureBatch<'a> {
    /// Which features.
    pub skeleton: FeatureSkeleton,
    /// What they are normalised by; `None` where they are not.
    pub statistics: Option<&'a FeatureStatistics>,
    /// `[motions][frames][columns]`.
    pub features: &'a [f32],
    /// Frames of the longest motion, or more.
    pub frames: usize,
    /// Frames of each motion; what lies behind does not count, and may be anything.
    pub lengths: &'a [usize],
    /// What each frame's loss counts in the gradient, for all frames within motions, one motion
    /// after the other.
    pub weights: &'a [f32],
}

/// Losses of frames, and the gradient of their weighted sum.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureGradient {
    /// Of all frames within motions, one motion after the other.
    pub losses: Vec<f32>,
    /// By the features, in their shape.
    pub by_features: Vec<f32>,
}

impl FeatureLoss {
    /// The loss of a body; `layer` must be for the skeleton of the features
    /// ([`RotationLayer::published`]), or for the body ([`RotationLayer::for_body`]).
    pub fn new(loss: SelfIntersection, layer: &RotationLayer, rule: GradientRule) -> Self {
        let swings = Swings::new(layer, rule);
        let layer = layer.clone();
        Self {
            loss,
            layer,
            swings,
            rule,
        }
    }

    /// The loss of poses.
    pub const fn loss(&self) -> &SelfIntersection {
        &self.loss
    }

    /// What makes poses of positions.
    pub const fn layer(&self) -> &RotationLayer {
        &self.layer
    }

    /// How far a rotation's gradient reaches.
    pub const fn rule(&self) -> GradientRule {
        self.rule
    }

    /// The loss of the embedded open body in its mean shape: bones point where the features have
    /// them, their lengths are the body's. No file needed.
    ///
    /// # Errors
    /// None in practice: the tests use it.
    pub fn of_open_body(rule: GradientRule) -> Result<Self, Error> {
        let proxy = open_proxy()?;
        Self::of_open_body_with(&proxy, &proxy.pairs()?, rule)
    }

    /// The same with another proxy of the open body, or other pairs: for the paper's ablations.
    ///
    /// # Errors
    /// [`Error`] when proxy and pairs do not fit the body or each other.
    pub fn of_open_body_with(
        proxy: &SphereProxy,
        pairs: &Pairs,
        rule: GradientRule,
    ) -> Result<Self, Error> {
        let body = Body::new(open_body()?, &[])?;
        let loss = SelfIntersection::new(&proxy.of_body(&body)?, pairs)?;
        let layer = RotationLayer::for_body(&BodyRest::from(&body));
        Ok(Self::new(loss, &layer, rule))
    }

    /// The loss of every frame of a motion.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`] for features that are no numbers, or too large.
    pub fn losses(&self, motion: &MotionFeatures) -> Result<Vec<f32>, Error> {
        let joints = batch_of(motion, &[motion.frame_count()], &[]).joints();
        let mut losses = vec![0.0; joints.len()];
        self.loss
            .of_joints(&self.swings, &joints, &mut losses, None)?;
        Ok(losses)
    }

    /// The loss of every frame of a motion, and the gradient of `sum of weight * loss` by its
    /// features.
    ///
    /// # Errors
    /// As [`FeatureLoss::losses`], and [`Error::Length`] unless there is one weight a frame.
    pub fn gradient(
        &self,
        motion: &MotionFeatures,
        weights: &[f32],
    ) -> Result<FeatureGradient, Error> {
        self.batch(&batch_of(motion, &[motion.frame_count()], weights))
    }

    /// The loss of every frame of motions, and the gradient of `sum of weight * loss` by their
    /// features, on all threads.
    ///
    /// # Errors
    /// As [`FeatureLoss::gradient`], frames counted through all motions; [`Error::Batch`] unless
    /// counts fit each other and the skeleton.
    pub fn batch(&self, batch: &FeatureBatch<'_>) -> Result<FeatureGradient, Error> {
        batch.check()?;
        let joints = batch.joints();
        let mut losses = vec![0.0; joints.len()];
        let mut by_joints = vec![[[0.0; 3]; Joint::COUNT]; joints.len()];
        let gradient = Some((batch.weights, &mut by_joints[..]));
        self.loss
            .of_joints(&self.swings, &joints, &mut losses, gradient)?;
        Ok(FeatureGradient {
            losses,
            by_features: batch.gradient(&by_joints, self.rule),
        })
    }
}

/// A batch of one motion.
fn batch_of<'a>(
    motion: &'a MotionFeatures,
    lengths: &'a [usize; 1],
    weights: &'a [f32],
) -> FeatureBatch<'a> {
    FeatureBatch {
        skeleton: motion.skeleton(),
        statistics: None,
        features: motion.values(),
        frames: motion.frame_count(),
        lengths,
        weights,
    }
}
