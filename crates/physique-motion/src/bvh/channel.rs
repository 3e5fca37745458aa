//! The columns of a frame.

use glam::{Quat, Vec3};

/// An axis of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axis {
    X,
    Y,
    Z,
}

/// What one number of a frame means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channel {
    /// A coordinate, in the file's unit.
    Position(Axis),
    /// A turn about an axis, in degrees.
    Rotation(Axis),
}

impl Channel {
    /// The channel that a keyword such as `Xposition` names, in any case.
    pub(super) fn from_keyword(keyword: &str) -> Option<Self> {
        let lower = keyword.to_ascii_lowercase();
        let axis = match lower.as_bytes().first()? {
            b'x' => Axis::X,
            b'y' => Axis::Y,
            b'z' => Axis::Z,
            _ => return None,
        };
        match &lower[1..] {
            "position" | "translation" => Some(Self::Position(axis)),
            "rotation" => Some(Self::Rotation(axis)),
            _ => None,
        }
    }

    /// The keyword of the format.
    pub(super) const fn keyword(self) -> &'static str {
        match self {
            Self::Position(Axis::X) => "Xposition",
            Self::Position(Axis::Y) => "Yposition",
            Self::Position(Axis::Z) => "Zposition",
            Self::Rotation(Axis::X) => "Xrotation",
            Self::Rotation(Axis::Y) => "Yrotation",
            Self::Rotation(Axis::Z) => "Zrotation",
        }
    }
}

/// The rotation of a joint: the turns of its rotation channels, the first channel outermost.
pub(super) fn rotation(channels: &[Channel], values: &[f32]) -> Quat {
    let mut rotation = Quat::IDENTITY;
    for (channel, degrees) in channels.iter().zip(values) {
        if let Channel::Rotation(axis) = channel {
            let angle = degrees.to_radians();
            rotation *= match axis {
                Axis::X => Quat::from_rotation_x(angle),
                Axis::Y => Quat::from_rotation_y(angle),
                Axis::Z => Quat::from_rotation_z(angle),
            };
        }
    }
    rotation
}

/// The position channels of a joint, in the file's unit; `default` where a coordinate has none.
pub(super) fn position(channels: &[Channel], values: &[f32], default: Vec3) -> Vec3 {
    let mut position = default;
    for (channel, &value) in channels.iter().zip(values) {
        match channel {
            Channel::Position(Axis::X) => position.x = value,
            Channel::Position(Axis::Y) => position.y = value,
            Channel::Position(Axis::Z) => position.z = value,
            Channel::Rotation(_) => {}
        }
    }
    position
}
