//! The shape of a network.

use serde::{Deserialize, Serialize};

use crate::Error;
use crate::layers::{LayerSizes, NormPlace};

/// Everything about a motion diffusion model but its numbers.
///
/// The default is the published `humanml_trans_enc_512`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MdmConfig {
    /// Features a frame.
    pub columns: usize,
    /// Numbers a frame inside the network.
    pub width: usize,
    /// Transformer layers.
    pub layers: usize,
    /// Heads of attention; divide the width.
    pub heads: usize,
    /// Width between the two linear layers of a transformer layer.
    pub feed_forward: usize,
    /// Share of activations that is dropped in training.
    pub dropout: f64,
    /// How the condition gets in.
    pub architecture: Architecture,
    /// What the motion is described by.
    pub condition: ConditionKind,
    /// Whether frames behind a motion's end are hidden; the first published models see them.
    pub mask_frames: bool,
    /// Where transformer layers normalise; encoders only.
    pub norm: NormPlace,
    /// Whether every frame gets the condition added besides the token; encoders only.
    pub condition_every_frame: bool,
    /// Frames that are taken together, to halve the sequence or more.
    pub frames_per_token: usize,
    /// Of networks that plan a motion piece by piece (DiP): how much they see and say at a time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planner: Option<PlannerConfig>,
}

/// How a network goes on with a motion: CLoSD's diffusion planner, Tevet et al., ICLR 2025.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannerConfig {
    /// Clean frames in front, which it goes on from: 20 as published.
    pub context: usize,
    /// Frames that it makes at a time: 40 as published.
    pub prediction: usize,
}

/// How the condition gets into the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Architecture {
    /// `trans_enc`: as a token in front of the frames.
    Encoder,
    /// `trans_dec`: as a memory that frames look at.
    Decoder,
    /// `trans_dec` with `emb_trans_dec`: besides, the step is a token in front of the frames.
    DecoderWithTimeToken,
    /// Beside every frame, on the way into a recurrent network that walks over the frames.
    Gru,
    /// `gru`, as published: the same, but it walks over the motions of a batch, so that a motion depends
    /// on those before it. For published files; alone in a batch, frames know nothing of each other.
    GruOverBatch,
}

impl Architecture {
    pub(super) const fn is_decoder(self) -> bool {
        matches!(self, Self::Decoder | Self::DecoderWithTimeToken)
    }

    pub(super) const fn is_recurrent(self) -> bool {
        matches!(self, Self::Gru | Self::GruOverBatch)
    }
}

/// What motions are described by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ConditionKind {
    /// Nothing.
    Unconditioned,
    /// One vector a caption, as of CLIP.
    Sentence {
        /// Numbers of the vector.
        width: usize,
    },
    /// A vector for each token of a caption, as of DistilBERT; decoders only.
    Tokens {
        /// Numbers a vector.
        width: usize,
    },
    /// The number of an action.
    Action {
        /// How many there are.
        count: usize,
    },
}

impl Default for MdmConfig {
    fn default() -> Self {
        Self {
            columns: 263,
            width: 512,
            layers: 8,
            heads: 4,
            feed_forward: 1024,
            dropout: 0.1,
            architecture: Architecture::Encoder,
            condition: ConditionKind::Sentence { width: 512 },
            mask_frames: false,
            norm: NormPlace::Post,
            condition_every_frame: false,
            frames_per_token: 1,
            planner: None,
        }
    }
}

