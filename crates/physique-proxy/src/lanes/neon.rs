//! NEON: 4 lanes.

use std::arch::aarch64::*;
use std::ops::{Add, BitAnd, Mul, Sub};

use super::{Answers, Kernel, Lanes, Simd};

/// Proof of NEON, which nearly every 64-bit Arm has.
#[derive(Clone, Copy)]
pub(crate) struct Neon(());

impl Neon {
    pub(crate) fn detect() -> Option<Self> {
        std::arch::is_aarch64_feature_detected!("neon").then_some(Self(()))
    }
}

/// Exists only where a [`Neon`] made it.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct F32x4(float32x4_t);

/// All bits of a lane set, or none.
#[derive(Clone, Copy)]
pub(crate) struct Mask4(uint32x4_t);

impl Simd for Neon {
    type Lanes = F32x4;

    const COUNT: usize = 4;

    #[inline(always)]
    fn splat(self, number: f32) -> F32x4 {
        // SAFETY: `self` proves NEON.
        F32x4(unsafe { vdupq_n_f32(number) })
    }

    #[inline(always)]
    fn load(self, lanes: &[f32]) -> F32x4 {
        let lanes: &[f32] = &lanes[..Self::COUNT];
        // SAFETY: `self` proves NEON, and there are 4 numbers.
        F32x4(unsafe { vld1q_f32(lanes.as_ptr()) })
    }

    #[inline(always)]
    fn run<K: Kernel<Self>>(self, kernel: K) -> K::Output {
        #[target_feature(enable = "neon")]
        fn compiled<K: Kernel<Neon>>(simd: Neon, kernel: K) -> K::Output {
            kernel.run(simd)
        }
        // SAFETY: `self` proves the feature.
        unsafe { compiled(self, kernel) }
    }
}

impl Lanes for F32x4 {
    type Mask = Mask4;

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: lanes prove NEON; so in all functions below.
        Self(unsafe { vfmaq_f32(term.0, self.0, factor.0) })
    }

    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { vfmsq_f32(term.0, self.0, factor.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { vminq_f32(self.0, other.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above. The maximum of numbers is a number where one is NaN.
        Self(unsafe { vmaxnmq_f32(self.0, other.0) })
    }

    #[inline(always)]
    fn inverse_sqrt(self) -> Self {
        // SAFETY: as above. 8 bits, and two steps of Newton's method: y (3 - x y^2) / 2.
        Self(unsafe {
            let mut y = vrsqrteq_f32(self.0);
            y = vmulq_f32(y, vrsqrtsq_f32(vmulq_f32(self.0, y), y));
            vmulq_f32(y, vrsqrtsq_f32(vmulq_f32(self.0, y), y))
        })
    }

    #[inline(always)]
    fn where_positive(self, condition: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe {
            let positive = vcgtzq_f32(condition.0);
            vreinterpretq_f32_u32(vandq_u32(positive, vreinterpretq_u32_f32(self.0)))
        })
    }

    #[inline(always)]
    fn below(self, other: Self) -> Mask4 {
        // SAFETY: as above.
        Mask4(unsafe { vcltq_f32(self.0, other.0) })
    }

    #[inline(always)]
    fn any(mask: Mask4) -> bool {
        // SAFETY: as above.
        unsafe { vmaxvq_u32(mask.0) != 0 }
    }

    type Row = u16;

    #[inline(always)]
    fn any_negative([a, b, c, d]: [Self; 4]) -> u16 {
        // SAFETY: as above. The least number as a signed integer has the sign that counts.
        let negative = |lanes: Self| unsafe { vminvq_s32(vreinterpretq_s32_f32(lanes.0)) < 0 };
        u16::from(negative(a))
            | u16::from(negative(b)) << 4
            | u16::from(negative(c)) << 8
            | u16::from(negative(d)) << 12
    }

    #[inline(always)]
    fn gather(rows: [u16; 4]) -> Answers {
        Answers::of_rows(rows)
    }

    #[inline(always)]
    fn zip(self, other: Self) -> (Self, Self) {
        // SAFETY: as above.
        unsafe {
            (
                Self(vzip1q_f32(self.0, other.0)),
                Self(vzip2q_f32(self.0, other.0)),
            )
        }
    }

    #[inline(always)]
    fn store(self, lanes: &mut [f32]) {
        let lanes = &mut lanes[..Neon::COUNT];
        // SAFETY: as above, and there is room for 4 numbers.
        unsafe { vst1q_f32(lanes.as_mut_ptr(), self.0) }
    }
}

impl BitAnd for Mask4 {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { vandq_u32(self.0, other.0) })
    }
}

impl Add for F32x4 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { vaddq_f32(self.0, other.0) })
    }
}

impl Sub for F32x4 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { vsubq_f32(self.0, other.0) })
    }
}

impl Mul for F32x4 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { vmulq_f32(self.0, other.0) })
    }
}
