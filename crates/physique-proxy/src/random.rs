//! Random numbers that are the same for ever, on every machine.

/// SplitMix64 (Steele, Lea and Flood, 2014): small, fast, and good enough to draw samples with.
#[derive(Clone, Debug)]
pub(crate) struct Random {
    state: u64,
}

const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

impl Random {
    /// A stream of its own for every path of numbers, such as `[seed, purpose, body]`.
    pub(crate) fn new(path: &[u64]) -> Self {
        let mut random = Self { state: 0 };
        for &number in path {
            random.state = random.next() ^ number.wrapping_mul(STEP);
        }
        random
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(STEP);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1_u32 << 24) as f32
    }

    /// In [-extent, extent).
    pub(crate) fn within(&mut self, extent: f32) -> f32 {
        (2.0 * self.unit() - 1.0) * extent
    }

    /// In 0..count; `count` is above 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        // Multiply and shift; the bias is below 2^-32 for any count in memory.
        ((u128::from(self.next()) * count as u128) >> 64) as usize
    }

    /// Two of the normal distribution (Box and Muller, 1958).
    pub(crate) fn normal_pair(&mut self) -> [f32; 2] {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        let (sine, cosine) = (std::f32::consts::TAU * self.unit()).sin_cos();
        [radius * cosine, radius * sine]
    }

    /// Puts the items in random order (Fisher and Yates, 1938).
    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Random;

    #[test]
    fn never_changes() {
        // Drawn once; fitted proxies depend on them.
        let mut random = Random::new(&[10, 1]);
        let drawn: Vec<u64> = (0..2).map(|_| random.next()).collect();
        assert_eq!(drawn, Random::new(&[10, 1]).drawn(2));
        assert_ne!(drawn, Random::new(&[10, 2]).drawn(2));
        assert_ne!(drawn, Random::new(&[1, 10]).drawn(2));
    }

    impl Random {
        fn drawn(&mut self, count: usize) -> Vec<u64> {
            (0..count).map(|_| self.next()).collect()
        }
    }

    #[test]
    fn follows_its_distributions() {
        let mut random = Random::new(&[3]);
        let count = 20_000;
        let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len() as f32;
        let uniform: Vec<f32> = (0..count).map(|_| random.within(3.0)).collect();
        let squares: Vec<f32> = uniform.iter().map(|x| x * x).collect();
        assert!(mean(&uniform).abs() < 0.05 && (mean(&squares) - 3.0).abs() < 0.05);
        let normal: Vec<f32> = (0..count).flat_map(|_| random.normal_pair()).collect();
        let squares: Vec<f32> = normal.iter().map(|x| x * x).collect();
        assert!(mean(&normal).abs() < 0.02 && (mean(&squares) - 1.0).abs() < 0.03);
        let mut items: Vec<usize> = (0..50).collect();
        random.shuffle(&mut items);
        assert!(items.windows(2).any(|pair| pair[0] > pair[1]));
        items.sort_unstable();
        assert!(items.into_iter().eq(0..50));
    }
}
