//! A fully connected network: parameters by name, and the way forward.

use std::ops::Range;

use rayon::prelude::*;

use super::matrix::{Matrix, dot, multiply};
use crate::Error;

/// The shape of a network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NetworkLayout {
    layers: Vec<Layer>,
    /// The layer that also reads the network's inputs, behind its predecessor's outputs.
    skip: Option<usize>,
    parameters: Vec<Parameter>,
}

/// One array of a network's parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Its published name, such as `net1.0.weight_g`.
    pub name: String,
    /// Its dimensions; the last runs fastest.
    pub shape: Vec<usize>,
    /// Where its numbers are among all parameters.
    pub range: Range<usize>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Layer {
    pub(crate) inputs: usize,
    pub(crate) outputs: usize,
    /// `[outputs][inputs]`: weights, or their directions where there are gains.
    pub(crate) weight: Range<usize>,
    /// `[outputs]` lengths of the rows of weights (weight normalisation).
    pub(crate) gain: Option<Range<usize>>,
    pub(crate) bias: Range<usize>,
}

impl NetworkLayout {
    /// A layout without layers yet.
    pub(crate) fn new() -> Self {
        Self {
            layers: Vec::new(),
            skip: None,
            parameters: Vec::new(),
        }
    }

    /// Appends `Linear(inputs, outputs)` called `name`; `normalised` splits its weights into
    /// direction and length, `W = g v / |v|` row by row (Salimans and Kingma, 2016).
    pub(crate) fn linear(
        mut self,
        name: &str,
        inputs: usize,
        outputs: usize,
        normalised: bool,
    ) -> Self {
        let mut add = |part: &str, shape: Vec<usize>| {
            let start = self.parameters.last().map_or(0, |last| last.range.end);
            let range = start..start + shape.iter().product::<usize>();
            let name = format!("{name}.{part}");
            self.parameters.push(Parameter {
                name,
                shape,
                range: range.clone(),
            });
            range
        };
        let direction = if normalised { "weight_v" } else { "weight" };
        let weight = add(direction, vec![outputs, inputs]);
        let gain = normalised.then(|| add("weight_g", vec![outputs, 1]));
        let bias = add("bias", vec![outputs]);
        self.layers.push(Layer {
            inputs,
            outputs,
            weight,
            gain,
            bias,
        });
        self
    }

    /// The next layer reads the network's inputs, too.
    pub(crate) fn skip(mut self) -> Self {
        self.skip = Some(self.layers.len());
        self
    }

    /// All arrays of parameters, in the order in which they are stored.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// How many numbers all parameters are.
    pub fn parameter_count(&self) -> usize {
        self.parameters.last().map_or(0, |last| last.range.end)
    }

    pub(crate) fn layers(&self) -> &[Layer] {
        &self.layers
    }

    pub(crate) fn skip_layer(&self) -> Option<usize> {
        self.skip
    }

    /// Numbers that the network reads.
    pub fn input_count(&self) -> usize {
        self.layers.first().map_or(0, |layer| layer.inputs)
    }

    /// Numbers that the network gives.
    pub fn output_count(&self) -> usize {
        self.layers.last().map_or(0, |layer| layer.outputs)
    }
}

/// A layout with parameters, ready to evaluate.
#[derive(Clone, Debug)]
pub struct Network {
    layout: NetworkLayout,
    parameters: Vec<f32>,
    /// Weights as the layers use them, at the places of `Layer::weight`.
    weights: Vec<f32>,
}

/// What each layer reads for a batch of inputs, and what the last one gives. Reuse it.
#[derive(Clone, Debug, Default)]
pub struct Activations {
    /// `[layers + 1][features][batch]`.
    pub(crate) values: Vec<Vec<f32>>,
    pub(crate) batch: usize,
}

impl Activations {
    /// `[outputs][batch]`: what the network gives.
    pub fn outputs(&self) -> &[f32] {
        self.values.last().map_or(&[], Vec::as_slice)
    }
}

