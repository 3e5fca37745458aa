//! What is asked of a network.

use physique_motion::features::MotionFeatures;

use crate::diffusion::{Edit, GuideWeights, Method};

/// A motion to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prompt<'a> {
    /// What it is to show; nothing in particular without words.
    pub text: &'a str,
    /// What trunk and arms show, while path and legs do as the text says: for two things at once that
    /// no training motion shows. [`TextToMotion::generate`](super::TextToMotion::generate) only.
    pub upper_body: Option<&'a str>,
    /// Frames.
    pub frames: usize,
    /// Another seed is another motion.
    pub seed: u64,
}

/// A motion that parts are kept of.
#[derive(Clone, Debug)]
pub struct KnownMotion {
    /// Its features, not normalised.
    pub features: MotionFeatures,
    /// What is kept of it: as many frames and columns.
    pub edit: Edit,
}

/// How motions are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Scale of classifier-free guidance.
    pub guidance: f64,
    /// How a step is taken.
    pub method: Method,
    /// Steps of noise that are walked; `None`: all that the network was trained with.
    pub steps: Option<usize>,
    /// Losses that motions are moved against while they are made.
    pub guides: GuideWeights,
    /// Cutoff in Hz of a low-pass filter over what was made, [`MotionFeatures::low_passed`]; `None` for
    /// what the network gives. Motions with parts of a known one are not filtered.
    pub smooth_hz: Option<f64>,
}

impl Default for Sampling {
    /// MDM's: every step, drawn from the posterior, guidance 2.5.
    fn default() -> Self {
        Self {
            guidance: 2.5,
            method: Method::Ancestral,
            steps: None,
            guides: GuideWeights::default(),
            smooth_hz: None,
        }
    }
}
