//! AVX-512F and BW: 16 lanes.

use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, Mul, Sub};

use super::{Answers, Kernel, Lanes, Simd};

/// Proof of AVX-512F and BW (and of AVX2 and FMA, which come with them).
#[derive(Clone, Copy)]
pub(crate) struct Avx512(());

impl Avx512 {
    pub(crate) fn detect() -> Option<Self> {
        let found = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma");
        found.then_some(Self(()))
    }
}

/// Exists only where an [`Avx512`] made it.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct F32x16(__m512);

/// Lanes are set where negative: signs are combined by plain logic, of which a processor does more at
/// once than of comparisons into mask registers.
#[derive(Clone, Copy)]
pub(crate) struct Signs(__m512i);

impl Simd for Avx512 {
    type Lanes = F32x16;

    const COUNT: usize = 16;

    #[inline(always)]
    fn splat(self, number: f32) -> F32x16 {
        // SAFETY: `self` proves AVX-512.
        F32x16(unsafe { _mm512_set1_ps(number) })
    }

    #[inline(always)]
    fn load(self, lanes: &[f32]) -> F32x16 {
        let lanes: &[f32] = &lanes[..Self::COUNT];
        // SAFETY: `self` proves AVX-512, and there are 16 numbers.
        F32x16(unsafe { _mm512_loadu_ps(lanes.as_ptr()) })
    }

    #[inline(always)]
    fn run<K: Kernel<Self>>(self, kernel: K) -> K::Output {
        #[target_feature(enable = "avx512f,avx512bw,avx2,fma")]
        fn compiled<K: Kernel<Avx512>>(simd: Avx512, kernel: K) -> K::Output {
            kernel.run(simd)
        }
        // SAFETY: `self` proves the features.
        unsafe { compiled(self, kernel) }
    }
}

impl Lanes for F32x16 {
    type Mask = Signs;

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: lanes prove AVX-512F and BW; so in all functions below.
        Self(unsafe { _mm512_fmadd_ps(self.0, factor.0, term.0) })
    }

    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_fnmadd_ps(self.0, factor.0, term.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn inverse_sqrt(self) -> Self {
        // SAFETY: as above. 14 bits, and one step of Newton's method: y (3/2 - x y^2 / 2).
        Self(unsafe {
            let y = _mm512_rsqrt14_ps(self.0);
            let half_xy = _mm512_mul_ps(_mm512_mul_ps(self.0, _mm512_set1_ps(0.5)), y);
            _mm512_mul_ps(y, _mm512_fnmadd_ps(half_xy, y, _mm512_set1_ps(1.5)))
        })
    }

    #[inline(always)]
    fn where_positive(self, condition: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe {
            let positive = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(condition.0, _mm512_setzero_ps());
            _mm512_maskz_mov_ps(positive, self.0)
        })
    }

    #[inline(always)]
    fn below(self, other: Self) -> Signs {
        // SAFETY: as above.
        Signs(unsafe { _mm512_castps_si512(_mm512_sub_ps(self.0, other.0)) })
    }

    #[inline(always)]
    fn any(mask: Signs) -> bool {
        // SAFETY: as above.
        unsafe { _mm512_cmplt_epi32_mask(mask.0, _mm512_setzero_si512()) != 0 }
    }

    type Row = Signs;

    #[inline(always)]
    fn any_negative([a, b, c, d]: [Self; 4]) -> Signs {
        // SAFETY: as above. Packing keeps signs: bytes of four `a`, four `b` and so on, in each quarter.
        Signs(unsafe {
            let ab = _mm512_packs_epi32(_mm512_castps_si512(a.0), _mm512_castps_si512(b.0));
            let cd = _mm512_packs_epi32(_mm512_castps_si512(c.0), _mm512_castps_si512(d.0));
            _mm512_packs_epi16(ab, cd)
        })
    }

    #[inline(always)]
    fn gather([a, b, c, d]: [Signs; 4]) -> Answers {
        // SAFETY: as above. Quarters are united until each row has one.
        let bits = unsafe {
            let ab = _mm512_or_si512(
                _mm512_shuffle_i64x2::<0x44>(a.0, b.0),
                _mm512_shuffle_i64x2::<0xee>(a.0, b.0),
            );
            let cd = _mm512_or_si512(
                _mm512_shuffle_i64x2::<0x44>(c.0, d.0),
                _mm512_shuffle_i64x2::<0xee>(c.0, d.0),
            );
            let all = _mm512_or_si512(
                _mm512_shuffle_i64x2::<0x88>(ab, cd),
                _mm512_shuffle_i64x2::<0xdd>(ab, cd),
            );
            _mm512_movepi8_mask(all)
        };
        Answers::of_four_bits(bits)
    }

    #[inline(always)]
    fn zip(self, other: Self) -> (Self, Self) {
        // SAFETY: as above.
        unsafe {
            let low = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
            let high = _mm512_add_epi32(low, _mm512_set1_epi32(8));
            (
                Self(_mm512_permutex2var_ps(self.0, low, other.0)),
                Self(_mm512_permutex2var_ps(self.0, high, other.0)),
            )
        }
    }

    #[inline(always)]
    fn store(self, lanes: &mut [f32]) {
        let lanes = &mut lanes[..Avx512::COUNT];
        // SAFETY: as above, and there is room for 16 numbers.
        unsafe { _mm512_storeu_ps(lanes.as_mut_ptr(), self.0) }
    }
}

impl BitAnd for Signs {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_and_si512(self.0, other.0) })
    }
}

impl Add for F32x16 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_add_ps(self.0, other.0) })
    }
}

impl Sub for F32x16 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_sub_ps(self.0, other.0) })
    }
}

impl Mul for F32x16 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_mul_ps(self.0, other.0) })
    }
}
