//! Directions and the rotations that align them.

use glam::{Mat3, Quat, Vec3, Vec4};

/// The rotation that takes one pair of directions to another: `from_primary` exactly onto
/// `to_primary`, and `from_secondary` as near to `to_secondary` as that allows.
///
/// `None` when a pair has no plane.
pub(super) fn align(
    [from_primary, from_secondary]: [Vec3; 2],
    [to_primary, to_secondary]: [Vec3; 2],
) -> Option<Quat> {
    let from = basis(from_primary, from_secondary)?;
    let to = basis(to_primary, to_secondary)?;
    Some(Quat::from_mat3(&(to * from.transpose())).normalize())
}

/// Right-handed axes: `primary`, what of `secondary` is square to it, and their cross product.
fn basis(primary: Vec3, secondary: Vec3) -> Option<Mat3> {
    let x = primary.try_normalize()?;
    let y = reject(secondary, x)?;
    Some(Mat3::from_cols(x, y, x.cross(y)))
}

/// The unit direction of what of `direction` is square to the unit `axis`.
pub(super) fn reject(direction: Vec3, axis: Vec3) -> Option<Vec3> {
    let direction = direction.try_normalize()?;
    let square = direction - axis * direction.dot(axis);
    (square.length() > 1e-3).then(|| square.normalize())
}

/// The shortest rotation from one direction to another, the identity for a zero vector.
pub(super) fn swing(from: Vec3, to: Vec3) -> Quat {
    match (from.try_normalize(), to.try_normalize()) {
        (Some(from), Some(to)) => Quat::from_rotation_arc(from, to),
        _ => Quat::IDENTITY,
    }
}

/// The coordinate axis within `degrees` of a direction, otherwise the direction itself.
///
/// Rigs whose zero pose is no human pose are authored with bones and hinges along local axes,
/// so a measured direction near an axis means the axis.
pub(super) fn snapped(direction: Vec3, degrees: f32) -> Vec3 {
    let direction = direction.normalize_or_zero();
    let axes = [
        Vec3::X,
        Vec3::Y,
        Vec3::Z,
        Vec3::NEG_X,
        Vec3::NEG_Y,
        Vec3::NEG_Z,
    ];
    let nearest = axes
        .into_iter()
        .max_by(|a, b| a.dot(direction).total_cmp(&b.dot(direction)))
        .unwrap_or(Vec3::X);
    if nearest.dot(direction) >= degrees.to_radians().cos() {
        nearest
    } else {
        direction
    }
}

/// Angle between two directions, in degrees; 0 where one has no length.
pub(super) fn degrees_between(a: Vec3, b: Vec3) -> f32 {
    if a.length_squared() > 0.0 && b.length_squared() > 0.0 {
        a.angle_between(b).to_degrees()
    } else {
        0.0
    }
}

/// Weighted mean of rotations that lie within a half space of each other; `None` without any
/// weight. Signs follow the first rotation.
pub(super) fn mean_rotation(rotations: impl IntoIterator<Item = (f32, Quat)>) -> Option<Quat> {
    let mut sum = Vec4::ZERO;
    for (weight, rotation) in rotations {
        let value = Vec4::from(rotation);
        let sign = if sum.dot(value) < 0.0 { -1.0 } else { 1.0 };
        sum += value * (weight * sign);
    }
    (sum.length() > 1e-6).then(|| Quat::from_vec4(sum).normalize())
}
