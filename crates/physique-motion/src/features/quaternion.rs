//! Quaternion arithmetic as the published pipelines do it.
//!
//! glam's own operations are as right, but round differently; data on disk were made with these,
//! in 32 bits, and a motion recovered from features equals the published one to two units in the
//! last place.

use glam::{Mat3, Quat, Vec3};

/// The shortest rotation that takes the direction `from` to the direction `to`:
/// normalise(sqrt(|from|^2 |to|^2) + from . to, from x to).
///
/// For opposite directions the reference divides nothing by nothing and returns NaN; this returns
/// half a turn about an axis at right angles. (The copy of the function in MDM also adds 1e-4 to
/// the last component; no published data were made with it.)
///
/// The rotation has no meaning, and is the identity, when one of the two has no length.
pub fn between(from: Vec3, to: Vec3) -> Quat {
    let lengths = (from.length_squared() * to.length_squared()).sqrt();
    let vector = from.cross(to);
    let sum = Quat::from_xyzw(vector.x, vector.y, vector.z, lengths + from.dot(to));
    let length = sum.length();
    if length > 0.0 {
        return sum / length;
    }
    let unit = from.try_normalize().filter(|_| lengths > 0.0);
    unit.map_or(Quat::IDENTITY, |unit| {
        Quat::from_vec4(unit.any_orthonormal_vector().extend(0.0))
    })
}

/// Hamilton product: first `b`, then `a`.
#[rustfmt::skip]
pub fn multiply(a: Quat, b: Quat) -> Quat {
    Quat::from_xyzw(
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    )
}

/// The vector turned by a unit quaternion: v + 2 (w (u x v) + u x (u x v)).
pub fn rotate(rotation: Quat, vector: Vec3) -> Vec3 {
    let axis = Vec3::new(rotation.x, rotation.y, rotation.z);
    let once = axis.cross(vector);
    vector + 2.0 * (rotation.w * once + axis.cross(once))
}

/// The rotation matrix of a quaternion of any length but zero.
pub fn matrix(rotation: Quat) -> Mat3 {
    let [x, y, z, w] = rotation.to_array();
    let s = 2.0 / rotation.length_squared();
    Mat3::from_cols(
        Vec3::new(
            1.0 - s * (y * y + z * z),
            s * (x * y + z * w),
            s * (x * z - y * w),
        ),
        Vec3::new(
            s * (x * y - z * w),
            1.0 - s * (x * x + z * z),
            s * (y * z + x * w),
        ),
        Vec3::new(
            s * (x * z + y * w),
            s * (y * z - x * w),
            1.0 - s * (x * x + y * y),
        ),
    )
}
