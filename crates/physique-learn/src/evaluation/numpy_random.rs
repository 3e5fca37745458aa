//! The random numbers that published results were drawn with.

/// NumPy's `RandomState`: the Mersenne twister of Matsumoto and Nishimura, 1998, and NumPy's way
/// to choose with it, so that a published seed draws the published samples.
#[derive(Clone, Debug)]
pub struct NumpyRandom {
    state: Vec<u32>,
    next: usize,
}

const WORDS: usize = 624;
const SHIFT: usize = 397;

impl NumpyRandom {
    /// `numpy.random.RandomState(seed)`.
    pub fn new(seed: u32) -> Self {
        let words = std::iter::successors(Some((0_u32, seed)), |&(index, word)| {
            let mixed = 1_812_433_253_u32.wrapping_mul(word ^ (word >> 30));
            Some((index + 1, mixed.wrapping_add(index + 1)))
        });
        Self {
            state: words.take(WORDS).map(|(_, word)| word).collect(),
            next: WORDS,
        }
    }

    /// `choice(count, chosen, replace=False)`: the first of all in random order.
    pub fn choice(&mut self, count: usize, chosen: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            order.swap(last, self.up_to(last));
        }
        order.truncate(chosen);
        order
    }

    /// In 0..=most: masks, and draws again what is above.
    fn up_to(&mut self, most: usize) -> usize {
        let mask = u32::MAX >> (most as u32).leading_zeros();
        loop {
            let drawn = (self.bits() & mask) as usize;
            if drawn <= most {
                return drawn;
            }
        }
    }

    fn bits(&mut self) -> u32 {
        if self.next == WORDS {
            self.twist();
        }
        let mut word = self.state[self.next];
        self.next += 1;
        word ^= word >> 11;
        word ^= (word << 7) & 0x9D2C_5680;
        word ^= (word << 15) & 0xEFC6_0000;
        word ^ (word >> 18)
    }

    fn twist(&mut self) {
        for index in 0..WORDS {
            let upper = self.state[index] & 0x8000_0000;
            let word = upper | (self.state[(index + 1) % WORDS] & 0x7FFF_FFFF);
            let twisted = (word >> 1) ^ if word & 1 == 1 { 0x9908_B0DF } else { 0 };
            self.state[index] = self.state[(index + SHIFT) % WORDS] ^ twisted;
        }
        self.next = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::NumpyRandom;

    #[test]
    fn draws_as_the_mersenne_twister_does() {
        // The standard's own check: the 10,000th number of the default seed is 4123659995.
        let mut random = NumpyRandom::new(5489);
        let drawn = (0..10_000).map(|_| random.bits()).last();
        assert_eq!(drawn, Some(4_123_659_995));
    }

    #[test]
    fn chooses_as_numpy_does() {
        // numpy.random.RandomState(0).choice(10, 10, replace=False)
        let mut random = NumpyRandom::new(0);
        assert_eq!(random.choice(10, 10), [2, 8, 4, 9, 1, 6, 7, 3, 0, 5]);
    }
}
