//! Frames to lanes and back, in square blocks.

use physique_body::Joint;

use crate::PoseMatrices;
use crate::lanes::{Lanes, MOST_LANES, Simd};

const NUMBERS: usize = 9 * Joint::COUNT;

/// Starts of the blocks that cover all numbers of a frame; the last one reaches back over its
/// neighbour, so that none is cut.
#[inline(always)]
fn blocks(count: usize) -> impl Iterator<Item = usize> {
    (0..NUMBERS.div_ceil(count)).map(move |block| (block * count).min(NUMBERS - count))
}

/// `poses` are as many as lanes. Returns 0 in lanes of finite poses, else NaN.
#[inline(always)]
pub(super) fn load<S: Simd>(
    simd: S,
    poses: &[PoseMatrices],
    lanes: &mut [[S::Lanes; 9]; Joint::COUNT],
) -> S::Lanes {
    let lanes = lanes.as_flattened_mut();
    let zero = simd.splat(0.0);
    // Four sums, so that none waits for the last.
    let mut poison = [zero; 4];
    for start in blocks(S::COUNT) {
        let mut block = [simd.splat(0.0); MOST_LANES];
        for (row, pose) in block.iter_mut().zip(&poses[..S::COUNT]) {
            *row = simd.load(&pose.as_flattened()[start..]);
        }
        transpose::<S>(&mut block);
        for (place, lane) in block[..S::COUNT].iter().enumerate() {
            poison[place % 4] = lane.mul_add(zero, poison[place % 4]);
        }
        lanes[start..start + S::COUNT].copy_from_slice(&block[..S::COUNT]);
    }
    (poison[0] + poison[1]) + (poison[2] + poison[3])
}

/// `poses` are as many as lanes.
#[inline(always)]
pub(super) fn store<S: Simd>(
    simd: S,
    lanes: &[[S::Lanes; 9]; Joint::COUNT],
    poses: &mut [PoseMatrices],
) {
    let lanes = lanes.as_flattened();
    for start in blocks(S::COUNT) {
        let mut block = [simd.splat(0.0); MOST_LANES];
        block[..S::COUNT].copy_from_slice(&lanes[start..start + S::COUNT]);
        transpose::<S>(&mut block);
        for (row, pose) in block.iter().zip(&mut poses[..S::COUNT]) {
            row.store(&mut pose.as_flattened_mut()[start..]);
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
