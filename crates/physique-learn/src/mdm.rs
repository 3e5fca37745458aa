//! The motion diffusion model: Tevet et al., "Human Motion Diffusion Model", ICLR 2023.
//!
//! A transformer sees noisy features of a motion, the step of diffusion and what the motion is to
//! be, and predicts the clean features. [`Mdm`] is the network, [`MdmConfig`] its shape,
//! [`Condition`] what a batch is to be; [`read_published`] reads published checkpoints, [`MdmTask`]
//! trains a network, and [`generate`] samples motions from one.

mod condition;
mod config;
#[cfg(feature = "embedded")]
mod embedded;
mod folder;
mod generate;
pub mod losses;
mod network;
mod plan;
mod plan_motions;
mod published;
pub mod rotation_losses;
mod rotation_skeleton;
mod start;
mod text_to_motion;
mod time_embedding;
mod training;
mod training_settings;

pub use condition::Condition;
pub use config::{Architecture, ConditionKind, MdmConfig, PlannerConfig};
#[cfg(feature = "embedded")]
pub use embedded::EmbeddedNetwork;
pub use folder::{MdmDescription, MdmFolder};
pub use generate::{GenerateRequest, generate, generate_whole};
pub use network::{Mdm, MdmQuery};
pub use plan::{MdmPlan, PLANS, WindowPlan};
pub use plan_motions::plan_motions;
pub use published::{
    PUBLISHED_NAMES, PublishedArguments, from_parameters, parameters_of, read_published,
};
pub use rotation_skeleton::RotationSkeleton;
pub use start::{Origin, StartingNetwork};
pub use text_to_motion::{KnownMotion, Prompt, Sampling, TextToMotion};
pub use training::MdmTask;
pub use training_settings::MdmTraining;
