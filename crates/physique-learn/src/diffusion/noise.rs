//! The noise that a sample is made from.

use burn::tensor::{Device, Tensor, TensorData};

use crate::random::Random;

/// Told apart from all other uses of a seed.
const PURPOSE: u64 = 0x006E_6F69_7365;

/// A stream of noise for every sample of a batch.
///
/// A sample's noise depends on its own seed only: not on the batch, on threads, or on the device.
/// Where a motion gets longer, its first frames keep their noise.
#[derive(Clone, Debug)]
pub struct NoiseStreams {
    seeds: Vec<u64>,
    frames: usize,
    columns: usize,
    device: Device,
}

impl NoiseStreams {
    /// Noise for one motion a seed.
    pub fn new(seeds: &[u64], frames: usize, columns: usize, device: &Device) -> Self {
        Self {
            seeds: seeds.to_vec(),
            frames,
            columns,
            device: device.clone(),
        }
    }

    /// What sampling starts from.
    pub fn start(&self) -> Tensor<3> {
        self.draw(0)
    }

    /// What is added when a step is taken.
    pub fn at(&self, step: usize) -> Tensor<3> {
        self.draw(1 + step as u64)
    }

    fn draw(&self, moment: u64) -> Tensor<3> {
        let count = self.frames * self.columns;
        let mut values = vec![0.0; self.seeds.len() * count];
        for (&seed, values) in self.seeds.iter().zip(values.chunks_exact_mut(count.max(1))) {
            Random::new(&[seed, PURPOSE, moment]).fill_normal(values);
        }
        let shape = [self.seeds.len(), self.frames, self.columns];
        Tensor::from_data(TensorData::new(values, shape), &self.device)
    }
}
