//! The optimiser.

use std::collections::BTreeMap;

use burn::module::Module;
use burn::tensor::Tensor;
use serde::{Deserialize, Serialize};

use super::gradient::{NamedGradients, update};
use crate::Error;
use crate::fused::{self, AdamWStep};

/// Settings of [`AdamW`]; the default is PyTorch's but for the rate and the decay, which are MDM's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AdamWConfig {
    /// Learning rate.
    pub rate: f64,
    /// Decay of the mean of gradients.
    pub beta1: f64,
    /// Decay of the mean of their squares.
    pub beta2: f64,
    /// Added to the root of the squares.
    pub epsilon: f64,
    /// Share of itself, times the rate, that a parameter loses in a step.
    pub weight_decay: f64,
}

impl Default for AdamWConfig {
    fn default() -> Self {
        Self {
            rate: 1e-4,
            beta1: 0.9,
            beta2: 0.999,
            epsilon: 1e-8,
            weight_decay: 0.0,
        }
    }
}

impl AdamWConfig {
    pub(super) fn check(&self) -> Result<(), Error> {
        for (what, found) in [
            ("optimiser.rate", self.rate),
            ("optimiser.epsilon", self.epsilon),
            ("optimiser.weight_decay", self.weight_decay),
        ] {
            if !(found.is_finite() && found >= 0.0) {
                return Err(Error::setting(what, "a finite number from 0", found));
            }
        }
        for (what, found) in [
            ("optimiser.beta1", self.beta1),
            ("optimiser.beta2", self.beta2),
        ] {
            if !(0.0..1.0).contains(&found) {
                return Err(Error::setting(what, "at least 0 and below 1", found));
            }
        }
        Ok(())
    }
}

/// AdamW: Loshchilov and Hutter, "Decoupled Weight Decay Regularization", 2019, algorithm 2, with
/// PyTorch's order of operations.
#[derive(Clone, Debug)]
pub struct AdamW {
    config: AdamWConfig,
    pub(super) steps: u64,
    /// Mean of gradients and of their squares, by the parameter's path.
    pub(super) moments: BTreeMap<String, [Tensor<1>; 2]>,
}

impl AdamW {
    /// An optimiser that has not seen a gradient.
    pub const fn new(config: AdamWConfig) -> Self {
        Self {
            config,
            steps: 0,
            moments: BTreeMap::new(),
        }
    }

    /// The network after a step; `factor` is that of the learning rate.
    pub(super) fn step<M: Module>(
        &mut self,
        network: M,
        mut gradients: NamedGradients,
        factor: f64,
    ) -> M {
        self.steps += 1;
        let AdamWConfig {
            rate,
            beta1,
            beta2,
            epsilon,
            weight_decay,
        } = self.config;
        let rate = rate * factor;
        let bias = |beta: f64| 1.0 - beta.powf(self.steps as f64);
        let (first_bias, second_bias) = (bias(beta1), bias(beta2));
        let step = AdamWStep {
            beta1: beta1 as f32,
            beta2: beta2 as f32,
            second_bias: second_bias.sqrt() as f32,
            epsilon: epsilon as f32,
            rate: (rate / first_bias) as f32,
            kept: (1.0 - rate * weight_decay) as f32,
        };
        update(network, |path, parameter| {
            let Some(gradient) = gradients.0.remove(path) else {
                return parameter;
            };
            let [first, second] = self.moments.remove(path).unwrap_or_else(|| {
                let zeros = gradient.zeros_like();
                [zeros.clone(), zeros]
            });
            if fused::is_supported(&gradient.device()) {
                let (parameter, moments) = fused::adamw(parameter, gradient, [first, second], step);
                self.moments.insert(path.to_owned(), moments);
                return parameter;
            }
            let first = first.clone() + (gradient.clone() - first) * (1.0 - beta1);
            let second = second * beta2 + gradient.square() * (1.0 - beta2);
            let size = second.clone().sqrt() / second_bias.sqrt() + epsilon;
            let step = first.clone() / size * (rate / first_bias);
            self.moments.insert(path.to_owned(), [first, second]);
            parameter * (1.0 - rate * weight_decay) - step
        })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use burn::module::{Module, Param};
    use burn::tensor::{Device, Tensor};

    use super::{AdamW, AdamWConfig, NamedGradients};

    #[derive(Module, Debug)]
    struct Three {
        weight: Param<Tensor<1>>,
    }

    /// Against `torch.optim.AdamW` with these settings, parameters and gradients.
    #[test]
    fn takes_the_steps_of_pytorch() {
        let device = Device::flex();
        let tensor = |values: [f32; 3]| Tensor::<1>::from_data(values, &device);
        let mut network = Three {
            weight: Param::from_tensor(tensor([0.5, -1.0, 2.0])),
        };
        let mut optimiser = AdamW::new(AdamWConfig {
            rate: 0.01,
            beta2: 0.99,
            weight_decay: 0.1,
            ..AdamWConfig::default()
        });
        let steps = [
            (
                [0.1, -2.0, 0.0],
                [0.489_500_016, -0.989_000_022, 1.998_000_03],
            ),
            (
                [0.3, 1.0, -4.0],
                [0.479_849_249, -0.985_344_052, 2.003_426_79],
            ),
            (
                [-0.2, 0.5, 1e-4],
                [0.476_792_842, -0.983_742_833, 2.007_175_45],
            ),
        ];
        for (gradient, expected) in steps {
            let gradients = BTreeMap::from([("weight".to_owned(), tensor(gradient))]);
            network = optimiser.step(network, NamedGradients(gradients), 1.0);
            let found = network.weight.val().into_data().try_into_vec::<f32>();
            for (found, expected) in found.expect("floats").into_iter().zip(expected) {
                let close = (f64::from(found) - expected).abs() < 3e-7;
                assert!(close, "{found} {expected}");
            }
        }
    }
}
