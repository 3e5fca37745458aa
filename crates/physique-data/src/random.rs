//! Random numbers that are a pure function of a seed and a few counters.

/// SplitMix64 (Steele, Lea and Flood, 2014).
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    /// A stream of its own for each list of counters.
    pub(crate) fn new(seed: u64, counters: &[u64]) -> Self {
        let mut random = Self(seed);
        for &counter in counters {
            let state = random.next();
            random = Self(state ^ counter.wrapping_mul(0xd6e8_feb8_6659_fd93));
        }
        random
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut value = self.0;
        value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        value ^ (value >> 31)
    }

    /// Uniform in `0..limit`; 0 for a limit of 0. The bias of the product is below 2^-40 for limits
    /// below 2^24.
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        ((u128::from(self.next()) * limit as u128) >> 64) as usize
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Index of a weight, in proportion to the weights, of which `cumulative` holds running sums.
    pub(crate) fn weighted(&mut self, cumulative: &[f64]) -> usize {
        let total = cumulative.last().copied().unwrap_or(0.0);
        let at = self.unit() * total;
        let index = cumulative.partition_point(|&sum| sum <= at);
        index.min(cumulative.len().saturating_sub(1))
    }

    /// Fisher and Yates.
    pub(crate) fn shuffle(&mut self, items: &mut [usize]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

/// A number for a name that is the same on every machine (FNV-1a, then mixed).
pub(crate) fn hash(seed: u64, name: &str) -> u64 {
    let mut value = 0xcbf2_9ce4_8422_2325_u64;
    for byte in name.bytes() {
        value = (value ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    Random::new(seed, &[value]).next()
}
