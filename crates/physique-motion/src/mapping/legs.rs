//! Two-bone inverse kinematics: a leg reaches for where its ankle should be.

use glam::{Quat, Vec3};

use super::axes::{reject, swing};

/// A knee nearer to the line from hip to ankle than this part of the thigh has no clear plane.
const NEARLY_STRAIGHT: f32 = 0.1;

/// A leg in the world: orientations of thigh and shin, and what bends where.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    /// Hip joint in the world.
    pub(super) hip: Vec3,
    /// Hip to knee and knee to ankle at rest.
    pub(super) bones: [Vec3; 2],
    /// World orientations of thigh and shin.
    pub(super) world_from_bone: [Quat; 2],
}

impl Leg {
    /// Knee and ankle in the world.
    pub(super) fn positions(&self) -> [Vec3; 2] {
        let knee = self.hip + self.world_from_bone[0] * self.bones[0];
        [knee, knee + self.world_from_bone[1] * self.bones[1]]
    }

    /// The leg with its ankle at `goal`, or as near as it reaches.
    ///
    /// The knee stays in the plane in which it bent before; a straight leg bends about the
    /// thigh's own left, forwards. Bones turn the shortest way, so twist stays. Near full reach
    /// the ankle falls short of the goal by at most 2 in 1000 of the leg instead of the knee
    /// snapping straight.
    pub(super) fn reaching(&self, goal: Vec3) -> Self {
        let [thigh, shin] = self.bones.map(Vec3::length);
        let Some(direction) = (goal - self.hip).try_normalize() else {
            return *self;
        };
        let nearest = (thigh - shin).abs() * 1.001 + 1e-4;
        let distance = soft_reach((goal - self.hip).length(), thigh + shin).max(nearest);

        // Where the knee goes: where it was; of a nearly straight leg, a little forwards.
        let [knee, _] = self.positions();
        let bent = knee - self.hip;
        let bent = (bent - direction * bent.dot(direction)) / thigh;
        let straight = (1.0 - bent.length() / NEARLY_STRAIGHT).max(0.0);
        let forwards = direction.cross(self.world_from_bone[0] * Vec3::X);
        let bent = bent + NEARLY_STRAIGHT * straight * straight * forwards;
        let Some(toward_knee) = reject(bent, direction) else {
            return *self;
        };
        let along = (thigh * thigh - shin * shin + distance * distance) / (2.0 * distance);
        let across = (thigh * thigh - along * along).max(0.0).sqrt();
        let thigh_bone = direction * along + toward_knee * across;
        let shin_bone = direction * distance - thigh_bone;
        let turned = |bone: usize, to: Vec3| {
            let world_from_bone = self.world_from_bone[bone];
            (swing(world_from_bone * self.bones[bone], to) * world_from_bone).normalize()
        };
        Self {
            world_from_bone: [turned(0, thigh_bone), turned(1, shin_bone)],
            ..*self
        }
    }
}

/// A distance that never quite comes to `reach`, and is left alone below 998 of 1000 of it.
fn soft_reach(distance: f32, reach: f32) -> f32 {
    let start = 0.998 * reach;
    if distance <= start {
        return distance;
    }
    let room = reach - start;
    start + room * (1.0 - (-(distance - start) / room).exp())
}

#[cfg(test)]
mod tests {
    use super::{Leg, Quat, Vec3, soft_reach};

    fn leg() -> Leg {
        Leg {
            hip: Vec3::new(0.1, 0.9, 0.0),
            bones: [Vec3::new(0.02, -0.4, 0.01), Vec3::new(-0.01, -0.41, -0.03)],
            world_from_bone: [Quat::from_rotation_x(-0.4), Quat::from_rotation_x(0.3)],
        }
    }

    #[test]
    fn a_leg_reaches_its_goal_with_bones_of_the_same_length() {
        let goal = Vec3::new(0.05, 0.15, 0.1);
        let [knee, ankle] = leg().reaching(goal).positions();
        assert!(ankle.distance(goal) < 1e-5);
        assert!(((knee - leg().hip).length() - leg().bones[0].length()).abs() < 1e-6);
    }

    #[test]
    fn a_goal_already_met_changes_nothing() {
        let [knee, ankle] = leg().positions();
        let [knee_after, ankle_after] = leg().reaching(ankle).positions();
        assert!(ankle.distance(ankle_after) < 1e-5);
        assert!(knee.distance(knee_after) < 1e-5);
    }

    #[test]
    fn a_straight_leg_bends_forwards() {
        let mut straight = leg();
        straight.world_from_bone = [Quat::IDENTITY; 2];
        straight.bones = [Vec3::new(0.0, -0.4, 0.0), Vec3::new(0.0, -0.4, 0.0)];
        let [knee, _] = straight.reaching(straight.hip - Vec3::Y * 0.7).positions();
        assert!(knee.z > 0.1, "{knee}");
    }

    #[test]
    fn reach_is_soft_continuous_and_bounded() {
        assert_eq!(soft_reach(0.5, 1.0), 0.5);
        assert!((soft_reach(0.9981, 1.0) - 0.9981).abs() < 1e-5);
        assert!(soft_reach(9.0, 1.0) <= 1.0);
    }
}
