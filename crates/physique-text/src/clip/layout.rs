//! The two layouts of CLIP's text tower: OpenAI's and Hugging Face's.

use super::Clip;
use crate::tokens::BytePairs;
use crate::transformer::{Activation, Attention, Layer, LayerNorm, Linear, NormPlace, Sight};
use crate::weights::Weights;
use crate::{Error, TextLimits};

/// PyTorch's own, which CLIP keeps.
const EPSILON: f32 = 1e-5;

/// Names that differ between the layouts.
struct Names {
    words: &'static str,
    positions: &'static str,
    layer: &'static str,
    attention_norm: &'static str,
    output: &'static str,
    widen: &'static str,
    narrow: &'static str,
    feed_forward_norm: &'static str,
    norm: &'static str,
}

const HUGGING_FACE: Names = Names {
    words: "text_model.embeddings.token_embedding.weight",
    positions: "text_model.embeddings.position_embedding.weight",
    layer: "text_model.encoder.layers",
    attention_norm: "layer_norm1",
    output: "self_attn.out_proj",
    widen: "mlp.fc1",
    narrow: "mlp.fc2",
    feed_forward_norm: "layer_norm2",
    norm: "text_model.final_layer_norm",
};

const OPENAI: Names = Names {
    words: "token_embedding.weight",
    positions: "positional_embedding",
    layer: "transformer.resblocks",
    attention_norm: "ln_1",
    output: "attn.out_proj",
    widen: "mlp.c_fc",
    narrow: "mlp.c_proj",
    feed_forward_norm: "ln_2",
    norm: "ln_final",
};

/// Takes the tensors of either layout.
pub(super) fn take(
    weights: Weights,
    heads: Option<usize>,
    tokens: BytePairs,
    longest: usize,
    limits: &TextLimits,
) -> Result<Clip, Error> {
    let hugging_face = weights.has(HUGGING_FACE.words);
    let names = if hugging_face { HUGGING_FACE } else { OPENAI };
    let mut weights = if hugging_face {
        weights
    } else {
        weights.under("token_embedding.weight")?
    };
    let shape = weights.shape(names.words)?.to_vec();
    let &[vocabulary, width] = shape.as_slice() else {
        let found = format!("{shape:?}");
        return Err(weights.wrong(names.words, "two dimensions".into(), found));
    };
    // Heads of 64 numbers, as OpenAI's own reader takes for granted.
    let heads = heads.unwrap_or(width / 64);
    if heads == 0 || !width.is_multiple_of(heads) {
        let found = format!("{width} in {heads} heads");
        return Err(weights.wrong(names.words, "a width of whole heads".into(), found));
    }
    if vocabulary < tokens.vocabulary() {
        let expected = format!("{} rows, one a piece", tokens.vocabulary());
        return Err(weights.wrong(names.words, expected, vocabulary.to_string()));
    }
    let places = weights
        .shape(names.positions)?
        .first()
        .copied()
        .unwrap_or(0);
    let projection = projection(&mut weights, hugging_face, width)?;
    Ok(Clip {
        words: weights.rows(names.words, &[vocabulary, width])?,
        positions: weights.rows(names.positions, &[places, width])?,
        layers: layers(&mut weights, &names, hugging_face, width, heads, limits)?,
        norm: LayerNorm::take(&mut weights, names.norm, width, EPSILON)?,
        projected: projection.1,
        projection: projection.0,
        inner_width: width,
        tokens,
        longest: longest.min(places).max(2),
    })
}

/// Hugging Face keeps the projection as a linear layer, OpenAI as its transpose.
fn projection(
    weights: &mut Weights,
    hugging_face: bool,
    width: usize,
) -> Result<(Linear, usize), Error> {
    let name = if hugging_face {
        "text_projection.weight"
    } else {
        "text_projection"
    };
    let shape = weights.shape(name)?;
    let side = usize::from(!hugging_face);
    let outputs = shape.get(side).copied().unwrap_or(0);
    let weight = if hugging_face {
        weights.floats(name, &[outputs, width])?
    } else {
        let columns = weights.floats(name, &[width, outputs])?;
        let at = |place: usize| columns[place % width * outputs + place / width];
        (0..outputs * width).map(at).collect()
    };
    Ok((Linear::new(weight, vec![0.0; outputs], width), outputs))
}

fn layers(
    weights: &mut Weights,
    names: &Names,
    hugging_face: bool,
    width: usize,
    heads: usize,
    limits: &TextLimits,
) -> Result<Vec<Layer>, Error> {
    let mut layers = Vec::new();
    loop {
        let name = |part: &str| format!("{}.{}.{part}", names.layer, layers.len());
        if !weights.has(&format!("{}.weight", name(names.output))) {
            return Ok(layers);
        }
        if layers.len() >= limits.layers {
            let expected = format!("at most {} layers", limits.layers);
            return Err(weights.wrong(&name(names.output), expected, "more".into()));
        }
        let wide = weights.shape(&format!("{}.weight", name(names.widen)))?;
        let wide = wide.first().copied().unwrap_or(0);
        let [query, key, value] = if hugging_face {
            let mut take = |part: &str| Linear::take(weights, &name(part), width, width);
            [
                take("self_attn.q_proj")?,
                take("self_attn.k_proj")?,
                take("self_attn.v_proj")?,
            ]
        } else {
            three_in_one(weights, &name("attn.in_proj"), width)?
        };
        let mut linear =
            |part: &str, inputs, outputs| Linear::take(weights, &name(part), inputs, outputs);
        let attention = Attention {
            query,
            key,
            value,
            output: linear(names.output, width, width)?,
            heads,
            sight: Sight::Back,
        };
        let widen = linear(names.widen, width, wide)?;
        let narrow = linear(names.narrow, wide, width)?;
        let mut norm = |part: &str| LayerNorm::take(weights, &name(part), width, EPSILON);
        let layer = Layer {
            attention,
            attention_norm: norm(names.attention_norm)?,
            widen,
            activation: Activation::QuickGelu,
            narrow,
            feed_forward_norm: norm(names.feed_forward_norm)?,
            norm_place: NormPlace::Before,
        };
        layers.push(layer);
    }
}

/// PyTorch's attention keeps query, key and value under each other.
fn three_in_one(weights: &mut Weights, name: &str, width: usize) -> Result<[Linear; 3], Error> {
    let weight = weights.floats(&format!("{name}_weight"), &[3 * width, width])?;
    let bias = weights.floats(&format!("{name}_bias"), &[3 * width])?;
    let part = |part: usize| {
        let rows = part * width..(part + 1) * width;
        let weight = weight[rows.start * width..rows.end * width].to_vec();
        Linear::new(weight, bias[rows].to_vec(), width)
    };
    Ok([part(0), part(1), part(2)])
}
