//! AVX2 and FMA: 8 lanes.

use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, Mul, Sub};

use super::{Answers, Kernel, Lanes, Simd};

/// Proof of AVX2 and FMA.
#[derive(Clone, Copy)]
pub(crate) struct Avx2(());

impl Avx2 {
    pub(crate) fn detect() -> Option<Self> {
        let found = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
        found.then_some(Self(()))
    }
}

/// Exists only where an [`Avx2`] made it.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct F32x8(__m256);

/// All bits of a lane set, or none.
#[derive(Clone, Copy)]
pub(crate) struct Mask8(__m256);

impl Simd for Avx2 {
    type Lanes = F32x8;

    const COUNT: usize = 8;

    #[inline(always)]
    fn splat(self, number: f32) -> F32x8 {
        // SAFETY: `self` proves AVX2 and FMA.
        F32x8(unsafe { _mm256_set1_ps(number) })
    }

    #[inline(always)]
    fn load(self, lanes: &[f32]) -> F32x8 {
        let lanes: &[f32] = &lanes[..Self::COUNT];
        // SAFETY: `self` proves AVX2 and FMA, and there are 8 numbers.
        F32x8(unsafe { _mm256_loadu_ps(lanes.as_ptr()) })
    }

    #[inline(always)]
    fn run<K: Kernel<Self>>(self, kernel: K) -> K::Output {
        #[target_feature(enable = "avx2,fma")]
        fn compiled<K: Kernel<Avx2>>(simd: Avx2, kernel: K) -> K::Output {
            kernel.run(simd)
        }
        // SAFETY: `self` proves the features.
        unsafe { compiled(self, kernel) }
    }
}

impl Lanes for F32x8 {
    type Mask = Mask8;

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: lanes prove AVX2 and FMA; so in all functions below.
        Self(unsafe { _mm256_fmadd_ps(self.0, factor.0, term.0) })
    }

    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_fnmadd_ps(self.0, factor.0, term.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn inverse_sqrt(self) -> Self {
        // SAFETY: as above. 12 bits, and one step of Newton's method: y (3/2 - x y^2 / 2).
        Self(unsafe {
            let y = _mm256_rsqrt_ps(self.0);
            let half_xy = _mm256_mul_ps(_mm256_mul_ps(self.0, _mm256_set1_ps(0.5)), y);
            _mm256_mul_ps(y, _mm256_fnmadd_ps(half_xy, y, _mm256_set1_ps(1.5)))
        })
    }

    #[inline(always)]
    fn where_positive(self, condition: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe {
            let positive = _mm256_cmp_ps::<_CMP_GT_OQ>(condition.0, _mm256_setzero_ps());
            _mm256_and_ps(positive, self.0)
        })
    }

    #[inline(always)]
    fn below(self, other: Self) -> Mask8 {
        // SAFETY: as above.
        Mask8(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn any(mask: Mask8) -> bool {
        // SAFETY: as above.
        unsafe { _mm256_movemask_ps(mask.0) != 0 }
    }

    type Row = u16;

    #[inline(always)]
    fn any_negative([a, b, c, d]: [Self; 4]) -> u16 {
        // SAFETY: as above.
        let [a, b, c, d] = unsafe {
            [
                _mm256_movemask_ps(a.0),
                _mm256_movemask_ps(b.0),
                _mm256_movemask_ps(c.0),
                _mm256_movemask_ps(d.0),
            ]
        };
        u16::from(a != 0)
            | u16::from(b != 0) << 4
            | u16::from(c != 0) << 8
            | u16::from(d != 0) << 12
    }

    #[inline(always)]
    fn gather(rows: [u16; 4]) -> Answers {
        Answers::of_rows(rows)
    }

    #[inline(always)]
    fn zip(self, other: Self) -> (Self, Self) {
        // SAFETY: as above.
        unsafe {
            let low = _mm256_unpacklo_ps(self.0, other.0);
            let high = _mm256_unpackhi_ps(self.0, other.0);
            (
                Self(_mm256_permute2f128_ps::<0x20>(low, high)),
                Self(_mm256_permute2f128_ps::<0x31>(low, high)),
            )
        }
    }

    #[inline(always)]
    fn store(self, lanes: &mut [f32]) {
        let lanes = &mut lanes[..Avx2::COUNT];
        // SAFETY: as above, and there is room for 8 numbers.
        unsafe { _mm256_storeu_ps(lanes.as_mut_ptr(), self.0) }
    }
}

impl BitAnd for Mask8 {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_and_ps(self.0, other.0) })
    }
}

impl Add for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_add_ps(self.0, other.0) })
    }
}

impl Sub for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_sub_ps(self.0, other.0) })
    }
}

impl Mul for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_mul_ps(self.0, other.0) })
    }
}
