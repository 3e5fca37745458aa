//! Sixteen `f32` numbers at once: written once, run with the vectors that the machine has.

use super::leaf::{LANES, Lanes};

/// Sixteen numbers, and masks with a bit for each. All implementations round alike.
pub(super) trait Vector: Copy {
    fn load(lanes: &Lanes) -> Self;
    fn splat(value: f32) -> Self;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn abs(self) -> Self;
    /// Where `self > other`.
    fn greater(self, other: Self) -> u32;
    /// Where a number equals `value`.
    fn equal(lanes: &[u32; LANES], value: u32) -> u32;
}

/// For any machine; the compiler finds vectors for it where it can.
#[derive(Debug, Clone, Copy)]
pub(super) struct Portable(Lanes);

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, operation: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|lane| {
            operation(self.0[lane], other.0[lane])
        }))
    }
}

impl Vector for Portable {
    #[inline(always)]
    fn load(lanes: &Lanes) -> Self {
        Self(*lanes)
    }

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }

    #[inline(always)]
    fn greater(self, other: Self) -> u32 {
        (0..LANES).fold(0, |mask, lane| {
            mask | u32::from(self.0[lane] > other.0[lane]) << lane
        })
    }

    #[inline(always)]
    fn equal(lanes: &[u32; LANES], value: u32) -> u32 {
        (0..LANES).fold(0, |mask, lane| {
            mask | u32::from(lanes[lane] == value) << lane
        })
    }
}

/// For x86-64 with AVX-512. Only functions that have the feature enabled may use it.
#[cfg(target_arch = "x86_64")]
pub(super) mod avx512 {
    use std::arch::x86_64::*;

    use super::{LANES, Lanes, Vector};

    #[derive(Debug, Clone, Copy)]
    pub(in crate::triangle_pairs) struct Avx512(__m512);

    // SAFETY of all blocks: the feature is there, as the type demands of its users; the loads read
    // the 16 numbers of the array.
    #[expect(
        clippy::undocumented_unsafe_blocks,
        reason = "one reason for all, above"
    )]
    impl Vector for Avx512 {
        #[inline(always)]
        fn load(lanes: &Lanes) -> Self {
            Self(unsafe { _mm512_loadu_ps(lanes.as_ptr()) })
        }

        #[inline(always)]
        fn splat(value: f32) -> Self {
            Self(unsafe { _mm512_set1_ps(value) })
        }

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Self(unsafe { _mm512_add_ps(self.0, other.0) })
        }

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Self(unsafe { _mm512_sub_ps(self.0, other.0) })
        }

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Self(unsafe { _mm512_mul_ps(self.0, other.0) })
        }

        #[inline(always)]
        fn abs(self) -> Self {
            Self(unsafe { _mm512_abs_ps(self.0) })
        }

        #[inline(always)]
        fn greater(self, other: Self) -> u32 {
            unsafe { _mm512_cmp_ps_mask::<_CMP_GT_OQ>(self.0, other.0) }.into()
        }

        #[inline(always)]
        fn equal(lanes: &[u32; LANES], value: u32) -> u32 {
            unsafe {
                let lanes = _mm512_loadu_epi32(lanes.as_ptr().cast());
                _mm512_cmpeq_epi32_mask(lanes, _mm512_set1_epi32(value.cast_signed()))
            }
            .into()
        }
    }
}
