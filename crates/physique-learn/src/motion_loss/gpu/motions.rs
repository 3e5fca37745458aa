//! From frames to motions, a motion a unit.

use cubecl::prelude::*;

use super::memory::{BROKEN, Frame, LOSS, TURNED};

/// Column of half the root's turn.
const ROOT_TURN: usize = 0;

/// Writes the loss of each motion, the mean over its frames, and unless the gradient is `full` the
/// derivative by the root's turn: a turn turns all frames after it.
///
/// `motions` has the first of a motion's frames, how many there are, and the first's row; the last of
/// `statistics` is no number.
#[cube(launch)]
pub(super) fn gather(
    statistics: &[f32],
    motions: &[u32],
    work: &[f32],
    gradient: &mut [f32],
    losses: &mut [f32],
    count: usize,
    frames: usize,
    columns: usize,
    first_loss: usize,
    #[comptime] full: bool,
) {
    let motion = ABSOLUTE_POS;
    if motion < count {
        let first = motions[3 * motion] as usize;
        let length = motions[3 * motion + 1] as usize;
        let row = motions[3 * motion + 2] as usize;
        let mut loss = 0.0f32;
        let mut by_half_turn = 0.0f32;
        for step in 0..length {
            let place = length - 1 - step;
            let at = Frame {
                index: first + place,
                count: frames,
            };
            loss += at.read(work, LOSS);
            if at.read(work, BROKEN) > 0.0f32 {
                loss = statistics[2 * columns];
            }
            if comptime!(!full) {
                let by_turn = by_half_turn * statistics[columns + ROOT_TURN];
                gradient[(row + place) * columns + ROOT_TURN] = by_turn;
                by_half_turn -= 2.0f32 * at.read(work, TURNED);
            }
        }
        losses[first_loss + motion] = loss / f32::cast_from(length as u32);
    }
}
