//! Plain Rust: 4 lanes in an array, which compilers turn into whatever the target always has.

use std::array::from_fn;
use std::ops::{Add, BitAnd, Mul, Sub};

use super::{Kernel, Lanes, Simd};

/// Needs no proof.
#[derive(Clone, Copy)]
pub(crate) struct Portable;

const COUNT: usize = 4;

/// Aligned, so that it fits a register.
#[derive(Clone, Copy)]
#[repr(align(16))]
pub(crate) struct Array(pub(crate) [f32; COUNT]);

#[derive(Clone, Copy)]
pub(crate) struct ArrayMask([bool; COUNT]);

impl Simd for Portable {
    type Lanes = Array;

    const COUNT: usize = COUNT;

    #[inline(always)]
    fn splat(self, number: f32) -> Array {
        Array([number; COUNT])
    }

    #[inline(always)]
    fn load(self, lanes: &[f32]) -> Array {
        let mut array = [0.0; COUNT];
        array.copy_from_slice(&lanes[..COUNT]);
        Array(array)
    }

    #[inline(always)]
    fn run<K: Kernel<Self>>(self, kernel: K) -> K::Output {
        kernel.run(self)
    }
}

impl Lanes for Array {
    type Mask = ArrayMask;

    // Not fused: without the instruction, a fused product is a call of a slow function.
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        self * factor + term
    }

    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        term - self * factor
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(from_fn(|lane| {
            if self.0[lane] < other.0[lane] {
                self.0[lane]
            } else {
                other.0[lane]
            }
        }))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(from_fn(|lane| {
            if self.0[lane] > other.0[lane] {
                self.0[lane]
            } else {
                other.0[lane]
            }
        }))
    }

    #[inline(always)]
    fn inverse_sqrt(self) -> Self {
        Self(from_fn(|lane| 1.0 / self.0[lane].sqrt()))
    }

    #[inline(always)]
    fn where_positive(self, condition: Self) -> Self {
        Self(from_fn(|lane| {
            if condition.0[lane] > 0.0 {
                self.0[lane]
            } else {
                0.0
            }
        }))
    }

    #[inline(always)]
    fn any_less(self, other: Self) -> bool {
        Self::any(self.below(other))
    }

    #[inline(always)]
    fn below(self, other: Self) -> ArrayMask {
        ArrayMask(from_fn(|lane| self.0[lane] < other.0[lane]))
    }

    #[inline(always)]
    fn any(mask: ArrayMask) -> bool {
        mask.0 != [false; COUNT]
    }

    #[inline(always)]
    fn zip(self, other: Self) -> (Self, Self) {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        (Self([a, e, b, f]), Self([c, g, d, h]))
    }

    #[inline(always)]
    fn store(self, lanes: &mut [f32]) {
        lanes[..COUNT].copy_from_slice(&self.0);
    }
}

impl BitAnd for ArrayMask {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane] & other.0[lane]))
    }
}

impl Add for Array {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane] + other.0[lane]))
    }
}

impl Sub for Array {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane] - other.0[lane]))
    }
}

impl Mul for Array {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane] * other.0[lane]))
    }
}
