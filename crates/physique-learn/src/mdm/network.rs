//! The network, top to bottom as in the paper's figure 2.

use burn::module::Module;
use burn::tensor::{Device, Tensor};

use super::time_embedding::TimeEmbedding;
use super::{Architecture, Condition, ConditionKind, MdmConfig};
use crate::Error;
use crate::layers::{
    Dropout, Embedding, Gru, Initialiser, Linear, Memory, TransformerDecoder, TransformerEncoder,
    positions,
};
use crate::tensors::{padding, tensor};

/// A motion diffusion model.
#[derive(Module, Debug)]
pub struct Mdm {
    pose_embedding: Linear,
    time_embedding: TimeEmbedding,
    text_embedding: Option<Linear>,
    action_embedding: Option<Embedding>,
    encoder: Option<TransformerEncoder>,
    decoder: Option<TransformerDecoder>,
    gru: Option<Gru>,
    pose_final: Linear,
    #[module(skip)]
    config: MdmConfig,
}

/// What a network is asked.
#[derive(Clone, Debug)]
pub struct MdmQuery<'a> {
    /// x_t, `[batch][frames][columns]`.
    pub noisy: Tensor<3>,
    /// The step of each motion, as the network counts.
    pub steps: &'a [usize],
    /// What the motions are to be.
    pub condition: &'a Condition,
    /// Which motions the condition counts for; `None`: for all.
    pub conditioned: Option<&'a [bool]>,
    /// Frames of each motion, where some are shorter; only networks with `mask_frames` mind.
    pub lengths: Option<&'a [usize]>,
    /// Clean frames that the motions go on from, `[batch][context][columns]`; planners only.
    pub context: Option<Tensor<3>>,
}

impl Mdm {
    /// A new network, whose parameters depend on the seed only.
    ///
    /// # Errors
    /// Those of [`MdmConfig::check`].
    pub fn new(config: &MdmConfig, seed: u64, device: &Device) -> Result<Self, Error> {
        config.check()?;
        let initialiser = &mut Initialiser::new(seed, device);
        let (width, sizes) = (config.width, config.layer_sizes());
        let columns = config.columns * config.frames_per_token;
        let (encodes, recurs) = (
            config.architecture == Architecture::Encoder,
            config.architecture.is_recurrent(),
        );
        let beside = if recurs { width } else { 0 };
        let text = match config.condition {
            ConditionKind::Sentence { width } | ConditionKind::Tokens { width } => Some(width),
            _ => None,
        };
        let actions = match config.condition {
            ConditionKind::Action { count } => Some(count),
            _ => None,
        };
        Ok(Self {
            pose_embedding: Linear::new(columns + beside, width, initialiser),
            time_embedding: TimeEmbedding::new(width, initialiser),
            text_embedding: text.map(|inputs| Linear::new(inputs, width, initialiser)),
            action_embedding: actions.map(|count| Embedding::new(count, width, initialiser)),
            encoder: encodes.then(|| TransformerEncoder::new(config.layers, sizes, initialiser)),
            decoder: config
                .architecture
                .is_decoder()
                .then(|| TransformerDecoder::new(config.layers, sizes, initialiser)),
            gru: recurs.then(|| Gru::new(config.layers, width, initialiser)),
            pose_final: Linear::new(width, columns, initialiser),
            config: config.clone(),
        })
    }

    /// The network's shape.
    pub const fn config(&self) -> &MdmConfig {
        &self.config
    }

    /// Where the network's numbers are.
    pub(super) fn device(&self) -> Device {
        let mut devices = self.devices().into_iter();
        devices.next().unwrap_or_default()
    }

    /// The prediction of the clean motions x_0, `[batch][frames][columns]`.
    ///
    /// # Errors
    /// [`Error::Input`] where shapes, counts, steps or the condition do not fit the network.
    pub fn forward(&self, query: MdmQuery<'_>, dropout: &Dropout) -> Result<Tensor<3>, Error> {
        self.check(&query)?;
        let [batch, frames, columns] = query.noisy.dims();
        let context = self.config.context();
        let seen = match query.context {
            Some(context) => Tensor::cat(vec![context, query.noisy], 1),
            None => query.noisy,
        };
        let together = self.config.frames_per_token;
        let tokens = (context + frames) / together;
        let device = seen.device();

        let time = self.time_embedding.forward(query.steps, &device);
        let time = time.unsqueeze_dim::<3>(1);
        let condition = self.embed(query.condition, query.conditioned, time.clone())?;
        let lengths = query.lengths.filter(|_| self.config.mask_frames);
        let lengths = lengths.map(|lengths| {
            let lengths = lengths.iter().map(|length| length + context);
            lengths.map(|length| length.div_ceil(together)).collect()
        });
        let x = seen.reshape([batch, tokens, columns * together]);
        let x = self.through(x, condition, time, lengths, dropout);
        let x = self.pose_final.forward(x);
        let x = x.reshape([batch, context + frames, columns]);
        Ok(x.narrow(1, context, frames))
    }

