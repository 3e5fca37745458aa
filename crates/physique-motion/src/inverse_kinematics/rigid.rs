//! The rotation that takes some vectors closest to some others.

use glam::{Mat3, Quat, Vec3};

use crate::features::between;

/// The rotation R that minimises the sum of |R rest - now|^2 over the pairs, starting at `start`.
///
/// By Müller et al., "A Robust Method to Extract the Rotational Part of Deformations" (2016):
/// turn until the columns of R are in balance with those of the covariance. Unlike a singular value
/// decomposition it needs no care for reflections or vectors in a plane.
pub(super) fn best_rotation(pairs: &[(Vec3, Vec3)], start: Quat) -> Quat {
    const ITERATIONS: usize = 60;
    const RADIANS: f32 = 1e-6;
    let mut covariance = Mat3::ZERO;
    for &(rest, now) in pairs {
        covariance += Mat3::from_cols(now * rest.x, now * rest.y, now * rest.z);
    }
    let mut rotation = start;
    for _ in 0..ITERATIONS {
        let current = Mat3::from_quat(rotation);
        let (mut torque, mut balance) = (Vec3::ZERO, 0.0);
        for axis in 0..3 {
            torque += current.col(axis).cross(covariance.col(axis));
            balance += current.col(axis).dot(covariance.col(axis));
        }
        // At most a radian a step; far from the answer there is hardly any balance.
        let turn = torque / balance.abs().max(torque.length());
        if turn.is_nan() || turn.length() <= RADIANS {
            break;
        }
        rotation = (Quat::from_scaled_axis(turn) * rotation).normalize();
    }
    rotation
}

/// `rotation` turned the shortest way so that it takes `rest` to the direction of `now`.
pub(super) fn aim(rotation: Quat, rest: Vec3, now: Vec3) -> Quat {
    // Not glam's arc, which takes directions within 0.6 milliradians for the same.
    (between(
        (rotation * rest).normalize_or_zero(),
        now.normalize_or_zero(),
    ) * rotation)
        .normalize()
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};

    use super::{aim, best_rotation};

    #[test]
    fn finds_the_rotation_of_three_vectors_from_any_start() {
        let rest = [
            Vec3::new(0.06, -0.09, 0.0),
            Vec3::new(-0.06, -0.09, 0.0),
            Vec3::new(0.0, 0.13, -0.03),
        ];
        for angle in 0..40 {
            let truth = Quat::from_scaled_axis(Vec3::new(0.3, 1.0, -0.5) * (angle as f32 * 0.08));
            let pairs = rest.map(|rest| (rest, truth * rest));
            let found = best_rotation(&pairs, Quat::IDENTITY);
            assert!(
                found.angle_between(truth) < 2e-3,
                "{angle}: {}",
                found.angle_between(truth)
            );
        }
    }

    #[test]
    fn aiming_meets_the_direction_and_keeps_the_rest() {
        let aimed = aim(
            Quat::from_rotation_x(0.4),
            Vec3::NEG_Y,
            Vec3::new(0.1, -1.0, 0.3),
        );
        assert!((aimed * Vec3::NEG_Y).distance(Vec3::new(0.1, -1.0, 0.3).normalize()) < 1e-6);
        let same = aim(aimed, Vec3::NEG_Y, Vec3::ZERO);
        assert_eq!(same, aimed);
    }
}
