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
        let encoder = self.architecture == Architecture::Encoder;
        let tokens = matches!(self.condition, ConditionKind::Tokens { .. });
        if encoder && tokens {
            let expected = "a decoder, which captions of many tokens need";
            return Err(Error::setting("architecture", expected, "encoder"));
        }
        if !encoder && (self.norm == NormPlace::Pre || self.condition_every_frame) {
            let expected = "post-norm and no condition on every frame, as decoders have";
            return Err(Error::setting("architecture", expected, "a decoder"));
        }
        Ok(())
    }

    pub(super) const fn layer_sizes(&self) -> LayerSizes {
        LayerSizes {
            width: self.width,
            heads: self.heads,
            feed_forward: self.feed_forward,
        }
    }
}
