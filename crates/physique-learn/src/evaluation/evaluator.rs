//! Captions and motions as points.

use std::path::Path;

use burn::tensor::{Device, Tensor};

use super::Points;
use super::networks::{
    MOVEMENT_NAMES, MotionEncoder, MovementEncoder, PARTS_OF_SPEECH, TEXT_NAMES, TextEncoder, WORD,
};
use crate::Error;
use crate::checkpoint::{CheckpointLimits, TorchCheckpoint};
use crate::layers::Initialiser;
use crate::parameters::Parameters;
use crate::tensors::{numbers, tensor};

/// Frames that one step of the movement encoder stands for.
const FRAMES_A_STEP: usize = 4;
/// Columns at the end of a row, contacts of the feet, that the networks do not see.
const UNSEEN: usize = 4;

/// The published evaluator: embeds captions and motions as points of 512 numbers, matching ones
/// close to each other.
#[derive(Clone, Debug)]
pub struct Evaluator {
    movement: MovementEncoder,
    text: TextEncoder,
    motion: MotionEncoder,
    columns: usize,
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
        if columns <= UNSEEN {
            return Err(Error::setting("columns", "more than 4 features", columns));
        }
        let initialiser = &mut Initialiser::new(seed, device);
        Ok(Self {
            movement: MovementEncoder::new(columns - UNSEEN, initialiser),
            text: TextEncoder::new(initialiser),
            motion: MotionEncoder::new(initialiser),
            columns,
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
        Ok(Self {
            movement: movement.load(self.movement, "the movement encoder", MOVEMENT_NAMES)?,
            text: text.load(self.text, "the text encoder", TEXT_NAMES)?,
            motion: motion.load(self.motion, "the motion encoder", TEXT_NAMES)?,
            ..self
        })
    }

    /// The parameters of the movement, text and motion encoder under their published names.
    ///
    /// # Errors
    /// [`Error::Device`] where the numbers cannot be fetched.
    pub fn parameters(&self) -> Result<[Parameters; 3], Error> {
        Ok([
            Parameters::of(&self.movement, "movement_encoder", MOVEMENT_NAMES)?,
            Parameters::of(&self.text, "text_encoder", TEXT_NAMES)?,
            Parameters::of(&self.motion, "motion_encoder", TEXT_NAMES)?,
        ])
    }

    /// What the motion encoder sees: `[motions][frames / 4][512]` numbers of movement.
    ///
    /// # Errors
    /// As [`Evaluator::embed_motions`].
    pub fn movements(&self, motions: &[f32], frames: usize) -> Result<Vec<f32>, Error> {
        numbers(self.movement_tensor(motions, frames)?)
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
        let movement = self.movement_tensor(motions, frames)?;
        let [batch, steps, _] = movement.dims();
        if lengths.len() != batch {
            let expected = format!("{batch}, one a motion");
            return Err(Error::input("Lengths", expected, lengths.len()));
        }
        let possible = FRAMES_A_STEP..=steps * FRAMES_A_STEP;
        if let Some(length) = lengths.iter().find(|length| !possible.contains(length)) {
            let expected = format!("{} to {} frames", possible.start(), possible.end());
            return Err(Error::input("Length of a motion", expected, length));
        }
        let steps: Vec<usize> = lengths
            .iter()
            .map(|length| length / FRAMES_A_STEP)
            .collect();
        points(self.motion.forward(movement, &steps))
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

    fn movement_tensor(&self, motions: &[f32], frames: usize) -> Result<Tensor<3>, Error> {
        let motion = frames * self.columns;
        if frames < FRAMES_A_STEP || motions.is_empty() || !motions.len().is_multiple_of(motion) {
            let expected = format!("motions of {frames} x {} numbers", self.columns);
            return Err(Error::input("Motions", expected, motions.len()));
        }
        let shape = [motions.len() / motion, frames, self.columns];
        let motions = tensor(motions.to_vec(), shape, &self.device);
        Ok(self
            .movement
            .forward(motions.narrow(2, 0, self.columns - UNSEEN)))
    }
}

fn points(embeddings: Tensor<2>) -> Result<Points, Error> {
    let width = embeddings.dims()[1];
    let values = numbers(embeddings)?.into_iter().map(f64::from);
    Points::new(width, values.collect())
}
