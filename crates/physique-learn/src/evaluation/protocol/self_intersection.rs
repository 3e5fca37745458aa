//! The column of the self-intersection-aware papers.

use physique::body::{Body, Joint};
use physique::{Protocol, ScoreOptions, Scorer};
use physique_motion::features::{MotionFeatures, RotationLayer, recover_from_positions};
use physique_motion::mapping::BodyRest;

use crate::Error;

/// The published voxel metric of features: positions, through the papers' rotation layer, on a body.
///
/// See [`physique::geometry::sia`] for what it counts and where it misleads. Published figures are
/// those of SMPL's mean body; the embedded body gives others.
#[derive(Clone, Debug)]
pub struct SelfIntersectionMeter {
    scorer: Scorer,
    layer: RotationLayer,
    rest: BodyRest,
}

impl SelfIntersectionMeter {
    /// Prepares a body.
    ///
    /// # Errors
    /// [`Error::Score`] for a body whose surface is not closed.
    pub fn new(body: Body) -> Result<Self, Error> {
        let rest = BodyRest::from(&body);
        let options = ScoreOptions {
            protocols: vec![Protocol::Sia],
            ..ScoreOptions::default()
        };
        Ok(Self {
            scorer: Scorer::new(body, options)?,
            layer: RotationLayer::for_body(&rest),
            rest,
        })
    }

    /// Mean over a motion's frames, in "cm3".
    ///
    /// # Errors
    /// [`Error::Motion`] and [`Error::Score`] for numbers that are no motion.
    pub fn measure(&self, features: &MotionFeatures) -> Result<f64, Error> {
        let positions = recover_from_positions(features)?;
        let pelvis = self.rest.joint(Joint::Pelvis);
        let motion = self.layer.motion(&positions, pelvis)?;
        let score = self.scorer.score(&motion)?;
        Ok(score.sia.map_or(f64::NAN, |sia| sia.self_intersection_cm3))
    }

    /// Mean over motions.
    ///
    /// # Errors
    /// As [`Self::measure`].
    pub fn mean(&self, motions: &[MotionFeatures]) -> Result<f64, Error> {
        // Frames of a motion are shared out over threads already.
        let mut sum = 0.0;
        for motion in motions {
            sum += self.measure(motion)?;
        }
        Ok(sum / motions.len() as f64)
    }
}
