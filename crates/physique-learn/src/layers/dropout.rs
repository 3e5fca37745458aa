//! Dropout whose masks depend on nothing but a seed and their place.

use std::cell::Cell;

use burn::tensor::activation::gelu;
use burn::tensor::{Tensor, TensorData};

use crate::fused::{self, DropMask};
use crate::random::Random;

/// Told apart from all other uses of a seed.
const PURPOSE: u64 = 0x0064_726F_7069;

/// What a forward pass drops: nothing when a network is used, a share of the activations while it
/// is trained.
///
/// The masks of a pass are drawn one after the other from streams of their own, by 16 bits a
/// number, on the processor: a run can be continued from its step alone, and is the same on every
/// device and any number of threads.
#[derive(Debug)]
pub struct Dropout {
    /// Numbers out of 65,536 that are dropped.
    dropped: u16,
    seed: u64,
    step: u64,
    drawn: Cell<u64>,
}

impl Dropout {
    /// Nothing is dropped.
    pub const fn none() -> Self {
        Self {
            dropped: 0,
            seed: 0,
            step: 0,
            drawn: Cell::new(0),
        }
    }

    /// A `share` in [0, 1) of the numbers becomes 0 and the rest grows, so that means stay; rounded
    /// to a 65,536th.
    pub fn training(share: f64, seed: u64, step: u64) -> Self {
        Self {
            dropped: (share.clamp(0.0, 1.0) * 65_536.0) as u16,
            seed,
            step,
            drawn: Cell::new(0),
        }
    }

    /// The same for a part of a batch that begins with this motion: other masks for other parts.
    #[must_use]
    pub const fn of_part(mut self, first: u64) -> Self {
        self.drawn = Cell::new(first << 32);
        self
    }

    /// Drops numbers of a tensor.
    pub fn apply<const D: usize>(&self, values: Tensor<D>) -> Tensor<D> {
        if self.dropped == 0 {
            return values;
        }
        let random = self.draw();
        if fused::is_supported(&values.device()) {
            return fused::dropped(values, DropMask::new(self.dropped, &random));
        }
        self.multiply(values, random)
    }

    /// `values + dropout(other)`.
    pub(super) fn add<const D: usize>(&self, values: Tensor<D>, other: Tensor<D>) -> Tensor<D> {
        if self.dropped == 0 || !fused::is_supported(&values.device()) {
            return values + self.apply(other);
        }
        fused::add_dropped(values, other, DropMask::new(self.dropped, &self.draw()))
    }

    /// `dropout(GELU(values))`, the exact GELU.
    pub(super) fn gelu<const D: usize>(&self, values: Tensor<D>) -> Tensor<D> {
        if !fused::is_supported(&values.device()) {
            return self.apply(gelu(values));
        }
        fused::dropped_gelu(values, self.mask())
    }

    /// The next mask, where anything is dropped.
    pub(super) fn mask(&self) -> Option<DropMask> {
        let draw = || DropMask::new(self.dropped, &self.draw());
        (self.dropped > 0).then(draw)
    }

    /// The stream of the next mask.
    fn draw(&self) -> Random {
        let call = self.drawn.replace(self.drawn.get() + 1);
        Random::new(&[self.seed, PURPOSE, self.step, call])
    }

    /// The same by elementary operations, for any device.
    fn multiply<const D: usize>(&self, values: Tensor<D>, random: Random) -> Tensor<D> {
        let shape = values.dims();
        let factors = self.factors(shape.iter().product(), random);
        let factors = Tensor::<D>::from_data(TensorData::new(factors, shape), &values.device());
        values * factors
    }

    /// Factors: 0, or what keeps the mean.
    fn factors(&self, count: usize, mut random: Random) -> Vec<f32> {
        let kept = 65_536.0 / (65_536.0 - f32::from(self.dropped));
        let mut mask = Vec::with_capacity(count.next_multiple_of(4));
        while mask.len() < count {
            let bits = random.bits();
            mask.extend([0, 16, 32, 48].map(|shift| {
                let drawn = (bits >> shift) as u16;
                if drawn < self.dropped { 0.0 } else { kept }
            }));
        }
        mask.truncate(count);
        mask
    }
}

#[cfg(test)]
mod tests {
    use burn::tensor::{Device, Tensor};

    use super::Dropout;

    fn factors(dropout: &Dropout, count: usize) -> Vec<f32> {
        dropout.factors(count, dropout.draw())
    }

    #[test]
    fn drops_its_share_and_keeps_the_mean() {
        let dropout = Dropout::training(0.1, 5, 0);
        let mask = factors(&dropout, 100_001);
        let dropped = mask.iter().filter(|&&factor| factor == 0.0).count() as f64;
        let mean = mask.iter().map(|&factor| f64::from(factor)).sum::<f64>() / 100_001.0;
        // Five standard deviations.
        assert!((dropped / 100_001.0 - 0.1).abs() < 0.005, "{dropped}");
        assert!((mean - 1.0).abs() < 0.006, "{mean}");
    }

    #[test]
    fn masks_depend_on_seed_step_and_call() {
        let first = |seed, step| factors(&Dropout::training(0.5, seed, step), 64);
        assert_eq!(first(1, 2), first(1, 2));
        assert_ne!(first(1, 2), first(1, 3));
        assert_ne!(first(1, 2), first(2, 2));
        let dropout = Dropout::training(0.5, 1, 2);
        assert_ne!(factors(&dropout, 64), factors(&dropout, 64));
    }

    /// Whatever the device, the same numbers are dropped: more than a thread takes at once, and no
    /// whole number of draws.
    #[test]
    fn fused_masks_are_the_same() {
        const COUNT: usize = (1 << 14) + 4 * 33 + 3;
        let ones = Tensor::<1>::ones([COUNT], &Device::flex());
        let found = Dropout::training(0.3, 7, 1).apply(ones);
        let found = found.into_data().try_into_vec::<f32>().expect("floats");
        assert_eq!(found, factors(&Dropout::training(0.3, 7, 1), COUNT));
    }
}
