//! The networks.

use burn::module::Module;
use burn::tensor::{Device, Tensor};

use super::SentenceConfig;
use crate::Error;
use crate::evaluation::motion_side::MotionSide;
use crate::evaluation::networks::Output;
use crate::layers::{Dropout, Initialiser};
use crate::parameters::{NameTable, Parameters};

/// Our paths and names after the published ones.
const NAMES: NameTable = &[
    ("motions.movement_encoder.first", "movement_encoder.main.0"),
    ("motions.movement_encoder.second", "movement_encoder.main.3"),
    (
        "motions.movement_encoder.output",
        "movement_encoder.out_net",
    ),
    (
        "motions.motion_encoder.output.first",
        "motion_encoder.output_net.0",
    ),
    (
        "motions.motion_encoder.output.norm",
        "motion_encoder.output_net.1",
    ),
    (
        "motions.motion_encoder.output.second",
        "motion_encoder.output_net.3",
    ),
    ("motions.motion_encoder", "motion_encoder"),
    ("captions.first", "text_encoder.output_net.0"),
    ("captions.norm", "text_encoder.output_net.1"),
    ("captions.second", "text_encoder.output_net.3"),
];

/// Encoded captions and motions to points of one space.
#[derive(Module, Debug)]
pub struct SentenceNetworks {
    motions: MotionSide,
    captions: Output,
    #[module(skip)]
    config: SentenceConfig,
}

impl SentenceNetworks {
    /// New networks, whose parameters depend on the seed only.
    ///
    /// # Errors
    /// [`Error::Setting`] for sizes that cannot be.
    pub fn new(config: &SentenceConfig, seed: u64, device: &Device) -> Result<Self, Error> {
        config.sizes.check()?;
        let initialiser = &mut Initialiser::new(seed, device);
        let sizes = config.sizes;
        let head = [config.text, sizes.text_state, sizes.embedding];
        Ok(Self {
            motions: MotionSide::new(config.columns, sizes, initialiser)?,
            captions: Output::new(head, initialiser),
            config: config.clone(),
        })
    }

    /// Shape of the networks.
    pub const fn config(&self) -> &SentenceConfig {
        &self.config
    }

    /// Points `[motions][embedding]` of normalised motions `[motions][frames][columns]`, of which
    /// each has `lengths` frames.
    ///
    /// # Errors
    /// [`Error::Input`] when the numbers are no whole motions, or a length is below 4 or above
    /// `frames`.
    pub fn embed_motions(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
        dropout: &Dropout,
    ) -> Result<Tensor<2>, Error> {
        let device = self.device();
        self.motions
            .forward(motions, frames, lengths, &device, dropout)
    }

    /// Points `[captions][embedding]` of captions `[captions][text]`, less the mean caption.
    pub fn embed_captions(&self, captions: Tensor<2>) -> Tensor<2> {
        self.captions.forward(captions)
    }

    /// Where the networks' numbers are.
    pub(super) fn device(&self) -> Device {
        let mut devices = self.devices().into_iter();
        devices.next().unwrap_or_default()
    }

    /// The parameters, by names after the published ones.
    ///
    /// # Errors
    /// [`Error::Device`] where the numbers cannot be fetched.
    pub fn parameters(&self) -> Result<Parameters, Error> {
        Parameters::of(self, "the evaluator", NAMES)
    }

    /// The networks with these parameters, strictly.
    ///
    /// # Errors
    /// [`Error::Parameters`] and [`Error::ParameterShape`].
    pub fn with_parameters(self, parameters: Parameters) -> Result<Self, Error> {
        parameters.load(self, "the evaluator", NAMES)
    }
}
