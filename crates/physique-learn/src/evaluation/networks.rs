//! The networks that embed captions and motions, with their published names.

use burn::module::{Module, Param};
use burn::tensor::Tensor;
use burn::tensor::activation::leaky_relu;

use crate::layers::{BidirectionalGru, Convolution, Initialiser, LayerNorm, Linear};
use crate::parameters::NameTable;

/// Slope of the rectifiers below 0.
const SLOPE: f64 = 0.2;
/// Numbers of a word's vector.
pub(super) const WORD: usize = 300;
pub(super) const PARTS_OF_SPEECH: usize = 15;
/// Numbers of an embedding, and of a step of movement.
const EMBEDDING: usize = 512;
const TEXT_STATE: usize = 512;
const MOTION_STATE: usize = 1024;

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
    pub(super) fn new(columns: usize, initialiser: &mut Initialiser) -> Self {
        Self {
            first: Convolution::new([EMBEDDING, columns, 4], 2, 1, initialiser),
            second: Convolution::new([EMBEDDING, EMBEDDING, 4], 2, 1, initialiser),
            output: Linear::new(EMBEDDING, EMBEDDING, initialiser),
        }
    }

    /// `[motions][frames][columns]` to `[motions][frames / 4][512]`.
    pub(super) fn forward(&self, motions: Tensor<3>) -> Tensor<3> {
        let x = leaky_relu(self.first.forward(motions.swap_dims(1, 2)), SLOPE);
        let x = leaky_relu(self.second.forward(x), SLOPE);
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
    pub(super) fn new(initialiser: &mut Initialiser) -> Self {
        Self {
            pos_emb: Linear::new(PARTS_OF_SPEECH, WORD, initialiser),
            input_emb: Linear::new(WORD, TEXT_STATE, initialiser),
            hidden: initialiser.normal([2, 1, TEXT_STATE], 1.0),
            gru: BidirectionalGru::new(TEXT_STATE, TEXT_STATE, initialiser),
            output: Output::new(TEXT_STATE, initialiser),
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
    pub(super) fn new(initialiser: &mut Initialiser) -> Self {
        Self {
            input_emb: Linear::new(EMBEDDING, MOTION_STATE, initialiser),
            hidden: initialiser.normal([2, 1, MOTION_STATE], 1.0),
            gru: BidirectionalGru::new(MOTION_STATE, MOTION_STATE, initialiser),
            output: Output::new(MOTION_STATE, initialiser),
        }
    }

    pub(super) fn forward(&self, movement: Tensor<3>, steps: &[usize]) -> Tensor<2> {
        let x = self.input_emb.forward(movement);
        let start = self.hidden.val().repeat_dim(1, steps.len());
        self.output.forward(self.gru.last_states(x, steps, start))
    }
}

/// Both directions' last states to a point.
#[derive(Module, Debug)]
struct Output {
    first: Linear,
    norm: LayerNorm,
    second: Linear,
}

impl Output {
    fn new(state: usize, initialiser: &mut Initialiser) -> Self {
        Self {
            first: Linear::new(2 * state, state, initialiser),
            norm: LayerNorm::new(state, initialiser),
            second: Linear::new(state, EMBEDDING, initialiser),
        }
    }

    fn forward(&self, states: Tensor<2>) -> Tensor<2> {
        let x = leaky_relu(self.norm.forward(self.first.forward(states)), SLOPE);
        self.second.forward(x)
    }
}
