//! Everything about a run of training but its data.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{MdmConfig, MdmTraining, Origin};
use crate::layers::NormPlace;
use crate::trainer::{AdamWConfig, RateSchedule, TrainerConfig};

/// A network, what it learns by, and how long: the content of a plan file.
///
/// What is not named is as published for MDM on HumanML3D.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MdmPlan {
    /// Shape of the network; columns and condition come with the data and the text encoder.
    pub network: MdmConfig,
    /// What it learns by.
    pub training: MdmTraining,
    /// How long and how fast.
    pub run: TrainerConfig,
    /// Which windows of motions it sees.
    pub windows: WindowPlan,
    /// The trained network that the run starts from; a new one without.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub started_from: Option<Origin>,
}

/// Which windows of motions a run sees.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WindowPlan {
    /// Label whose values are drawn in proportion to the square root of their seconds; without it,
    /// every clip is seen once in each pass.
    pub balance_by: Option<String>,
    /// By value of that label: how many times as often it is drawn as balance alone would have it.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub favour: BTreeMap<String, f64>,
    /// Longest window in seconds, where that of the data is too long.
    pub longest_seconds: Option<f64>,
}

/// Names of the plans that are known.
pub const PLANS: [(&str, &str); 4] = [
    (
        "published",
        "MDM as published: 1,000 steps of noise, 8 layers of 512, 600,000 steps",
    ),
    (
        "fast",
        "MDM's later variant: 50 steps of noise, padding hidden, a running average",
    ),
    ("kit", "as published for KIT-ML: 200,000 steps"),
    (
        "small",
        "5 layers of 256, 50 steps of noise: learns some ten kinds of motion in hours on two cores",
    ),
];

impl MdmPlan {
    /// A plan by its name.
    pub fn named(name: &str) -> Option<Self> {
        let published = Self::default();
        Some(match name {
            "published" => published,
            "fast" => Self {
                network: MdmConfig {
                    mask_frames: true,
                    ..published.network
                },
                training: MdmTraining {
                    diffusion_steps: 50,
                    ..published.training
                },
                run: TrainerConfig {
                    average: Some(0.9999),
                    ..published.run
                },
                ..Self::default()
            },
            "kit" => Self {
                run: TrainerConfig {
                    steps: 200_000,
                    ..published.run
                },
                ..Self::default()
            },
            "small" => Self::small(),
            _ => return None,
        })
    }

    /// What a trial of small models on little data came to: norms in front of blocks, the condition
    /// on every frame, two frames a token, less signal in every step of noise, the root's path and
    /// velocities weighed more, contents in balance.
    fn small() -> Self {
        Self {
            network: MdmConfig {
                width: 256,
                layers: 5,
                heads: 4,
                feed_forward: 1024,
                mask_frames: true,
                norm: NormPlace::Pre,
                condition_every_frame: true,
                frames_per_token: 2,
                ..MdmConfig::default()
            },
            training: MdmTraining {
                batch: 16,
                diffusion_steps: 50,
                signal: 0.09,
                root_weight: 5.0,
                velocity_weight: 0.5,
                ..MdmTraining::default()
            },
            run: TrainerConfig {
                steps: 40_000,
                optimiser: AdamWConfig {
                    rate: 1e-3,
                    ..AdamWConfig::default()
                },
                rate: RateSchedule::WarmUpThenCosine {
                    warm_up: 200,
                    final_share: 0.05,
                },
                clip: Some(1.0),
                average: Some(0.999),
                save_every: 500,
                keep: Some(3),
                log_every: 20,
                ..TrainerConfig::default()
            },
            windows: WindowPlan {
                balance_by: Some("content".into()),
                longest_seconds: Some(6.0),
                ..WindowPlan::default()
            },
            started_from: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{MdmPlan, PLANS};

    #[test]
    fn every_named_plan_can_be_and_survives_its_file() {
        for (name, _) in PLANS {
            let plan = MdmPlan::named(name).unwrap();
            plan.network.check().unwrap();
            plan.run.check().unwrap();
            plan.training.schedule().unwrap();
            let text = serde_json::to_string(&plan).unwrap();
            assert_eq!(
                serde_json::from_str::<MdmPlan>(&text).unwrap(),
                plan,
                "{name}"
            );
        }
        assert!(MdmPlan::named("unheard of").is_none());
    }
}
