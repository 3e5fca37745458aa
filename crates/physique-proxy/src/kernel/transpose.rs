//! Frames to lanes and back, in square blocks.

use crate::lanes::{Lanes, MOST_LANES, Simd};

/// Where a block starts, of those that cover all numbers of a frame; the last one reaches back over
/// its neighbour, so that none is cut.
#[inline(always)]
const fn start(block: usize, numbers: usize, count: usize) -> usize {
    let start = block * count;
    if start + count > numbers {
        numbers - count
    } else {
        start
    }
}

/// `frames` are as many as lanes, of as many numbers as `lanes`: a number that the compiler knows,
/// which halves the time of the whole kernel. Returns 0 in lanes of finite frames, else NaN.
#[inline(always)]
pub(super) fn load<S: Simd, const NUMBERS: usize>(
    simd: S,
    frames: &[f32],
    lanes: &mut [S::Lanes],
) -> S::Lanes {
    let frames = &frames.as_chunks::<NUMBERS>().0[..S::COUNT];
    let lanes = &mut lanes[..NUMBERS];
    let zero = simd.splat(0.0);
    // Four sums, so that none waits for the last.
    let mut poison = [zero; 4];
    for block in 0..NUMBERS.div_ceil(S::COUNT) {
        let start = start(block, NUMBERS, S::COUNT);
        let mut block = [zero; MOST_LANES];
        for row in 0..S::COUNT {
            block[row] = simd.load(&frames[row][start..]);
        }
        transpose::<S>(&mut block);
        for row in 0..S::COUNT {
            poison[row % 4] = block[row].mul_add(zero, poison[row % 4]);
            lanes[start + row] = block[row];
        }
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
    let frames = &mut frames.as_chunks_mut::<NUMBERS>().0[..S::COUNT];
    let lanes = &lanes[..NUMBERS];
    for block in 0..NUMBERS.div_ceil(S::COUNT) {
        let start = start(block, NUMBERS, S::COUNT);
        let mut block = [simd.splat(0.0); MOST_LANES];
        for row in 0..S::COUNT {
            block[row] = lanes[start + row];
        }
        transpose::<S>(&mut block);
        for row in 0..S::COUNT {
            block[row].store(&mut frames[row][start..]);
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
