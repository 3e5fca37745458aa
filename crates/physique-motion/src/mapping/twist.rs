//! Where along the forearm a hand's turn happens.

use glam::{Quat, Vec3};

/// The forearm's world orientation with part of the hand's twist about it.
///
/// Many rigs turn the hand alone; a skinned wrist then wraps like a candy paper. Of a twist t the
/// forearm takes (pi / 4) sin t: nearly half of a small one, 45 degrees of a right angle, nothing
/// of half a turn, where the sign of t is noise: so the result is continuous. Bone directions and
/// the hand's orientation do not change. `forearm` is the rest bone from elbow to wrist.
pub(super) fn share_wrist_twist(
    world_from_elbow: Quat,
    world_from_wrist: Quat,
    forearm: Vec3,
) -> Quat {
    let Some(axis) = forearm.try_normalize() else {
        return world_from_elbow;
    };
    let elbow_from_wrist = world_from_elbow.inverse() * world_from_wrist;
    let along = elbow_from_wrist.xyz().dot(axis);
    // Twice the half angle; a whole turn more makes no difference to the sine.
    let twist = 2.0 * along.atan2(elbow_from_wrist.w);
    let share = std::f32::consts::FRAC_PI_4 * twist.sin();
    (world_from_elbow * Quat::from_axis_angle(axis, share)).normalize()
}

#[cfg(test)]
mod tests {
    use super::{Quat, Vec3, share_wrist_twist};

    #[test]
    fn the_forearm_takes_half_of_a_right_angle_and_keeps_its_direction() {
        let forearm = Vec3::new(0.25, 0.01, 0.0);
        let elbow = Quat::from_rotation_z(0.4);
        let turned = Quat::from_axis_angle(forearm.normalize(), std::f32::consts::FRAC_PI_2);
        let shared = share_wrist_twist(elbow, elbow * turned, forearm);
        assert!((shared * forearm).distance(elbow * forearm) < 1e-6);
        assert!((shared.angle_between(elbow).to_degrees() - 45.0).abs() < 0.01);
    }

    #[test]
    fn it_is_continuous_where_the_twist_changes_sign() {
        let about = |degrees: f32| Quat::from_rotation_x(degrees.to_radians());
        let [before, after] =
            [179.5, 180.5].map(|twist| share_wrist_twist(Quat::IDENTITY, about(twist), Vec3::X));
        assert!(before.angle_between(after).to_degrees() < 2.0);
    }
}
