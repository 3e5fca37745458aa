//! Published checkpoints: `model000475000.pt` with `args.json` beside it.

use std::path::Path;

use burn::tensor::Device;
use serde::Deserialize;

use super::{Architecture, ConditionKind, Mdm, MdmConfig, PlannerConfig};
use crate::Error;
use crate::checkpoint::{CheckpointLimits, TorchCheckpoint};
use crate::parameters::{NameTable, Parameters};

/// Our paths and the published names.
pub const PUBLISHED_NAMES: NameTable = &[
    ("pose_embedding", "input_process.poseEmbedding"),
    ("time_embedding.first", "embed_timestep.time_embed.0"),
    ("time_embedding.second", "embed_timestep.time_embed.2"),
    ("text_embedding", "embed_text"),
    ("action_embedding.weight", "embed_action.action_embedding"),
    ("encoder", "seqTransEncoder"),
    ("decoder", "seqTransDecoder"),
    ("gru.layers.*.weight_ih", "gru.weight_ih_l*"),
    ("gru.layers.*.weight_hh", "gru.weight_hh_l*"),
    ("gru.layers.*.bias_ih", "gru.bias_ih_l*"),
    ("gru.layers.*.bias_hh", "gru.bias_hh_l*"),
    ("pose_final", "output_process.poseFinal"),
];

/// What may be in a file and is not a parameter: tables of positions, whose length differs by
/// version, and the text encoder.
const PASSED_OVER: [&str; 4] = [
    "sequence_pos_encoder.pe",
    "embed_timestep.sequence_pos_encoder.pe",
    "clip_model.",
    "bert_model.",
];

/// Settings of a published model that its numbers do not tell: `args.json`, with the defaults of
/// the versions that did not write them yet.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default)]
pub struct PublishedArguments {
    /// `humanml`, `kit`, `humanact12` or `uestc`.
    pub dataset: String,
    /// `trans_enc`, `trans_dec` or `gru`.
    pub arch: String,
    /// `clip` or `bert`.
    pub text_encoder_type: String,
    /// Whether the step is a token in front of a decoder's frames.
    pub emb_trans_dec: bool,
    /// Whether frames behind a motion's end are hidden.
    pub mask_frames: bool,
    /// Steps of diffusion.
    pub diffusion_steps: usize,
    /// Clean frames that a planner goes on from; 0 for networks that make whole motions.
    pub context_len: usize,
    /// Frames that a planner makes at a time.
    pub pred_len: usize,
    /// Share of motions that were learnt without their condition; 0 leaves nothing to guide by.
    pub cond_mask_prob: f64,
}

impl PublishedArguments {
    /// What the text encoder is called by [`TextEncoder::name`](physique_text::TextEncoder::name).
    pub fn text_encoder(&self) -> &str {
        match self.text_encoder_type.as_str() {
            "clip" => "CLIP",
            "bert" => "DistilBERT",
            other => other,
        }
    }
}

impl Default for PublishedArguments {
    fn default() -> Self {
        Self {
            dataset: "humanml".into(),
            arch: "trans_enc".into(),
            text_encoder_type: "clip".into(),
            emb_trans_dec: false,
            mask_frames: false,
            diffusion_steps: 1000,
            context_len: 0,
            pred_len: 0,
            cond_mask_prob: 0.1,
        }
    }
}

/// Reads a published checkpoint: the running average (`model_avg`) where there is one, which
/// sampling uses, or else the flat dictionary; and `args.json` beside it.
///
/// # Errors
/// [`Error::File`]; [`Error::Content`] and [`Error::Checkpoint`] for a broken file;
/// [`Error::Parameters`] unless its names are exactly the network's; [`Error::Setting`] for an
/// architecture other than `trans_enc`, `trans_dec` and `gru`.
pub fn read_published(
    path: &Path,
    limits: &CheckpointLimits,
    device: &Device,
) -> Result<(Mdm, PublishedArguments), Error> {
    let beside = path.with_file_name("args.json");
    let arguments = physique_files::read_file(&beside, 1 << 20)?;
    let arguments = serde_json::from_slice(&arguments);
    let arguments: PublishedArguments = arguments.map_err(|problem| Error::Checkpoint {
        file: beside,
        place: format!("line {}", problem.line()),
        expected: "the settings of a published model".into(),
        found: problem.to_string(),
    })?;
    let checkpoint = TorchCheckpoint::open(path, limits)?;
    let average = "model_avg";
    let key = checkpoint.keys().contains(&average).then_some(average);
    let parameters = checkpoint.state_dictionary(key)?;
    let model = from_parameters(parameters, &arguments, device)?;
    Ok((model, arguments))
}

