//! Motions and captions of data files, as networks read them.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use physique_data::{Dataset, Sampler, SamplerOptions};

use crate::Error;
use crate::text::{Embeddings, PromptEncoder};
use crate::trainer::{BatchCondition, MotionBatch, MotionSource};

/// Captions whose vectors are kept at most.
const KEPT_CAPTIONS: usize = 200_000;

/// Windows of a data file with one of their captions each.
#[derive(Debug)]
pub struct CaptionedMotions<'a> {
    dataset: &'a Dataset,
    sampler: Sampler,
    prompts: Option<&'a PromptEncoder>,
    /// Vectors by caption; filled as captions are drawn.
    known: Mutex<HashMap<usize, Vec<f32>>>,
}

impl<'a> CaptionedMotions<'a> {
    /// Draws windows of `dataset` by `options`; without `prompts` nothing is said of them.
    ///
    /// # Errors
    /// [`Error::Data`] when there is nothing to draw.
    pub fn new(
        dataset: &'a Dataset,
        options: SamplerOptions,
        prompts: Option<&'a PromptEncoder>,
    ) -> Result<Self, Error> {
        Ok(Self {
            sampler: Sampler::new(dataset, options)?,
            dataset,
            prompts,
            known: Mutex::default(),
        })
    }

    /// What is drawn from.
    pub const fn sampler(&self) -> &Sampler {
        &self.sampler
    }

    /// Vectors of captions; where there is none, zeros, which say nothing.
    fn encode(
        &self,
        prompts: &PromptEncoder,
        captions: &[Option<usize>],
    ) -> Result<Embeddings, Error> {
        let text = |caption: usize| self.dataset.index().captions[caption].text.as_str();
        if prompts.encoder().is_by_token() {
            let texts = captions.iter().map(|caption| caption.map_or("", text));
            return prompts.encode(&texts.collect::<Vec<_>>());
        }
        let width = prompts.encoder().width();
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if known.len() > KEPT_CAPTIONS {
            known.clear();
        }
        let mut new: Vec<usize> = captions.iter().flatten().copied().collect();
        new.sort_unstable();
        new.dedup();
        new.retain(|caption| !known.contains_key(caption));
        let texts: Vec<&str> = new.iter().map(|&caption| text(caption)).collect();
        let encoded = prompts.encode(&texts)?;
        let vectors = encoded.values.chunks_exact(width.max(1));
        for (caption, vector) in new.into_iter().zip(vectors) {
            known.insert(caption, vector.to_vec());
        }
        let nothing = vec![0.0; width];
        let rows = captions.iter().map(|caption| {
            caption
                .and_then(|caption| known.get(&caption))
                .unwrap_or(&nothing)
        });
        Ok(Embeddings {
            batch: captions.len(),
            tokens: 1,
            width,
            values: rows.flatten().copied().collect(),
            padding: vec![false; captions.len()],
        })
    }
}

impl MotionSource for CaptionedMotions<'_> {
    fn columns(&self) -> usize {
        self.dataset.skeleton().feature_count()
    }

    fn batch(&self, size: usize, seed: u64, step: u64) -> Result<MotionBatch, Error> {
        let drawn = self.sampler.draw(seed, step, size);
        let windows: Vec<_> = drawn.iter().map(|drawn| drawn.window).collect();
        let batch = self.dataset.batch(&windows, 0)?;
        let condition = match self.prompts {
            None => BatchCondition::Nothing,
            Some(prompts) => {
                let captions: Vec<_> = drawn.iter().map(|drawn| drawn.caption).collect();
                BatchCondition::Text(self.encode(prompts, &captions)?)
            }
        };
        Ok(MotionBatch {
            frames: batch.frames,
            features: batch.values,
            lengths: batch.lengths,
            condition,
        })
    }
}
