//! The body of BERT and of its small kin (Devlin et al., 2019; Sanh et al., 2019).

use rayon::prelude::*;

use crate::config::Config;
use crate::tokens::WordPieces;
use crate::transformer::{Activation, Attention, Layer, LayerNorm, Linear, NormPlace, Sight};
use crate::weights::{Rows, Weights};
use crate::{Error, TextLimits};

/// Captions that are worked on together.
const CAPTIONS_A_TASK: usize = 16;

/// Names of a model's tensors.
pub(crate) struct Names {
    /// What `{layer}` stands for in the others.
    pub(crate) layer: &'static str,
    pub(crate) query: &'static str,
    pub(crate) key: &'static str,
    pub(crate) value: &'static str,
    pub(crate) output: &'static str,
    pub(crate) attention_norm: &'static str,
    pub(crate) widen: &'static str,
    pub(crate) narrow: &'static str,
    pub(crate) feed_forward_norm: &'static str,
}

/// BERT's own names.
pub(crate) const BERT: Names = Names {
    layer: "encoder.layer",
    query: "attention.self.query",
    key: "attention.self.key",
    value: "attention.self.value",
    output: "attention.output.dense",
    attention_norm: "attention.output.LayerNorm",
    widen: "intermediate.dense",
    narrow: "output.dense",
    feed_forward_norm: "output.LayerNorm",
};

/// DistilBERT's names.
pub(crate) const DISTIL_BERT: Names = Names {
    layer: "transformer.layer",
    query: "attention.q_lin",
    key: "attention.k_lin",
    value: "attention.v_lin",
    output: "attention.out_lin",
    attention_norm: "sa_layer_norm",
    widen: "ffn.lin1",
    narrow: "ffn.lin2",
    feed_forward_norm: "output_layer_norm",
};

/// Word pieces to vectors.
#[derive(Clone, Debug)]
pub(crate) struct Bert {
    words: Rows,
    positions: Rows,
    /// Added to every token: captions are single sentences.
    token_type: Option<Vec<f32>>,
    norm: LayerNorm,
    layers: Vec<Layer>,
    width: usize,
    tokens: WordPieces,
    longest: usize,
}

/// BERT's epsilon, which no configuration of its kin changes.
const EPSILON: f32 = 1e-12;

impl Bert {
    /// Takes a model's tensors; their shapes tell the sizes, `heads` is what they do not tell.
    pub(crate) fn take(
        weights: Weights,
        names: &Names,
        heads: usize,
        tokens: WordPieces,
        longest: usize,
        limits: &TextLimits,
    ) -> Result<Self, Error> {
        let mut weights = weights.under("embeddings.word_embeddings.weight")?;
        let words = "embeddings.word_embeddings.weight";
        let shape = weights.shape(words)?.to_vec();
        let &[vocabulary, width] = shape.as_slice() else {
            return Err(weights.wrong(words, "two dimensions".into(), format!("{shape:?}")));
        };
        if heads == 0 || !width.is_multiple_of(heads) || width == 0 {
            let found = format!("{width} in {heads} heads");
            return Err(weights.wrong(words, "a width of whole heads".into(), found));
        }
        if vocabulary < tokens.vocabulary() {
            let expected = format!("{} rows, one a word piece", tokens.vocabulary());
            return Err(weights.wrong(words, expected, vocabulary.to_string()));
        }
        let places = "embeddings.position_embeddings.weight";
        let place_count = weights.shape(places)?.first().copied().unwrap_or(0);
        let types = "embeddings.token_type_embeddings.weight";
        let token_type = match weights.has(types) {
            true => {
                let count = weights.shape(types)?.first().copied().unwrap_or(0);
                let mut types = weights.floats(types, &[count, width])?;
                types.truncate(width);
                Some(types)
            }
            false => None,
        };
        Ok(Self {
            words: weights.rows(words, &[vocabulary, width])?,
            positions: weights.rows(places, &[place_count, width])?,
            token_type,
            norm: LayerNorm::take(&mut weights, "embeddings.LayerNorm", width, EPSILON)?,
            layers: layers(&mut weights, names, width, heads, limits)?,
            width,
            tokens,
            longest: longest.min(place_count).max(2),
        })
    }

