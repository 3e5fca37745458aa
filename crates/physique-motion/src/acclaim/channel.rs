//! Numbers of a bone, and turns about fixed axes.

use glam::{DQuat, DVec3};

/// What one number of a bone's line means; axes count from 0 for X.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channel {
    /// A way along an axis, in the file's unit.
    Translation(usize),
    /// A turn about an axis.
    Rotation(usize),
}

impl Channel {
    /// The channel that a token such as `rx` or `TY` names.
    pub(super) fn from_token(token: &[u8]) -> Option<Self> {
        match token {
            [b't' | b'T', letter] => axis(*letter).map(Self::Translation),
            [b'r' | b'R', letter] => axis(*letter).map(Self::Rotation),
            _ => None,
        }
    }
}

/// An axis by its letter.
pub(super) fn axis(letter: u8) -> Option<usize> {
    match letter.to_ascii_lowercase() {
        b'x' => Some(0),
        b'y' => Some(1),
        b'z' => Some(2),
        _ => None,
    }
}

/// Turns by `radians` about the fixed axes, one after the other.
pub(super) fn turns(axes_and_radians: impl Iterator<Item = (usize, f64)>) -> DQuat {
    axes_and_radians.fold(DQuat::IDENTITY, |before, (axis, radians)| {
        DQuat::from_axis_angle(DVec3::AXES[axis], radians) * before
    })
}
