//! Networks that generate human motion, trained, sampled and evaluated on Burn.
//!
//! | what | where |
//! |---|---|
//! | the motion diffusion model | [`mdm`] |
//! | denoising diffusion: schedules, sampling, guidance, editing | [`diffusion`] |
//! | the published evaluation: networks and metrics | [`evaluation`] |
//! | encoded captions | [`text`] |
//! | motions and captions of a data file | [`data`] |
//! | the self-intersection loss as one operation in Burn's graph | [`motion_loss`] |
//! | layers with PyTorch's parameter names | [`layers`] |
//! | a network's numbers by name, strictly loaded | [`parameters`] |
//! | PyTorch's checkpoints as data, and our own files | [`checkpoint`] |
//! | training that can be killed and goes on | [`trainer`] |
//! | random numbers that depend on their seed only | [`random`] |
//! | processor or graphics processor | [`DeviceChoice`] |
//!
//! Motions are tensors `[batch][frames][columns]` of features that are normalised by
//! [`FeatureStatistics`](physique_motion::features::FeatureStatistics).

pub mod checkpoint;
pub mod data;
mod device;
pub mod diffusion;
pub mod error;
pub mod evaluation;
mod folders;
mod fused;
pub mod layers;
pub mod mdm;
pub mod motion_loss;
pub mod parameters;
pub mod random;
mod tensors;
pub mod text;
pub mod trainer;

pub use burn::tensor::Device;
pub use device::{DeviceChoice, device};
pub use error::Error;