impl MdmConfig {
    /// Whether a network of this shape can be.
    ///
    /// # Errors
    /// [`Error::Setting`] with the first setting that cannot.
    pub fn check(&self) -> Result<(), Error> {
        let sizes = [
            ("columns", self.columns, 1 << 16),
            ("width", self.width, 1 << 14),
            ("layers", self.layers, 1 << 10),
            ("feed_forward", self.feed_forward, 1 << 16),
            ("frames_per_token", self.frames_per_token, 64),
        ];
        for (what, found, most) in sizes {
            if !(1..=most).contains(&found) {
                return Err(Error::setting(what, format!("1 to {most}"), found));
            }
        }
        if let Some(planner) = self.planner {
            for (what, found) in [
                ("context of the planner", planner.context),
                ("prediction of the planner", planner.prediction),
            ] {
                let together = self.frames_per_token;
                if !(1..=1 << 16).contains(&found) || !found.is_multiple_of(together) {
                    let expected = format!("1 to 65536 frames, a multiple of {together}");
                    return Err(Error::setting(what, expected, found));
                }
            }
        }
        if self.heads == 0 || !self.width.is_multiple_of(self.heads) {
            let expected = format!("a divisor of the width of {}", self.width);
            return Err(Error::setting("heads", expected, self.heads));
        }
        if !(0.0..1.0).contains(&self.dropout) {
            let expected = "at least 0 and below 1";
            return Err(Error::setting("dropout", expected, self.dropout));
        }
        let (what, found, most) = match self.condition {
            ConditionKind::Unconditioned => return self.check_architecture(),
            ConditionKind::Sentence { width } | ConditionKind::Tokens { width } => {
                ("width of the condition", width, 1 << 14)
            }
            ConditionKind::Action { count } => ("count of actions", count, 1 << 20),
        };
        if !(1..=most).contains(&found) {
            return Err(Error::setting(what, format!("1 to {most}"), found));
        }
        self.check_architecture()
    }

    /// What only encoders or decoders can.
    fn check_architecture(&self) -> Result<(), Error> {
        let found = format!("{:?}", self.architecture);
        let encoder = self.architecture == Architecture::Encoder;
        let tokens = matches!(self.condition, ConditionKind::Tokens { .. });
        if tokens && !self.architecture.is_decoder() {
            let expected = "a decoder, which captions of many tokens need";
            return Err(Error::setting("architecture", expected, found));
        }
        if !encoder && (self.norm == NormPlace::Pre || self.condition_every_frame) {
            let expected = "an encoder, for pre-norm or the condition on every frame";
            return Err(Error::setting("architecture", expected, found));
        }
        Ok(())
    }

    /// Frames in front that the network goes on from; 0 for networks that make whole motions.
    pub fn context(&self) -> usize {
        self.planner.map_or(0, |planner| planner.context)
    }

    /// Whether a file of so many numbers can hold this network: memory is taken for a network before its
    /// numbers are put in, and a stranger's file may claim any size.
    ///
    /// # Errors
    /// [`Error::Setting`] where it is far too small.
    pub(super) fn check_size(&self, numbers: usize) -> Result<(), Error> {
        const FREE: u64 = 1 << 22;
        let count = |factors: &[usize]| {
            let factors = factors.iter().map(|&factor| factor as u64);
            factors.fold(1, u64::saturating_mul)
        };
        let width = self.width;
        let squares = match self.architecture {
            Architecture::Encoder => 4,
            Architecture::Decoder | Architecture::DecoderWithTimeToken => 8,
            Architecture::Gru | Architecture::GruOverBatch => 6,
        };
        let condition = match self.condition {
            ConditionKind::Unconditioned => 0,
            ConditionKind::Sentence { width } | ConditionKind::Tokens { width } => width,
            ConditionKind::Action { count } => count,
        };
        let parts = [
            count(&[2, self.columns, self.frames_per_token, width]),
            count(&[condition, width]),
            count(&[self.layers, squares, width, width]),
            match self.architecture.is_recurrent() {
                true => 0,
                false => count(&[2, self.layers, self.feed_forward, width]),
            },
        ];
        let claimed = parts.into_iter().fold(0, u64::saturating_add);
        if claimed <= (numbers as u64).saturating_mul(2).max(FREE) {
            return Ok(());
        }
        let expected = format!("one of about {numbers} numbers, as its file has");
        let found = format!("one of {claimed} or more");
        Err(Error::setting("network", expected, found))
    }

    pub(super) const fn layer_sizes(&self) -> LayerSizes {
        LayerSizes {
            width: self.width,
            heads: self.heads,
            feed_forward: self.feed_forward,
        }
    }
}
