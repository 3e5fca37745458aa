//! Plain Rust: 4 lanes in an array, which compilers turn into whatever the target always has.

use std::ops::{Add, BitAnd, Mul, Sub};

use super::{Answers, Kernel, Lanes, Simd};

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

/// An array of what `$result` is in each lane. Written out, not by a closure: a kernel is so long that
/// the compiler stops inlining those, which takes twenty times the time.
macro_rules! each {
    ($lane:ident => $result:expr) => {
        [
            {
                let $lane = 0;
                $result
            },
            {
                let $lane = 1;
                $result
            },
            {
                let $lane = 2;
                $result
            },
            {
                let $lane = 3;
                $result
            },
        ]
    };
}

impl Simd for Portable {
    type Lanes = Array;

    const COUNT: usize = COUNT;

    #[inline(always)]
    fn splat(self, number: f32) -> Array {
        Array([number; COUNT])
    }

    #[inline(always)]
    fn load(self, lanes: &[f32]) -> Array {
        let lanes = &lanes[..COUNT];
        Array(each!(lane => lanes[lane]))
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
        Self(each!(lane => {
            if self.0[lane] < other.0[lane] {
                self.0[lane]
            } else {
                other.0[lane]
            }
        }))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(each!(lane => {
            if self.0[lane] > other.0[lane] {
                self.0[lane]
            } else {
                other.0[lane]
            }
        }))
    }

    #[inline(always)]
    fn inverse_sqrt(self) -> Self {
        Self(each!(lane => 1.0 / self.0[lane].sqrt()))
    }

    #[inline(always)]
    fn where_positive(self, condition: Self) -> Self {
        Self(each!(lane => {
            if condition.0[lane] > 0.0 {
                self.0[lane]
            } else {
                0.0
            }
        }))
    }

    #[inline(always)]
    fn below(self, other: Self) -> ArrayMask {
        ArrayMask(each!(lane => self.0[lane] < other.0[lane]))
    }

    #[inline(always)]
    fn any(mask: ArrayMask) -> bool {
        mask.0 != [false; COUNT]
    }

    type Row = u16;

    #[inline(always)]
    fn any_negative([a, b, c, d]: [Self; 4]) -> u16 {
        u16::from(a.negative())
            | u16::from(b.negative()) << 4
            | u16::from(c.negative()) << 8
            | u16::from(d.negative()) << 12
    }

    #[inline(always)]
    fn gather(rows: [u16; 4]) -> Answers {
        Answers::of_rows(rows)
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

impl Array {
    /// Whether any lane is negative: one look at all signs.
    #[inline(always)]
    fn negative(self) -> bool {
        let [a, b, c, d] = self.0;
        (a.to_bits() | b.to_bits() | c.to_bits() | d.to_bits()) >> 31 == 1
    }
}

impl BitAnd for ArrayMask {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(each!(lane => self.0[lane] & other.0[lane]))
    }
}

impl Add for Array {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(each!(lane => self.0[lane] + other.0[lane]))
    }
}

impl Sub for Array {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(each!(lane => self.0[lane] - other.0[lane]))
    }
}

impl Mul for Array {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(each!(lane => self.0[lane] * other.0[lane]))
    }
}
