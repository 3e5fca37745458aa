//! `torch.nn.GRU`: one layer in both directions, or several in one.

use burn::module::{Module, Param};
use burn::tensor::activation::sigmoid;
use burn::tensor::module::linear;
use burn::tensor::{Tensor, TensorData};

use super::Initialiser;

/// Cho et al., "Learning Phrase Representations using RNN Encoder-Decoder", 2014; gates in
/// PyTorch's order: reset, update, new.
#[derive(Module, Debug)]
pub struct BidirectionalGru {
    /// `[3 hidden][inputs]`.
    weight_ih_l0: Param<Tensor<2>>,
    /// `[3 hidden][hidden]`.
    weight_hh_l0: Param<Tensor<2>>,
    /// `[3 hidden]`.
    bias_ih_l0: Param<Tensor<1>>,
    /// `[3 hidden]`.
    bias_hh_l0: Param<Tensor<1>>,
    weight_ih_l0_reverse: Param<Tensor<2>>,
    weight_hh_l0_reverse: Param<Tensor<2>>,
    bias_ih_l0_reverse: Param<Tensor<1>>,
    bias_hh_l0_reverse: Param<Tensor<1>>,
}

impl BidirectionalGru {
    /// A new layer, with PyTorch's distribution of parameters.
    pub fn new(inputs: usize, hidden: usize, initialiser: &mut Initialiser) -> Self {
        let bound = (hidden.max(1) as f64).sqrt().recip();
        let mut weight = |columns: usize| initialiser.uniform([3 * hidden, columns], bound);
        let [ih, hh, ih_reverse, hh_reverse] = [
            weight(inputs),
            weight(hidden),
            weight(inputs),
            weight(hidden),
        ];
        let mut bias = || initialiser.uniform([3 * hidden], bound);
        Self {
            weight_ih_l0: ih,
            weight_hh_l0: hh,
            bias_ih_l0: bias(),
            bias_hh_l0: bias(),
            weight_ih_l0_reverse: ih_reverse,
            weight_hh_l0_reverse: hh_reverse,
            bias_ih_l0_reverse: bias(),
            bias_hh_l0_reverse: bias(),
        }
    }

    /// The states after the last element of each sequence: forwards from the first element, and
    /// backwards from the last one to the first, side by side: `[batch][2 hidden]`.
    ///
    /// `x` is `[batch][steps][inputs]`, of which a sequence has `lengths` steps, as packed
    /// sequences of PyTorch do; `start` is `[2][batch][hidden]`.
    pub fn last_states(&self, x: Tensor<3>, lengths: &[usize], start: Tensor<3>) -> Tensor<2> {
        let start = |direction: usize| start.clone().narrow(0, direction, 1).squeeze_dim::<2>(0);
        let forwards = Direction {
            from_input: self.weight_ih_l0.val(),
            from_state: self.weight_hh_l0.val(),
            input_bias: self.bias_ih_l0.val(),
            state_bias: self.bias_hh_l0.val(),
        };
        let backwards = Direction {
            from_input: self.weight_ih_l0_reverse.val(),
            from_state: self.weight_hh_l0_reverse.val(),
            input_bias: self.bias_ih_l0_reverse.val(),
            state_bias: self.bias_hh_l0_reverse.val(),
        };
        let steps = x.dims()[1];
        let ahead = forwards.run(x.clone(), lengths, start(0), 0..steps);
        let back = backwards.run(x, lengths, start(1), (0..steps).rev());
        Tensor::cat(vec![ahead, back], 1)
    }
}

/// Several layers, each forwards over what the one before says of every step.
#[derive(Module, Debug)]
pub struct Gru {
    layers: Vec<GruLayer>,
}

/// Parameters of a layer; PyTorch ends their names by the layer's number.
#[derive(Module, Debug)]
struct GruLayer {
    weight_ih: Param<Tensor<2>>,
    weight_hh: Param<Tensor<2>>,
    bias_ih: Param<Tensor<1>>,
    bias_hh: Param<Tensor<1>>,
}

impl Gru {
    /// New layers of `width` inputs and as many outputs, with PyTorch's distribution of parameters.
    pub fn new(layers: usize, width: usize, initialiser: &mut Initialiser) -> Self {
        let bound = (width.max(1) as f64).sqrt().recip();
        let mut weight = || initialiser.uniform([3 * width, width], bound);
        let weights: Vec<_> = (0..layers).map(|_| [weight(), weight()]).collect();
        let mut bias = || initialiser.uniform([3 * width], bound);
        let layers = weights.into_iter().map(|[weight_ih, weight_hh]| GruLayer {
            weight_ih,
            weight_hh,
            bias_ih: bias(),
            bias_hh: bias(),
        });
        Self {
            layers: layers.collect(),
        }
    }

    /// The states of the last layer after every step, `[batch][steps][width]`, from states of zeros;
    /// `x` is of the same shape.
    pub fn forward(&self, x: Tensor<3>) -> Tensor<3> {
        self.layers.iter().fold(x, |x, layer| {
            let [batch, steps, width] = x.dims();
            let direction = Direction {
                from_input: layer.weight_ih.val(),
                from_state: layer.weight_hh.val(),
                input_bias: layer.bias_ih.val(),
                state_bias: layer.bias_hh.val(),
            };
            let inputs = direction.inputs(x);
            let mut state = Tensor::zeros([batch, width], &inputs.device());
            let states = (0..steps).map(|step| {
                let input = inputs.clone().narrow(1, step, 1).squeeze_dim::<2>(1);
                state = direction.next(&input, state.clone());
                state.clone()
            });
            Tensor::stack(states.collect(), 1)
        })
    }
}

/// Parameters of one direction.
struct Direction {
    from_input: Tensor<2>,
    from_state: Tensor<2>,
    input_bias: Tensor<1>,
    state_bias: Tensor<1>,
}

impl Direction {
    /// What the inputs of all steps add to the gates: only the state has to wait for the step before.
    fn inputs(&self, x: Tensor<3>) -> Tensor<3> {
        let weight = self.from_input.clone().transpose();
        linear(x, weight, Some(self.input_bias.clone()))
    }

    /// The state after a step, of what its input adds to the gates and the state before it.
    fn next(&self, input: &Tensor<2>, state: Tensor<2>) -> Tensor<2> {
        let hidden = state.dims()[1];
        let recurrent = linear(
            state.clone(),
            self.from_state.clone().transpose(),
            Some(self.state_bias.clone()),
        );
        let gate =
            |tensor: &Tensor<2>, index: usize| tensor.clone().narrow(1, index * hidden, hidden);
        let reset = sigmoid(gate(input, 0) + gate(&recurrent, 0));
        let update = sigmoid(gate(input, 1) + gate(&recurrent, 1));
        let new = (gate(input, 2) + reset * gate(&recurrent, 2)).tanh();
        new.clone() + update * (state - new)
    }

    fn run(
        &self,
        x: Tensor<3>,
        lengths: &[usize],
        start: Tensor<2>,
        order: impl Iterator<Item = usize>,
    ) -> Tensor<2> {
        let (batch, device) = (start.dims()[0], x.device());
        let inputs = self.inputs(x);
        let mut state = start;
        for step in order {
            let input = inputs.clone().narrow(1, step, 1).squeeze_dim::<2>(1);
            let next = self.next(&input, state.clone());
            // A sequence that has no such step keeps its state.
            let within = lengths
                .iter()
                .map(|&length| f32::from(u8::from(step < length)));
            let within = TensorData::new(within.collect(), [batch, 1]);
            let within = Tensor::<2>::from_data(within, &device);
            state = state.clone() + (next - state) * within;
        }
        state
    }
}
