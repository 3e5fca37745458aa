//! Denoising diffusion: from noise to motion, by a network that predicts the clean motion.
//!
//! Motions are tensors `[batch][frames][columns]` of normalised features. A network sees a noisy
//! motion x_t and the step t, and predicts x_0; [`Sampler`] walks from the last step to the first.
//!
//! | what | where |
//! |---|---|
//! | how much noise a step holds | [`Schedule`] |
//! | from clean to noisy | [`add_noise`] |
//! | ancestral sampling and DDIM | [`Sampler`] |
//! | what a sample's noise is | [`NoiseStreams`] |
//! | classifier-free guidance | [`guide`] |
//! | guidance by losses, of bodies, feet and ground | [`GuideWeights`] |
//! | in-betweening, the upper body, any joints and frames | [`Edit`] |

mod descent;
mod edit;
mod forward;
mod guidance;
mod guides;
mod noise;
mod sampler;
mod schedule;

pub(crate) use descent::descend;
pub use edit::{BatchEdit, Edit};
pub use forward::add_noise;
pub use guidance::guide;
pub use guides::GuideWeights;
pub use noise::NoiseStreams;
pub use sampler::{Method, Sampler};
pub use schedule::{Posterior, Schedule};
