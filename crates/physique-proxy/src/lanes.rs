//! Vector registers whose lanes are frames, and the choice among what the processor has.
//!
//! A kernel is written once, generic over [`Simd`], and compiled once for every [`Backend`]. A value
//! that implements [`Simd`] is the proof that the processor has the instructions: it comes from
//! detection only, and [`Lanes`] come from it only. That is what makes the safe functions of the
//! backends sound.

use std::fmt;
use std::ops::{Add, Mul, Sub};

mod answers;
#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
mod portable;

pub(crate) use answers::Answers;

/// A register of `f32`, one lane a frame.
pub(crate) trait Lanes:
    Copy + Send + Sync + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// `self * factor + term`, fused where the processor can.
    fn mul_add(self, factor: Self, term: Self) -> Self;

    /// `term - self * factor`, fused where the processor can.
    fn neg_mul_add(self, factor: Self, term: Self) -> Self;

    /// The smaller of each two, of numbers.
    fn min(self, other: Self) -> Self;

    /// The larger of each two; `other` where `self` is NaN.
    fn max(self, other: Self) -> Self;

    /// `1 / sqrt(self)` of positive numbers, to about 2 units in the last place.
    fn inverse_sqrt(self) -> Self;

    /// `self` where `condition` is above 0, else 0.
    fn where_positive(self, condition: Self) -> Self;

    /// One answer a lane, to be combined.
    type Mask: Copy + std::ops::BitAnd<Output = Self::Mask>;

    /// Which lanes are below the other's, of finite numbers.
    fn below(self, other: Self) -> Self::Mask;

    /// Whether any lane is set.
    fn any(mask: Self::Mask) -> bool;

    /// Four times the answer whether any lane is negative, to be gathered.
    type Row: Copy;

    /// Which of four differences are negative in any lane; differences are not NaN.
    fn any_negative(differences: [Self; 4]) -> Self::Row;

    /// Sixteen answers in one: many times as fast as one by one.
    fn gather(rows: [Self::Row; 4]) -> Answers;

    /// Lanes of both in turn: `(a0, b0, a1, b1, ...)`, the first half and the second.
    fn zip(self, other: Self) -> (Self, Self);

    /// Writes the lanes out; `lanes` has as many elements.
    fn store(self, lanes: &mut [f32]);
}

/// The right to use a processor's vector instructions.
pub(crate) trait Simd: Copy + Send + Sync + 'static {
    /// The register.
    type Lanes: Lanes;

    /// Lanes in a register: a power of 2, at most [`MOST_LANES`].
    const COUNT: usize;

    /// The same number in all lanes.
    fn splat(self, number: f32) -> Self::Lanes;

    /// The first [`Simd::COUNT`] numbers.
    fn load(self, lanes: &[f32]) -> Self::Lanes;

    /// Runs a kernel compiled for these instructions.
    fn run<K: Kernel<Self>>(self, kernel: K) -> K::Output;
}

/// Most lanes of any backend.
pub(crate) const MOST_LANES: usize = 16;

/// Code to compile for a backend. `run` must be `#[inline(always)]`, and so must all that it calls
/// with lanes: else it is compiled for the least processor.
pub(crate) trait Kernel<S: Simd> {
    /// What the kernel returns.
    type Output;

    /// The kernel.
    fn run(self, simd: S) -> Self::Output;
}

/// A set of vector instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Backend {
    /// 16 frames at a time, x86-64.
    Avx512,
    /// 8 frames at a time, x86-64 with fused multiply-add.
    Avx2,
    /// 4 frames at a time, 64-bit Arm.
    Neon,
    /// 4 frames at a time in plain Rust, for every processor.
    Portable,
}

impl Backend {
    const ALL: [Self; 4] = [Self::Avx512, Self::Avx2, Self::Neon, Self::Portable];

    /// The fastest that this processor has.
    pub fn best() -> Self {
        Self::available().next().unwrap_or(Self::Portable)
    }

    /// All that this processor has, the fastest first.
    pub fn available() -> impl Iterator<Item = Self> {
        Self::ALL
            .into_iter()
            .filter(|backend| backend.is_available())
    }

    /// Whether this processor has it.
    pub fn is_available(self) -> bool {
        struct Found;
        impl Dispatch for Found {
            type Output = ();
            fn with<S: Simd>(self, _: S) {}
        }
        self.dispatch(Found).is_some()
    }

    /// Hands the backend's proof to `dispatch`; `None` where the processor lacks it.
    pub(crate) fn dispatch<D: Dispatch>(self, dispatch: D) -> Option<D::Output> {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => Some(dispatch.with(avx512::Avx512::detect()?)),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => Some(dispatch.with(avx2::Avx2::detect()?)),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => Some(dispatch.with(neon::Neon::detect()?)),
            Self::Portable => Some(dispatch.with(portable::Portable)),
            #[allow(unreachable_patterns)] // Which are reachable depends on the processor.
            _ => None,
        }
    }
}

impl fmt::Display for Backend {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Avx512 => "AVX-512",
            Self::Avx2 => "AVX2",
            Self::Neon => "NEON",
            Self::Portable => "portable",
        })
    }
}

/// What to do with the backend that was chosen at run time.
pub(crate) trait Dispatch {
    /// What comes of it.
    type Output;

    /// Does it.
    fn with<S: Simd>(self, simd: S) -> Self::Output;
}

#[cfg(test)]
mod tests;
