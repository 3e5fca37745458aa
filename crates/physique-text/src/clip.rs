//! CLIP's text tower: one vector a caption.

mod layout;

use std::path::Path;

use rayon::prelude::*;

use crate::tokens::BytePairs;
use crate::transformer::{Layer, LayerNorm, Linear};
use crate::weights::{Rows, Weights};
use crate::{Error, TextEmbeddings, TextEncoder, TextLimits};

/// Captions that are worked on together.
const CAPTIONS_A_TASK: usize = 8;

/// How much of a caption is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClipContext {
    /// 20 pieces, as MDM reads the captions of HumanML3D and KIT-ML.
    Mdm,
    /// 75 pieces: all that the model has positions for.
    Whole,
}

impl ClipContext {
    /// Start and end among them.
    const fn tokens(self) -> usize {
        match self {
            Self::Mdm => 22,
            Self::Whole => 77,
        }
    }
}

/// The text tower of CLIP (Radford et al., 2021), `ViT-B/32` and its kin: the state of the last token
/// after the last layer, projected; not brought to length 1.
///
/// The published models of MDM had its weights rounded to 16 bits; files of OpenAI hold them so. All
/// arithmetic here is in 32 bits.
#[derive(Clone, Debug)]
pub struct Clip {
    words: Rows,
    positions: Rows,
    layers: Vec<Layer>,
    norm: LayerNorm,
    projection: Linear,
    inner_width: usize,
    projected: usize,
    tokens: BytePairs,
    longest: usize,
}

impl Clip {
    /// Reads a folder in the layout of Hugging Face, or one that holds OpenAI's weights, as its own
    /// `ViT-B-32.pt` or as a state dictionary, and `bpe_simple_vocab_16e6.txt.gz`.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Missing`]; [`Error::Format`] and [`Error::Data`] for files that do
    /// not hold such a model.
    pub fn read(folder: &Path, context: ClipContext, limits: &TextLimits) -> Result<Self, Error> {
        Self::read_files(folder, folder, context, limits)
    }

    /// Reads weights and vocabulary from two places, each a file or a folder.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_files(
        weights: &Path,
        vocabulary: &Path,
        context: ClipContext,
        limits: &TextLimits,
    ) -> Result<Self, Error> {
        let tokens = BytePairs::read(vocabulary, limits)?;
        let heads = match weights.join("config.json") {
            file if file.exists() => {
                let config = crate::config::Config::read(weights, limits)?.text_part();
                Some(config.count("num_attention_heads", 8)?)
            }
            _ => None,
        };
        let weights = Weights::read(weights, limits)?;
        layout::take(weights, heads, tokens, context.tokens(), limits)
    }

    /// The projected states of the captions' last tokens.
    fn features(&self, captions: &[&str]) -> Vec<Vec<f32>> {
        let ids: Vec<Vec<u32>> = captions
            .iter()
            .map(|caption| self.tokens.encode(caption, self.longest))
            .collect();
        let lengths: Vec<usize> = ids.iter().map(Vec::len).collect();
        let mut x = vec![0.0; lengths.iter().sum::<usize>() * self.inner_width];
        let mut place = vec![0.0; self.inner_width];
        let tokens = ids.iter().flat_map(|ids| ids.iter().enumerate());
        for ((position, &id), row) in tokens.zip(x.chunks_exact_mut(self.inner_width)) {
            self.words.copy_to(id as usize, row);
            self.positions.copy_to(position, &mut place);
            for (value, place) in row.iter_mut().zip(&place) {
                *value += place;
            }
        }
        for layer in &self.layers {
            layer.apply(&mut x, &lengths, self.inner_width);
        }
        let mut end = 0;
        let features = lengths.iter().map(|length| {
            // Tokens only look back: padding behind the last one would change nothing.
            end += length;
            let mut last = x[(end - 1) * self.inner_width..end * self.inner_width].to_vec();
            self.norm.apply(&mut last);
            self.projection.apply(&last)
        });
        features.collect()
    }
}

impl TextEncoder for Clip {
    fn name(&self) -> &str {
        "CLIP"
    }

    fn width(&self) -> usize {
        self.projected
    }

    fn is_by_token(&self) -> bool {
        false
    }

    fn encode(&self, captions: &[&str]) -> TextEmbeddings {
        let tasks = captions.par_chunks(CAPTIONS_A_TASK);
        let features: Vec<Vec<Vec<f32>>> = tasks.map(|task| self.features(task)).collect();
        TextEmbeddings::padded(&features.concat(), self.projected)
    }
}