    /// Reads a folder: weights, vocabulary and configuration.
    pub(crate) fn read(
        folder: &std::path::Path,
        names: &Names,
        heads_key: &str,
        longest: usize,
        limits: &TextLimits,
    ) -> Result<Self, Error> {
        let heads = Config::read(folder, limits)?.count(heads_key, 12)?;
        let tokens = WordPieces::read(folder, limits)?;
        let weights = Weights::read(folder, limits)?;
        Self::take(weights, names, heads, tokens, longest, limits)
    }

    pub(crate) const fn width(&self) -> usize {
        self.width
    }

    /// `[tokens][width]` of each caption, made into something by `finish`.
    pub(crate) fn encode(
        &self,
        captions: &[&str],
        finish: impl Fn(&[f32]) -> Vec<f32> + Sync,
    ) -> Vec<Vec<f32>> {
        let tasks = captions.par_chunks(CAPTIONS_A_TASK);
        let done = tasks.map(|captions| {
            let ids: Vec<Vec<u32>> = captions
                .iter()
                .map(|caption| self.tokens.encode(caption, self.longest))
                .collect();
            let lengths: Vec<usize> = ids.iter().map(Vec::len).collect();
            let states = self.states(&ids, &lengths);
            let mut rest = states.as_slice();
            let mut finished = Vec::with_capacity(lengths.len());
            for length in lengths {
                let (own, after) = rest.split_at(length * self.width);
                finished.push(finish(own));
                rest = after;
            }
            finished
        });
        done.collect::<Vec<_>>().into_iter().flatten().collect()
    }

    /// The last layer's states of all tokens.
    fn states(&self, ids: &[Vec<u32>], lengths: &[usize]) -> Vec<f32> {
        let total: usize = lengths.iter().sum();
        let mut x = vec![0.0; total * self.width];
        let mut place = vec![0.0; self.width];
        let tokens = ids.iter().flat_map(|ids| ids.iter().enumerate());
        for ((position, &id), row) in tokens.zip(x.chunks_exact_mut(self.width)) {
            self.words.copy_to(id as usize, row);
            self.positions.copy_to(position, &mut place);
            for (value, place) in row.iter_mut().zip(&place) {
                *value += place;
            }
            for (value, token_type) in row.iter_mut().zip(self.token_type.iter().flatten()) {
                *value += token_type;
            }
        }
        self.norm.apply(&mut x);
        for layer in &self.layers {
            layer.apply(&mut x, lengths, self.width);
        }
        x
    }
}

/// As many layers as the file has.
fn layers(
    weights: &mut Weights,
    names: &Names,
    width: usize,
    heads: usize,
    limits: &TextLimits,
) -> Result<Vec<Layer>, Error> {
    let mut layers = Vec::new();
    loop {
        let name = |part: &str| format!("{}.{}.{part}", names.layer, layers.len());
        if !weights.has(&format!("{}.weight", name(names.query))) {
            return Ok(layers);
        }
        if layers.len() >= limits.layers {
            let expected = format!("at most {} layers", limits.layers);
            return Err(weights.wrong(&name(names.query), expected, "more".into()));
        }
        let widened = format!("{}.weight", name(names.widen));
        let wide = weights.shape(&widened)?.first().copied().unwrap_or(0);
        let mut linear =
            |part: &str, inputs, outputs| Linear::take(weights, &name(part), inputs, outputs);
        let attention = Attention {
            query: linear(names.query, width, width)?,
            key: linear(names.key, width, width)?,
            value: linear(names.value, width, width)?,
            output: linear(names.output, width, width)?,
            heads,
            sight: Sight::Whole,
        };
        let widen = linear(names.widen, width, wide)?;
        let narrow = linear(names.narrow, wide, width)?;
        let mut norm = |part: &str| LayerNorm::take(weights, &name(part), width, EPSILON);
        let layer = Layer {
            attention,
            attention_norm: norm(names.attention_norm)?,
            widen,
            activation: Activation::Gelu,
            narrow,
            feed_forward_norm: norm(names.feed_forward_norm)?,
            norm_place: NormPlace::After,
        };
        layers.push(layer);
    }
}
