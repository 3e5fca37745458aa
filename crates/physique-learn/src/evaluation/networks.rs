//! The networks that embed captions and motions, with their published names.

use burn::module::{Module, Param};
use burn::tensor::Tensor;
use burn::tensor::activation::leaky_relu;

use serde::{Deserialize, Serialize};

use crate::Error;
use crate::layers::{BidirectionalGru, Convolution, Dropout, Initialiser, LayerNorm, Linear};
use crate::parameters::NameTable;

/// Slope of the rectifiers below 0.
const SLOPE: f64 = 0.2;
/// Numbers of a word's vector.
pub(super) const WORD: usize = 300;
pub(super) const PARTS_OF_SPEECH: usize = 15;

/// Widths of an evaluator's networks; the default is as published.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EvaluatorSizes {
    /// Numbers of a step of movement.
    pub movement: usize,
    /// State of the motion encoder, in each direction.
    pub motion_state: usize,
    /// State of the text encoder, in each direction; of one that reads sentences: its hidden layer.
    pub text_state: usize,
    /// Numbers of an embedding.
    pub embedding: usize,
}

impl Default for EvaluatorSizes {
    fn default() -> Self {
        Self {
            movement: 512,
            motion_state: 1024,
            text_state: 512,
            embedding: 512,
        }
    }
}

impl EvaluatorSizes {
    /// Widest layer that a file may ask for.
    const WIDEST: usize = 1 << 13;

    pub(super) fn check(&self) -> Result<(), Error> {
        let Self {
            movement,
            motion_state,
            text_state,
            embedding,
        } = *self;
        for (what, found) in [
            ("movement", movement),
            ("motion_state", motion_state),
            ("text_state", text_state),
            ("embedding", embedding),
        ] {
            if !(1..=Self::WIDEST).contains(&found) {
                let expected = format!("1 to {}", Self::WIDEST);
                return Err(Error::setting(what, expected, found));
            }
        }
        Ok(())
    }
}

/// Two convolutions of stride 2 and a linear layer: four frames to a step.
#[derive(Module, Debug)]
pub(super) struct MovementEncoder {
    first: Convolution,
    second: Convolution,
    output: Linear,
}

pub(super) const MOVEMENT_NAMES: NameTable = &[
    ("first", "main.0"),
    ("second", "main.3"),
    ("output", "out_net"),
];

impl MovementEncoder {
    pub(super) fn new(columns: usize, width: usize, initialiser: &mut Initialiser) -> Self {
        Self {
            first: Convolution::new([width, columns, 4], 2, 1, initialiser),
            second: Convolution::new([width, width, 4], 2, 1, initialiser),
            output: Linear::new(width, width, initialiser),
        }
    }

    /// `[motions][frames][columns]` to `[motions][frames / 4][width]`.
    pub(super) fn forward(&self, motions: Tensor<3>, dropout: &Dropout) -> Tensor<3> {
        let x = dropout.apply(self.first.forward(motions.swap_dims(1, 2)));
        let x = dropout.apply(self.second.forward(leaky_relu(x, SLOPE)));
        let x = leaky_relu(x, SLOPE);
        self.output.forward(x.swap_dims(1, 2))
    }
}

/// Words to a point: their vectors and parts of speech through a bidirectional GRU.
#[derive(Module, Debug)]
pub(super) struct TextEncoder {
    pos_emb: Linear,
    input_emb: Linear,
    /// `[2][1][state]`: what both directions start with.
    hidden: Param<Tensor<3>>,
    gru: BidirectionalGru,
    output: Output,
}

pub(super) const TEXT_NAMES: NameTable = &[
    ("output.first", "output_net.0"),
    ("output.norm", "output_net.1"),
    ("output.second", "output_net.3"),
];

impl TextEncoder {
    pub(super) fn new(sizes: EvaluatorSizes, initialiser: &mut Initialiser) -> Self {
        let state = sizes.text_state;
        Self {
            pos_emb: Linear::new(PARTS_OF_SPEECH, WORD, initialiser),
            input_emb: Linear::new(WORD, state, initialiser),
            hidden: initialiser.normal([2, 1, state], 1.0),
            gru: BidirectionalGru::new(state, state, initialiser),
            output: Output::new([2 * state, state, sizes.embedding], initialiser),
        }
    }

    pub(super) fn forward(
        &self,
        words: Tensor<3>,
        parts: Tensor<3>,
        lengths: &[usize],
    ) -> Tensor<2> {
        let x = self.input_emb.forward(words + self.pos_emb.forward(parts));
        let start = self.hidden.val().repeat_dim(1, lengths.len());
        self.output.forward(self.gru.last_states(x, lengths, start))
    }
}

/// Steps of movement to a point.
#[derive(Module, Debug)]
pub(super) struct MotionEncoder {
    input_emb: Linear,
    /// `[2][1][state]`: what both directions start with.
    hidden: Param<Tensor<3>>,
    gru: BidirectionalGru,
    output: Output,
}

impl MotionEncoder {
    pub(super) fn new(sizes: EvaluatorSizes, initialiser: &mut Initialiser) -> Self {
        let state = sizes.motion_state;
        Self {
            input_emb: Linear::new(sizes.movement, state, initialiser),
            hidden: initialiser.normal([2, 1, state], 1.0),
            gru: BidirectionalGru::new(state, state, initialiser),
            output: Output::new([2 * state, state, sizes.embedding], initialiser),
        }
    }

    pub(super) fn forward(&self, movement: Tensor<3>, steps: &[usize]) -> Tensor<2> {
        let x = self.input_emb.forward(movement);
        let start = self.hidden.val().repeat_dim(1, steps.len());
        self.output.forward(self.gru.last_states(x, steps, start))
    }
}

/// Both directions' last states, or a sentence, to a point.
#[derive(Module, Debug)]
pub(super) struct Output {
    first: Linear,
    norm: LayerNorm,
    second: Linear,
}

impl Output {
    pub(super) fn new(
        [inputs, hidden, embedding]: [usize; 3],
        initialiser: &mut Initialiser,
    ) -> Self {
        Self {
            first: Linear::new(inputs, hidden, initialiser),
            norm: LayerNorm::new(hidden, initialiser),
            second: Linear::new(hidden, embedding, initialiser),
        }
    }

    pub(super) fn forward(&self, states: Tensor<2>) -> Tensor<2> {
        let x = leaky_relu(self.norm.forward(self.first.forward(states)), SLOPE);
        self.second.forward(x)
    }
}
