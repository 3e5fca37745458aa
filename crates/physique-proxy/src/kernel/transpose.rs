//! Frames to lanes and back, in square blocks.

use crate::lanes::{Lanes, MOST_LANES, Simd};

/// Starts of the blocks that cover all numbers of a frame; the last one reaches back over its
/// neighbour, so that none is cut.
#[inline(always)]
fn blocks(numbers: usize, count: usize) -> impl Iterator<Item = usize> {
    (0..numbers.div_ceil(count)).map(move |block| (block * count).min(numbers - count))
}

/// `frames` are as many as lanes, of as many numbers as `lanes`: a number that the compiler knows,
/// which halves the time of the whole kernel. Returns 0 in lanes of finite frames, else NaN.
#[inline(always)]
pub(super) fn load<S: Simd, const NUMBERS: usize>(
    simd: S,
    frames: &[f32],
    lanes: &mut [S::Lanes],
) -> S::Lanes {
    let frames = frames.as_chunks::<NUMBERS>().0;
    let zero = simd.splat(0.0);
    // Four sums, so that none waits for the last.
    let mut poison = [zero; 4];
    for start in blocks(NUMBERS, S::COUNT) {
        let mut block = [simd.splat(0.0); MOST_LANES];
        for (row, frame) in block.iter_mut().zip(&frames[..S::COUNT]) {
            *row = simd.load(&frame[start..]);
        }
        transpose::<S>(&mut block);
        for (place, lane) in block[..S::COUNT].iter().enumerate() {
            poison[place % 4] = lane.mul_add(zero, poison[place % 4]);
        }
        lanes[start..start + S::COUNT].copy_from_slice(&block[..S::COUNT]);
    }
    (poison[0] + poison[1]) + (poison[2] + poison[3])
}

/// `frames` are as many as lanes, of as many numbers as `lanes`.
#[inline(always)]
pub(super) fn store<S: Simd, const NUMBERS: usize>(
    simd: S,
    lanes: &[S::Lanes],
    frames: &mut [f32],
) {
    let frames = frames.as_chunks_mut::<NUMBERS>().0;
    for start in blocks(NUMBERS, S::COUNT) {
        let mut block = [simd.splat(0.0); MOST_LANES];
        block[..S::COUNT].copy_from_slice(&lanes[start..start + S::COUNT]);
        transpose::<S>(&mut block);
        for (row, frame) in block.iter().zip(&mut frames[..S::COUNT]) {
            row.store(&mut frame[start..]);
        }
    }
}

/// Zipping the upper half of the rows with the lower half, as often as a row can be halved,
/// transposes a square.
#[inline(always)]
fn transpose<S: Simd>(rows: &mut [S::Lanes; MOST_LANES]) {
    let half = S::COUNT / 2;
    for _ in 0..S::COUNT.ilog2() {
        let before = *rows;
        for row in 0..half {
            (rows[2 * row], rows[2 * row + 1]) = before[row].zip(before[row + half]);
        }
    }
}
