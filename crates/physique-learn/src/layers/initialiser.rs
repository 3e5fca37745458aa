//! Parameters of new networks.

use burn::module::Param;
use burn::tensor::{Device, Tensor, TensorData};

use crate::random::Random;

/// Told apart from all other uses of a seed.
const PURPOSE: u64 = 0x0069_6E69_7469;

/// Makes parameters one after the other: the same ones for a seed, on every device.
#[derive(Debug)]
pub struct Initialiser {
    device: Device,
    random: Random,
}

impl Initialiser {
    /// Makes parameters on a device.
    pub fn new(seed: u64, device: &Device) -> Self {
        Self {
            device: device.clone(),
            random: Random::new(&[seed, PURPOSE]),
        }
    }

    /// All the same number.
    pub fn constant<const D: usize>(&self, shape: [usize; D], value: f32) -> Param<Tensor<D>> {
        self.parameter(vec![value; shape.iter().product()], shape)
    }

    /// Evenly between -bound and bound.
    pub fn uniform<const D: usize>(&mut self, shape: [usize; D], bound: f64) -> Param<Tensor<D>> {
        let count = shape.iter().product();
        let values = (0..count).map(|_| ((2.0 * self.random.unit() - 1.0) * bound) as f32);
        let values = values.collect();
        self.parameter(values, shape)
    }

    /// Of the normal distribution.
    pub fn normal<const D: usize>(
        &mut self,
        shape: [usize; D],
        deviation: f32,
    ) -> Param<Tensor<D>> {
        let mut values = vec![0.0; shape.iter().product()];
        self.random.fill_normal(&mut values);
        values.iter_mut().for_each(|value| *value *= deviation);
        self.parameter(values, shape)
    }

    fn parameter<const D: usize>(&self, values: Vec<f32>, shape: [usize; D]) -> Param<Tensor<D>> {
        Param::from_data(TensorData::new(values, shape), &self.device)
    }
}
