//! Turning the file's world to ours and back, in double precision.

use glam::{DQuat, DVec3};

use crate::UpAxis;

/// Rotation that takes vectors of the file's world to our Y-up world.
pub(super) fn ours_from_file(up: UpAxis) -> DQuat {
    use std::f64::consts::FRAC_1_SQRT_2;
    match up {
        UpAxis::Y => DQuat::IDENTITY,
        // A quarter turn about X that takes Z to Y, and so Y to -Z.
        UpAxis::Z => DQuat::from_xyzw(-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2),
    }
}

/// A vector of the file's world in ours: a swap of axes, so exact.
pub(super) fn to_ours(up: UpAxis, vector: DVec3) -> DVec3 {
    match up {
        UpAxis::Y => vector,
        UpAxis::Z => DVec3::new(vector.x, vector.z, -vector.y),
    }
}

/// A vector of our world in the file's.
pub(super) fn to_file(up: UpAxis, vector: DVec3) -> DVec3 {
    match up {
        UpAxis::Y => vector,
        UpAxis::Z => DVec3::new(vector.x, -vector.z, vector.y),
    }
}

#[cfg(test)]
mod tests {
    use super::{DVec3, UpAxis, ours_from_file, to_file, to_ours};

    #[test]
    fn rotation_and_swap_agree_and_invert() {
        let vector = DVec3::new(1.0, 2.0, 3.0);
        for up in [UpAxis::Y, UpAxis::Z] {
            let ours = to_ours(up, vector);
            assert!((ours_from_file(up) * vector - ours).length() < 1e-15);
            assert_eq!(to_file(up, ours), vector);
        }
        assert_eq!(to_ours(UpAxis::Z, DVec3::Z), DVec3::Y);
    }
}
