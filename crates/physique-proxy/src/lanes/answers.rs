//! Four rows of four answers.

/// A bit for each of four rows of four answers, four bits apart: bit `4 * (4 * row + column)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Answers(u64);

/// The lowest of each four bits.
const LOWEST: u64 = 0x1111_1111_1111_1111;

impl Answers {
    #[cfg_attr(not(target_arch = "x86_64"), allow(dead_code))] // Only AVX-512 gathers so.
    /// An answer is yes where any of its four bits is set.
    #[inline(always)]
    pub(crate) const fn of_four_bits(bits: u64) -> Self {
        let pairs = bits | bits >> 1;
        Self((pairs | pairs >> 2) & LOWEST)
    }

    /// From rows whose answers are four bits apart.
    #[inline(always)]
    pub(crate) const fn of_rows([a, b, c, d]: [u16; 4]) -> Self {
        Self(a as u64 | (b as u64) << 16 | (c as u64) << 32 | (d as u64) << 48)
    }

    /// Whether any answer is yes.
    #[inline(always)]
    pub(crate) const fn any(self) -> bool {
        self.0 != 0
    }

    /// Takes the first yes out: its `4 * row + column`.
    #[inline(always)]
    pub(crate) const fn pop(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let place = self.0.trailing_zeros() as usize / 4;
        self.0 &= self.0 - 1;
        Some(place)
    }
}

#[cfg(test)]
mod tests {
    use super::Answers;

    #[test]
    fn answers_come_out_in_their_order() {
        let mut answers = Answers::of_four_bits(0x8000_0000_0400_0016);
        let places: Vec<_> = std::iter::from_fn(|| answers.pop()).collect();
        assert_eq!(places, [0, 1, 6, 15]);
        assert!(!answers.any());
        assert_eq!(Answers::of_rows([0x1000, 0, 0x11, 1]), {
            Answers::of_four_bits(0x0002_00f4_0000_8000)
        });
    }
}
