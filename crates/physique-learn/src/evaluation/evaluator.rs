//! Captions and motions as points.

use std::path::Path;

use burn::tensor::Device;

use super::Points;
use super::motion_side::{MotionSide, points};
use super::networks::{
    EvaluatorSizes, MOVEMENT_NAMES, PARTS_OF_SPEECH, TEXT_NAMES, TextEncoder, WORD,
};
use crate::Error;
use crate::checkpoint::{CheckpointLimits, TorchCheckpoint};
use crate::layers::{Dropout, Initialiser};
use crate::parameters::Parameters;
use crate::tensors::{numbers, tensor};

/// The published evaluator: embeds captions and motions as points of 512 numbers, matching ones
/// close to each other.
#[derive(Clone, Debug)]
pub struct Evaluator {
    text: TextEncoder,
    motions: MotionSide,
    device: Device,
}

/// Captions as word vectors, padded to one number of words.
#[derive(Clone, Debug, PartialEq)]
pub struct CaptionWords {
    /// Words a caption, padding included.
    pub words: usize,
    /// `[captions][words][300]`.
    pub vectors: Vec<f32>,
    /// `[captions][words]`: part of speech, below 15.
    pub parts_of_speech: Vec<u8>,
    /// Words of each caption, with those that mark start and end.
    pub lengths: Vec<usize>,
}

impl Evaluator {
    /// An evaluator of `columns` features (263 or 251) that has learnt nothing.
    ///
    /// # Errors
    /// [`Error::Setting`] for fewer columns than the networks pass over.
    pub fn new(columns: usize, seed: u64, device: &Device) -> Result<Self, Error> {
        let sizes = EvaluatorSizes::default();
        let initialiser = &mut Initialiser::new(seed, device);
        Ok(Self {
            text: TextEncoder::new(sizes, initialiser),
            motions: MotionSide::new(columns, sizes, initialiser)?,
            device: device.clone(),
        })
    }

    /// Reads `text_mot_match/model/finest.tar`, which is a PyTorch file by another name.
    ///
    /// # Errors
    /// Those of [`TorchCheckpoint::open`]; [`Error::Parameters`] and [`Error::ParameterShape`]
    /// unless each network's parameters are exactly as published.
    pub fn read(
        path: &Path,
        columns: usize,
        limits: &CheckpointLimits,
        device: &Device,
    ) -> Result<Self, Error> {
        let file = TorchCheckpoint::open(path, limits)?;
        let network = |key| file.state_dictionary(Some(key));
        let parameters = [
            network("movement_encoder")?,
            network("text_encoder")?,
            network("motion_encoder")?,
        ];
        Self::new(columns, 0, device)?.with_parameters(parameters)
    }

    /// The evaluator with parameters of the movement, text and motion encoder under their
    /// published names.
    ///
    /// # Errors
    /// As [`Evaluator::read`].
    pub fn with_parameters(self, parameters: [Parameters; 3]) -> Result<Self, Error> {
        let [movement, text, motion] = parameters;
        let MotionSide {
            movement_encoder,
            motion_encoder,
            ..
        } = self.motions.clone();
        Ok(Self {
            motions: MotionSide {
                movement_encoder: movement.load(
                    movement_encoder,
                    "the movement encoder",
                    MOVEMENT_NAMES,
                )?,
                motion_encoder: motion.load(motion_encoder, "the motion encoder", TEXT_NAMES)?,
                ..self.motions
            },
            text: text.load(self.text, "the text encoder", TEXT_NAMES)?,
            ..self
        })
    }

    /// The parameters of the movement, text and motion encoder under their published names.
    ///
    /// # Errors
    /// [`Error::Device`] where the numbers cannot be fetched.
    pub fn parameters(&self) -> Result<[Parameters; 3], Error> {
        Ok([
            Parameters::of(
                &self.motions.movement_encoder,
                "movement_encoder",
                MOVEMENT_NAMES,
            )?,
            Parameters::of(&self.text, "text_encoder", TEXT_NAMES)?,
            Parameters::of(&self.motions.motion_encoder, "motion_encoder", TEXT_NAMES)?,
        ])
    }

    /// Features a frame.
    pub const fn columns(&self) -> usize {
        self.motions.columns
    }

    /// What the motion encoder sees: `[motions][frames / 4][512]` numbers of movement.
    ///
    /// # Errors
    /// As [`Evaluator::embed_motions`].
    pub fn movements(&self, motions: &[f32], frames: usize) -> Result<Vec<f32>, Error> {
        let dropout = Dropout::none();
        numbers(
            self.motions
                .movement(motions, frames, &self.device, &dropout)?,
        )
    }

    /// Embeds motions `[motions][frames][columns]`, normalised by the *evaluator's* statistics and
    /// padded with zeros, of which each has `lengths` frames.
    ///
    /// # Errors
    /// [`Error::Input`] when the numbers are no whole motions, or a length is below 4 or above
    /// `frames`.
    pub fn embed_motions(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<Points, Error> {
        let dropout = Dropout::none();
        let embeddings = self
            .motions
            .forward(motions, frames, lengths, &self.device, &dropout)?;
        points(embeddings)
    }

    /// Embeds captions.
    ///
    /// # Errors
    /// [`Error::Input`] when the counts disagree.
    pub fn embed_captions(&self, captions: &CaptionWords) -> Result<Points, Error> {
        let batch = captions.lengths.len();
        let words = batch * captions.words;
        let fits = captions.vectors.len() == words * WORD
            && captions.parts_of_speech.len() == words
            && captions
                .parts_of_speech
                .iter()
                .all(|&part| usize::from(part) < PARTS_OF_SPEECH)
            && captions
                .lengths
                .iter()
                .all(|length| (1..=captions.words).contains(length));
        if batch == 0 || !fits {
            let expected = "vectors and parts of speech for each word, and a length a caption";
            let found = format!(
                "{} numbers, {} parts of speech, {batch} lengths",
                captions.vectors.len(),
                captions.parts_of_speech.len()
            );
            return Err(Error::input("Captions", expected, found));
        }
        let vectors = [batch, captions.words, WORD];
        let vectors = tensor(captions.vectors.clone(), vectors, &self.device);
        let mut parts = vec![0.0; words * PARTS_OF_SPEECH];
        for (word, &part) in captions.parts_of_speech.iter().enumerate() {
            parts[word * PARTS_OF_SPEECH + usize::from(part)] = 1.0;
        }
        let parts = tensor(
            parts,
            [batch, captions.words, PARTS_OF_SPEECH],
            &self.device,
        );
        points(self.text.forward(vectors, parts, &captions.lengths))
    }
}