    /// What the layers make of tokens `[batch][tokens][columns]`: `[batch][tokens][width]`; motions have
    /// `lengths` of them, behind which nobody looks.
    fn through(
        &self,
        x: Tensor<3>,
        condition: Memory,
        time: Tensor<3>,
        lengths: Option<Vec<usize>>,
        dropout: &Dropout,
    ) -> Tensor<3> {
        let [batch, tokens, _] = x.dims();
        let device = x.device();
        let hidden = |in_front: usize| {
            let lengths = lengths.as_ref()?.iter().map(|length| length + in_front);
            let lengths: Vec<usize> = lengths.collect();
            Some(padding(&lengths, tokens + in_front, &device))
        };
        if let Some(encoder) = &self.encoder {
            let x = self.pose_embedding.forward(x);
            let x = if self.config.condition_every_frame {
                x + condition.tokens.clone()
            } else {
                x
            };
            let x = in_order(Tensor::cat(vec![condition.tokens, x], 1), dropout);
            return encoder
                .forward(x, self.config.norm, hidden(1).as_ref(), dropout)
                .narrow(1, 1, tokens);
        }
        if let Some(decoder) = &self.decoder {
            let x = self.pose_embedding.forward(x);
            let with_time = self.config.architecture == Architecture::DecoderWithTimeToken;
            let in_front = usize::from(with_time);
            let x = if with_time {
                Tensor::cat(vec![time, x], 1)
            } else {
                x
            };
            let x = in_order(x, dropout);
            return decoder
                .forward(x, &condition, hidden(in_front).as_ref(), dropout)
                .narrow(1, in_front, tokens);
        }
        let beside = condition.tokens.expand([batch, tokens, self.config.width]);
        let x = self.pose_embedding.forward(Tensor::cat(vec![x, beside], 2));
        let x = in_order(x, dropout);
        match (&self.gru, self.config.architecture) {
            (Some(gru), Architecture::GruOverBatch) => {
                gru.forward(x.swap_dims(0, 1)).swap_dims(0, 1)
            }
            (Some(gru), _) => gru.forward(x),
            (None, _) => x,
        }
    }

    /// The step and the condition together: `[batch][tokens or 1][width]`.
    fn embed(
        &self,
        condition: &Condition,
        conditioned: Option<&[bool]>,
        time: Tensor<3>,
    ) -> Result<Memory, Error> {
        // A condition that does not count is a zero vector in front of the layer, whose bias stays.
        let counts = |tokens: Tensor<3>| match conditioned {
            None => tokens,
            Some(conditioned) => {
                let factors = conditioned
                    .iter()
                    .map(|&counts| f32::from(u8::from(counts)));
                let shape = [conditioned.len(), 1, 1];
                let factors = tensor(factors.collect(), shape, &tokens.device());
                tokens * factors
            }
        };
        let (tokens, padding) = match (condition, &self.text_embedding, &self.action_embedding) {
            (Condition::Text { tokens, padding }, Some(embedding), _) => {
                let tokens = embedding.forward(counts(tokens.clone()));
                (tokens + time, padding.clone())
            }
            (Condition::Actions(actions), _, Some(embedding)) => {
                let rows = embedding.rows(actions, "Number of an action")?;
                (counts(rows.unsqueeze_dim(1)) + time, None)
            }
            (Condition::Nothing, None, None) => (time, None),
            _ => {
                let found = match condition {
                    Condition::Nothing => "nothing",
                    Condition::Text { .. } => "captions",
                    Condition::Actions(_) => "actions",
                };
                let expected = format!("{:?}", self.config.condition);
                return Err(Error::input("Condition", expected, found));
            }
        };
        Ok(Memory { tokens, padding })
    }

    fn check(&self, query: &MdmQuery<'_>) -> Result<(), Error> {
        let [batch, frames, columns] = query.noisy.dims();
        if columns != self.config.columns {
            let expected = format!("{} columns", self.config.columns);
            return Err(Error::input("Motions", expected, columns));
        }
        let together = self.config.frames_per_token;
        if frames == 0 || !frames.is_multiple_of(together) {
            let expected = format!("a multiple of {together} frames");
            return Err(Error::input("Motions", expected, frames));
        }
        let expected = self
            .config
            .planner
            .map(|planner| [batch, planner.context, columns]);
        let found = query.context.as_ref().map(Tensor::dims);
        if expected != found {
            let show = |shape: Option<[usize; 3]>| match shape {
                Some(shape) => format!("{shape:?}"),
                None => "none".to_owned(),
            };
            return Err(Error::input("Context", show(expected), show(found)));
        }
        if let Some(length) = query.lengths.and_then(|lengths| {
            lengths
                .iter()
                .find(|&&length| !(1..=frames).contains(&length))
        }) {
            let expected = format!("1 to {frames} frames");
            return Err(Error::input("Length of a motion", expected, length));
        }
        let counts = [
            ("Steps", Some(query.steps.len())),
            ("Conditioned motions", query.conditioned.map(<[bool]>::len)),
            ("Lengths", query.lengths.map(<[usize]>::len)),
            ("Conditions", query.condition.count()),
        ];
        for (what, count) in counts {
            if let Some(count) = count.filter(|&count| count != batch) {
                return Err(Error::input(what, format!("{batch}, one a motion"), count));
            }
        }
        let Condition::Text { tokens, .. } = query.condition else {
            return Ok(());
        };
        let [_, count, width] = tokens.dims();
        let fits = match self.config.condition {
            ConditionKind::Sentence { width: expected } => count == 1 && width == expected,
            ConditionKind::Tokens { width: expected } => width == expected,
            // The kind of condition is checked where it is used.
            _ => true,
        };
        if !fits {
            let expected = format!("{:?}", self.config.condition);
            let found = format!("{count} vectors of {width}");
            return Err(Error::input("Captions", expected, found));
        }
        Ok(())
    }
}

impl Condition {
    /// Motions that it is for; `None`: any number.
    fn count(&self) -> Option<usize> {
        match self {
            Self::Nothing => None,
            Self::Text { tokens, .. } => Some(tokens.dims()[0]),
            Self::Actions(actions) => Some(actions.len()),
        }
    }
}

/// Adds to each frame its place in the sequence.
fn in_order(x: Tensor<3>, dropout: &Dropout) -> Tensor<3> {
    let [_, frames, width] = x.dims();
    let places = positions::tensor(0..frames, width, &x.device());
    dropout.apply(x + places.unsqueeze_dim::<3>(0))
}
