//! What a motion diffusion model learns by.

use physique_motion::features::FeatureStatistics;
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::diffusion::Schedule;
use crate::motion_loss::{
    GroundLoss, SelfIntersectionLoss, SelfIntersectionSettings, SlidingLoss, WeightedLoss,
};

/// How a motion diffusion model is trained. The default is as published, but for the gradient of the
/// self-intersection loss, see [`SelfIntersectionSettings`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MdmTraining {
    /// Motions a step.
    pub batch: usize,
    /// Steps of diffusion.
    pub diffusion_steps: usize,
    /// Factor of the signal-to-noise ratio of every step, see [`Schedule::with_signal`].
    pub signal: f64,
    /// Share of motions that are learnt without their condition, for classifier-free guidance.
    pub unconditioned: f64,
    /// Weight of the squared error in the root's four columns, where that of all others is 1;
    /// features only.
    pub root_weight: f64,
    /// Weight of the squared error of how a motion changes from frame to frame. Of features: joints'
    /// positions, in deviations of their velocities. Of rotations: lambda_vel, as published.
    pub velocity_weight: f64,
    /// Weight of the squared error of joints' positions: lambda_rcxyz; rotations only.
    pub joint_weight: f64,
    /// Weight of how feet move that should stand: lambda_fc; rotations only.
    pub foot_contact_weight: f64,
    /// Weight of the self-intersection of the predicted motions: lambda_SI of SIA-MDM, 0.01 for
    /// HumanML3D and 0.0001 for KIT; see [`SelfIntersectionLoss`].
    pub self_intersection_weight: f64,
    /// By what self-intersection is measured.
    pub self_intersection: SelfIntersectionSettings,
    /// Weight of feet in the ground or above it, see [`GroundLoss`].
    pub ground_weight: f64,
    /// Weight of sliding feet, see [`SlidingLoss`].
    pub sliding_weight: f64,
}

impl Default for MdmTraining {
    fn default() -> Self {
        Self {
            batch: 64,
            diffusion_steps: 1000,
            signal: 1.0,
            unconditioned: 0.1,
            root_weight: 1.0,
            velocity_weight: 0.0,
            joint_weight: 0.0,
            foot_contact_weight: 0.0,
            self_intersection_weight: 0.0,
            self_intersection: SelfIntersectionSettings::default(),
            ground_weight: 0.0,
            sliding_weight: 0.0,
        }
    }
}

impl MdmTraining {
    /// The schedule of diffusion.
    ///
    /// # Errors
    /// [`Error::Setting`] for steps or a signal that cannot be.
    pub fn schedule(&self) -> Result<Schedule, Error> {
        Schedule::cosine(self.diffusion_steps)?.with_signal(self.signal)
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        if self.batch == 0 {
            return Err(Error::setting("batch", "1 or more", self.batch));
        }
        if !(0.0..=1.0).contains(&self.unconditioned) {
            return Err(Error::setting(
                "unconditioned",
                "0 to 1",
                self.unconditioned,
            ));
        }
        for (what, found) in [
            ("root_weight", self.root_weight),
            ("velocity_weight", self.velocity_weight),
            ("joint_weight", self.joint_weight),
            ("foot_contact_weight", self.foot_contact_weight),
            ("self_intersection_weight", self.self_intersection_weight),
            ("ground_weight", self.ground_weight),
            ("sliding_weight", self.sliding_weight),
        ] {
            if !(found.is_finite() && found >= 0.0) {
                return Err(Error::setting(what, "a finite number from 0", found));
            }
        }
        Ok(())
    }

    /// What can only be measured on motions that are features, and does not weigh as in the default.
    ///
    /// # Errors
    /// [`Error::Setting`] with the first such setting.
    pub(super) fn check_rotations(&self) -> Result<(), Error> {
        for (what, found, neutral) in [
            ("root_weight", self.root_weight, 1.0),
            (
                "self_intersection_weight",
                self.self_intersection_weight,
                0.0,
            ),
            ("ground_weight", self.ground_weight, 0.0),
            ("sliding_weight", self.sliding_weight, 0.0),
        ] {
            if found != neutral {
                let expected = format!("{neutral} for motions that are rotations");
                return Err(Error::setting(what, expected, found));
            }
        }
        Ok(())
    }

    /// As [`MdmTraining::check_rotations`], the other way round.
    pub(super) fn check_features(&self) -> Result<(), Error> {
        for (what, found) in [
            ("joint_weight", self.joint_weight),
            ("foot_contact_weight", self.foot_contact_weight),
        ] {
            if found != 0.0 {
                let expected =
                    "0 for motions that are features: those hold their joints' positions";
                return Err(Error::setting(what, expected, found));
            }
        }
        Ok(())
    }

    /// Losses of the predicted motions that have a weight; bodies are the embedded one.
    pub(super) fn motion_losses(
        &self,
        statistics: &FeatureStatistics,
    ) -> Result<Vec<WeightedLoss>, Error> {
        let mut losses = Vec::new();
        if self.self_intersection_weight > 0.0 {
            let loss = SelfIntersectionLoss::embedded(statistics, self.self_intersection)?;
            let weight = self.self_intersection_weight;
            losses.push(WeightedLoss::new("self_intersection", weight, loss)?);
        }
        if self.ground_weight > 0.0 {
            let loss = GroundLoss::new(statistics.clone());
            losses.push(WeightedLoss::new("ground", self.ground_weight, loss)?);
        }
        if self.sliding_weight > 0.0 {
            let loss = SlidingLoss::new(statistics.clone());
            losses.push(WeightedLoss::new("sliding", self.sliding_weight, loss)?);
        }
        Ok(losses)
    }
}
