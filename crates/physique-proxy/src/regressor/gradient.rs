//! The way back through a network.

use rayon::prelude::*;

use super::matrix::{Matrix, dot, multiply};
use super::network::{Activations, Layer, Network, length};

/// Gradient of a loss with respect to all parameters and inputs of a network. Reuse it.
#[derive(Clone, Debug, Default)]
pub struct Gradient {
    /// As the network's parameters.
    pub parameters: Vec<f32>,
    /// `[inputs][batch]`.
    pub inputs: Vec<f32>,
    weights: Vec<f32>,
    outputs: Vec<f32>,
    next: Vec<f32>,
}

impl Network {
    /// Back-propagates the loss's gradient by outputs, `[outputs][batch]`, from the activations
    /// that [`Network::forward`] left. The gradient is overwritten.
    ///
    /// # Panics
    /// If `outputs` or the activations belong to another network or batch.
    pub fn backward(&self, activations: &Activations, outputs: &[f32], gradient: &mut Gradient) {
        self.back(activations, outputs, gradient, true);
    }

    /// As [`Network::backward`] for the inputs alone, at half the cost; the gradient of the
    /// parameters is left as it was.
    ///
    /// # Panics
    /// As [`Network::backward`].
    pub fn backward_inputs(
        &self,
        activations: &Activations,
        outputs: &[f32],
        gradient: &mut Gradient,
    ) {
        self.back(activations, outputs, gradient, false);
    }

    fn back(
        &self,
        activations: &Activations,
        outputs: &[f32],
        gradient: &mut Gradient,
        parameters: bool,
    ) {
        let layout = self.layout();
        let batch = activations.batch;
        assert_eq!(outputs.len(), layout.output_count() * batch, "outputs");
        gradient.inputs.clear();
        gradient.inputs.resize(layout.input_count() * batch, 0.0);
        gradient.outputs.clear();
        gradient.outputs.extend_from_slice(outputs);
        if parameters {
            gradient.parameters.resize(layout.parameter_count(), 0.0);
        }
        for (index, layer) in layout.layers().iter().enumerate().rev() {
            let read = &activations.values[index];
            if parameters {
                self.layer_parameters(layer, read, batch, gradient);
            }
            gradient.next.resize(layer.inputs * batch, 0.0);
            gradient.next.truncate(layer.inputs * batch);
            let weights = &self.weights()[layer.weight.clone()];
            multiply(
                Matrix::new(weights, layer.outputs, layer.inputs).transposed(),
                Matrix::new(&gradient.outputs, layer.outputs, batch),
                &mut gradient.next,
            );
            if layout.skip_layer() == Some(index) || index == 0 {
                let start = gradient.next.len() - gradient.inputs.len();
                for (sum, part) in gradient.inputs.iter_mut().zip(&gradient.next[start..]) {
                    *sum += part;
                }
                gradient.next.truncate(start);
            }
            // Rectifiers pass what they let through.
            for (slope, value) in gradient.next.iter_mut().zip(read) {
                *slope = if *value > 0.0 { *slope } else { 0.0 };
            }
            std::mem::swap(&mut gradient.outputs, &mut gradient.next);
        }
    }

    fn layer_parameters(&self, layer: &Layer, read: &[f32], batch: usize, gradient: &mut Gradient) {
        let Gradient {
            parameters,
            outputs,
            weights,
            ..
        } = gradient;
        for (sum, row) in parameters[layer.bias.clone()]
            .iter_mut()
            .zip(outputs.chunks(batch.max(1)))
        {
            *sum = row.iter().sum();
        }
        let outputs = Matrix::new(outputs, layer.outputs, batch);
        let read = Matrix::new(read, layer.inputs, batch).transposed();
        let Some(gains) = &layer.gain else {
            multiply(outputs, read, &mut parameters[layer.weight.clone()]);
            return;
        };
        weights.resize(layer.outputs * layer.inputs, 0.0);
        weights.truncate(layer.outputs * layer.inputs);
        multiply(outputs, read, weights);

        // W = g v / |v|: along v the gradient goes to g, across it to v.
        let (low, high) = parameters.split_at_mut(gains.start);
        let slopes = &mut low[layer.weight.clone()];
        let gain_slopes = &mut high[..layer.outputs];
        slopes
            .par_chunks_mut(layer.inputs)
            .zip(gain_slopes)
            .zip(weights.par_chunks(layer.inputs))
            .zip(self.parameters()[layer.weight.clone()].par_chunks(layer.inputs))
            .zip(&self.parameters()[gains.clone()])
            .with_min_len(64)
            .for_each(|((((slopes, gain_slope), weights), direction), gain)| {
                let inverse = length(direction).recip();
                let along = dot(weights, direction) * inverse;
                *gain_slope = along;
                let (scale, along) = (gain * inverse, along * inverse);
                for ((slope, weight), v) in slopes.iter_mut().zip(weights).zip(direction) {
                    *slope = scale * (weight - along * v);
                }
            });
    }
}
