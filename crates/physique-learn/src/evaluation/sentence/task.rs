//! A sentence evaluator as a task for the trainer.

use burn::tensor::{Device, Tensor};

use super::loss::{alike, contrastive};
use super::{SentenceNetworks, SentenceTraining};
use crate::Error;
use crate::layers::Dropout;
use crate::tensors::tensor;
use crate::trainer::{BatchCondition, Loss, MotionSource, Task};

/// Trains a sentence evaluator on motions with captions, which are less the mean caption.
#[derive(Debug)]
pub struct SentenceTask<S> {
    source: S,
    training: SentenceTraining,
    device: Device,
}

impl<S: MotionSource> SentenceTask<S> {
    /// A task on a device, which must differentiate.
    ///
    /// # Errors
    /// [`Error::Setting`] for settings that cannot be.
    pub fn new(source: S, training: SentenceTraining, device: &Device) -> Result<Self, Error> {
        training.check()?;
        Ok(Self {
            source,
            training,
            device: device.clone(),
        })
    }
}

impl<S: MotionSource> Task for SentenceTask<S> {
    type Network = SentenceNetworks;

    fn loss(&self, network: &SentenceNetworks, seed: u64, step: u64) -> Result<Loss, Error> {
        let training = &self.training;
        let batch = self.source.batch(training.batch, seed, step)?;
        batch.check(network.config().columns)?;
        let BatchCondition::Text(captions) = &batch.condition else {
            return Err(Error::input("Batch", "captions", "none"));
        };
        let (pairs, width) = (batch.lengths.len(), network.config().text);
        if captions.values.len() != pairs * width {
            let expected = format!("{pairs} vectors of {width}");
            let found = format!("{} numbers", captions.values.len());
            return Err(Error::input("Captions", expected, found));
        }
        let dropout = Dropout::training(training.dropout, seed, step);
        let motions =
            network.embed_motions(&batch.features, batch.frames, &batch.lengths, &dropout)?;
        let same = alike(&captions.values, width, training.same_caption);
        let captions: Tensor<2> = tensor(captions.values.clone(), [pairs, width], &self.device);
        let captions = network.embed_captions(captions);
        let total = contrastive(captions, motions, &same, training.temperature);
        Ok(Loss {
            parts: Vec::new(),
            total,
        })
    }
}