/// The network of published parameters, whose shapes tell its sizes.
///
/// # Errors
/// As [`read_published`].
pub fn from_parameters(
    parameters: Parameters,
    arguments: &PublishedArguments,
    device: &Device,
) -> Result<Mdm, Error> {
    let parameters = parameters.without(&PASSED_OVER);
    let config = config(&parameters, arguments)?;
    // What the network starts with is overwritten.
    let model = Mdm::new(&config, 0, device)?;
    parameters.load(model, "MDM", PUBLISHED_NAMES)
}

/// The parameters of a network under their published names.
///
/// # Errors
/// [`Error::Device`] where the numbers cannot be fetched.
pub fn parameters_of(model: &Mdm, source: &str) -> Result<Parameters, Error> {
    Parameters::of(model, source, PUBLISHED_NAMES)
}

fn config(parameters: &Parameters, arguments: &PublishedArguments) -> Result<MdmConfig, Error> {
    let (architecture, stack) = match (arguments.arch.as_str(), arguments.emb_trans_dec) {
        ("trans_enc", _) => (Architecture::Encoder, "seqTransEncoder"),
        ("trans_dec", false) => (Architecture::Decoder, "seqTransDecoder"),
        ("trans_dec", true) => (Architecture::DecoderWithTimeToken, "seqTransDecoder"),
        ("gru", _) => (Architecture::GruOverBatch, "gru"),
        (other, _) => {
            let expected = "trans_enc, trans_dec or gru";
            return Err(Error::setting("arch", expected, format!("{other:?}")));
        }
    };
    // Where a name is missing its size is a default, and loading tells of it.
    let published = MdmConfig::default();
    let shape = |name: &str| match parameters.arrays.get(name)?.shape.as_slice() {
        &[rows, columns] => Some([rows, columns]),
        _ => None,
    };
    let pose = shape("input_process.poseEmbedding.weight");
    let [width, columns] = pose.unwrap_or([published.width, published.columns]);
    // A recurrent network reads the condition beside the frame.
    let columns = match architecture.is_recurrent() {
        true => columns.saturating_sub(width),
        false => columns,
    };
    let text =
        shape("embed_text.weight").map(|[_, width]| match arguments.text_encoder_type.as_str() {
            "bert" => ConditionKind::Tokens { width },
            _ => ConditionKind::Sentence { width },
        });
    let actions = shape("embed_action.action_embedding");
    let actions = actions.map(|[count, _]| ConditionKind::Action { count });
    let feed_forward = shape(&format!("{stack}.layers.0.linear1.weight"));
    let layer = |index: &usize| {
        let name = match architecture.is_recurrent() {
            true => format!("{stack}.weight_ih_l{index}"),
            false => format!("{stack}.layers.{index}.norm1.weight"),
        };
        parameters.arrays.contains_key(&name)
    };
    Ok(MdmConfig {
        columns,
        width,
        layers: (0..parameters.arrays.len())
            .take_while(layer)
            .count()
            .max(1),
        feed_forward: feed_forward.map_or(published.feed_forward, |[rows, _]| rows),
        architecture,
        condition: text.or(actions).unwrap_or(ConditionKind::Unconditioned),
        mask_frames: arguments.mask_frames,
        planner: (arguments.context_len > 0).then_some(PlannerConfig {
            context: arguments.context_len,
            prediction: arguments.pred_len,
        }),
        ..published
    })
}
