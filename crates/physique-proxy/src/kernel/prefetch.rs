//! Asks for memory before it is needed: a tile's rows are too far apart for processors to guess.

use std::marker::PhantomData;

use super::TileGradient;

/// The frames after a tile's, which are the next tile's if there is one, and the place of the
/// gradient, which is still far from known.
///
/// They are asked for in [`Ahead::PARTS`] parts, because a processor waits once too many requests
/// are under way.
pub(super) struct Ahead<'a> {
    next: *const i8,
    gradient: *const i8,
    bytes: usize,
    tile: PhantomData<&'a f32>,
}

impl<'a> Ahead<'a> {
    const PARTS: usize = 4;

    #[inline(always)]
    pub(super) fn new(frames: &'a [f32], gradient: Option<&TileGradient<'_>>) -> Self {
        let next = frames.as_ptr_range().end.cast();
        Self {
            next,
            gradient: gradient.map_or(next, |gradient| gradient.by_frames.as_ptr().cast()),
            bytes: size_of_val(frames),
            tile: PhantomData,
        }
    }

    #[inline(always)]
    pub(super) fn part(&self, part: usize) {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::x86_64::{_MM_HINT_ET0, _MM_HINT_T1, _mm_prefetch};
            const LINE: usize = 64;
            let bytes = part * self.bytes / Self::PARTS..(part + 1) * self.bytes / Self::PARTS;
            for line in bytes.step_by(LINE) {
                // SAFETY: prefetching never faults, wherever it points.
                unsafe {
                    _mm_prefetch::<_MM_HINT_T1>(self.next.wrapping_add(line));
                    _mm_prefetch::<_MM_HINT_ET0>(self.gradient.wrapping_add(line));
                }
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = (self.next, self.gradient, self.bytes, part, Self::PARTS);
    }
}