impl Network {
    /// # Errors
    /// [`Error::Regressor`] unless there is one finite number a parameter, and no direction of
    /// length 0.
    pub(crate) fn new(layout: NetworkLayout, parameters: Vec<f32>) -> Result<Self, Error> {
        if parameters.len() != layout.parameter_count() {
            return Err(Error::Regressor {
                array: "all parameters".into(),
                expected: format!("{} numbers", layout.parameter_count()),
                found: parameters.len().to_string(),
            });
        }
        for parameter in &layout.parameters {
            if !parameters[parameter.range.clone()]
                .iter()
                .all(|x| x.is_finite())
            {
                return Err(Error::Regressor {
                    array: parameter.name.clone(),
                    expected: "finite numbers".into(),
                    found: "NaN or infinity".into(),
                });
            }
        }
        let mut network = Self {
            weights: vec![0.0; parameters.len()],
            layout,
            parameters,
        };
        network.refresh();
        let weights = network.weights.iter().all(|weight| weight.is_finite());
        if weights && network.has_directions() {
            return Ok(network);
        }
        Err(Error::Regressor {
            array: "weight_v".into(),
            expected: "rows of a length above 0".into(),
            found: "a row of zeros, or of numbers too large to square".into(),
        })
    }

    /// Whether all rows of directions have a length that can be told.
    fn has_directions(&self) -> bool {
        let layers = self.layout.layers.iter();
        let mut normalised = layers.filter(|layer| layer.gain.is_some());
        normalised.all(|layer| {
            let mut rows = self.parameters[layer.weight.clone()].chunks_exact(layer.inputs);
            rows.all(|row| (f32::MIN_POSITIVE..f32::INFINITY).contains(&length(row)))
        })
    }

    /// The shape of the network.
    pub fn layout(&self) -> &NetworkLayout {
        &self.layout
    }

    /// All parameters, as the layout names them.
    pub fn parameters(&self) -> &[f32] {
        &self.parameters
    }

    pub(crate) fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// Lets `change` change the parameters.
    pub(crate) fn update(&mut self, change: impl FnOnce(&mut [f32])) {
        change(&mut self.parameters);
        self.refresh();
    }

    /// Computes the weights from the parameters.
    fn refresh(&mut self) {
        for layer in &self.layout.layers {
            let weights = &mut self.weights[layer.weight.clone()];
            let directions = &self.parameters[layer.weight.clone()];
            match &layer.gain {
                None => weights.copy_from_slice(directions),
                Some(gains) => weights
                    .par_chunks_mut(layer.inputs)
                    .zip(directions.par_chunks(layer.inputs))
                    .zip(&self.parameters[gains.clone()])
                    .with_min_len(64)
                    .for_each(|((weights, direction), gain)| {
                        let scale = gain / length(direction);
                        for (weight, v) in weights.iter_mut().zip(direction) {
                            *weight = v * scale;
                        }
                    }),
            }
        }
    }

    /// Evaluates `batch` inputs, `[inputs][batch]`.
    ///
    /// # Panics
    /// If `inputs` has another length.
    pub fn forward(&self, inputs: &[f32], batch: usize, activations: &mut Activations) {
        assert_eq!(inputs.len(), self.layout.input_count() * batch, "inputs");
        activations.batch = batch;
        let layers = &self.layout.layers;
        activations.values.resize_with(layers.len() + 1, Vec::new);
        activations.values[0].clear();
        activations.values[0].extend_from_slice(inputs);
        for (index, layer) in layers.iter().enumerate() {
            let (before, after) = activations.values.split_at_mut(index + 1);
            let (read, written) = (&before[index], &mut after[0]);
            written.resize(layer.outputs * batch, 0.0);
            written.truncate(layer.outputs * batch);
            let weights = &self.weights[layer.weight.clone()];
            multiply(
                Matrix::new(weights, layer.outputs, layer.inputs),
                Matrix::new(read, layer.inputs, batch),
                written,
            );
            let rectify = index + 1 < layers.len();
            let biases = &self.parameters[layer.bias.clone()];
            for (row, bias) in written.chunks_mut(batch.max(1)).zip(biases) {
                for value in row {
                    *value += bias;
                    if rectify {
                        *value = value.max(0.0);
                    }
                }
            }
            if self.layout.skip == Some(index + 1) {
                written.extend_from_slice(inputs);
            }
        }
    }
}

/// Euclidean length; sums in f64 lanes would cost more than they bring here.
pub(crate) fn length(row: &[f32]) -> f32 {
    dot(row, row).sqrt()
}
