//! Random numbers that are the same for ever, on every machine and any number of threads.

/// SplitMix64 (Steele, Lea and Flood, 2014): a stream of its own for every path of numbers.
///
/// What happens in a step of training or of sampling depends on its path only, such as
/// `[seed, purpose, step, sample]`: nothing has to be stored for a run to be continued, and a
/// sample is the same in a batch of any size.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

/// How the state moves on with every number.
pub(crate) const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

impl Random {
    /// The stream of a path.
    pub fn new(path: &[u64]) -> Self {
        let mut random = Self { state: 0 };
        for &number in path {
            random.state = random.bits() ^ number.wrapping_mul(STEP);
        }
        random
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(STEP);
        scramble(self.state)
    }

    /// The state that [`scramble`] makes the next number of, after one more [`STEP`].
    pub(crate) const fn state(&self) -> u64 {
        self.state
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// In 0..count; 0 for a count of 0.
    pub fn below(&mut self, count: usize) -> usize {
        // Multiply and shift; the bias is below 2^-32 for any count in memory.
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }

    /// Fills a slice from the normal distribution (Box and Muller, 1958).
    pub fn fill_normal(&mut self, values: &mut [f32]) {
        for pair in values.chunks_mut(2) {
            let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
            let (sine, cosine) = (std::f64::consts::TAU * self.unit()).sin_cos();
            for (value, part) in pair.iter_mut().zip([cosine, sine]) {
                *value = (radius * part) as f32;
            }
        }
    }

    /// Puts the items in random order (Fisher and Yates, 1938).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

/// The random number of a state.
#[inline(always)]
pub(crate) const fn scramble(state: u64) -> u64 {
    let mut z = state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::Random;

    #[test]
    fn streams_are_their_paths() {
        let drawn = |path: &[u64]| {
            let mut random = Random::new(path);
            [random.bits(), random.bits()]
        };
        assert_eq!(drawn(&[10, 1]), drawn(&[10, 1]));
        assert_ne!(drawn(&[10, 1]), drawn(&[1, 10]));
        assert_ne!(drawn(&[10, 1]), drawn(&[10, 2]));
        // Drawn once: samples of a seed must stay what they are.
        assert_eq!(Random::new(&[]).bits(), 0xE220_A839_7B1D_CDAF);
    }

    #[test]
    fn normal_numbers_are_normal() {
        let mut values = vec![0.0; 40_001];
        Random::new(&[3]).fill_normal(&mut values);
        let moment = |power: i32| {
            let powers = values.iter().map(|&value| f64::from(value).powi(power));
            powers.sum::<f64>() / values.len() as f64
        };
        // Five standard errors of each moment.
        assert!(moment(1).abs() < 0.025, "{}", moment(1));
        assert!((moment(2) - 1.0).abs() < 0.036, "{}", moment(2));
        assert!(moment(3).abs() < 0.1, "{}", moment(3));
        assert!((moment(4) - 3.0).abs() < 0.25, "{}", moment(4));
    }

    #[test]
    fn shuffled_items_are_all_there() {
        let mut items: Vec<usize> = (0..50).collect();
        Random::new(&[7]).shuffle(&mut items);
        assert!(items.windows(2).any(|pair| pair[0] > pair[1]));
        items.sort_unstable();
        assert!(items.into_iter().eq(0..50));
    }
}
