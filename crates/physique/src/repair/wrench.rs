//! Forces on a posed body, and what they would turn: gradients by points, carried to the joints.

use glam::{DMat3, DMat4, DVec3};
use physique_body::Joint;
use physique_physics::loss::SkinPoint;
use physique_physics::{MassMoments, Rig};

/// Sums of forces on each joint's part of the body, and of their moments about the origin.
///
/// A cost of points has forces on them as its gradient; turning a joint moves all points behind it
/// as one rigid body, so that forces and moments of a branch add up.
#[derive(Clone, Debug, Default)]
pub(super) struct Wrenches {
    of_joints: Vec<(DVec3, DVec3)>,
}

impl Wrenches {
    pub(super) fn clear(&mut self, rig: &Rig) {
        self.of_joints.clear();
        self.of_joints
            .resize(rig.joint_count(), (DVec3::ZERO, DVec3::ZERO));
    }

    /// A force at a place that moves with a joint.
    pub(super) fn push(&mut self, joint: usize, place: DVec3, force: DVec3) {
        let (sum, moment) = &mut self.of_joints[joint];
        *sum += force;
        *moment += place.cross(force);
    }

    /// A force on a point of the skin.
    pub(super) fn push_skin(&mut self, point: &SkinPoint, world_from_rest: &[DMat4], force: DVec3) {
        for &(joint, weight) in &point.weights {
            let place = world_from_rest[joint].transform_point3(point.rest);
            self.push(joint, place, force * weight);
        }
    }

    /// A force on the centre of mass.
    pub(super) fn push_centre(
        &mut self,
        moments: &MassMoments,
        world_from_rest: &[DMat4],
        force: DVec3,
    ) {
        let share = force / moments.mass();
        let joints = self.of_joints.iter_mut().zip(world_from_rest);
        for (((sum, moment), &world), &first) in joints.zip(moments.first()) {
            *sum += share * first.w;
            *moment += (world * first).truncate().cross(share);
        }
    }

    /// Adds the derivatives by small turns `R -> exp(w) R` of the rotations, `w` in the parent's
    /// axes, to `turns`; returns those by the root's displacement. The sums are used up.
    pub(super) fn carry(
        &mut self,
        rig: &Rig,
        world_from_rest: &[DMat4],
        turns: &mut [DVec3; Joint::COUNT],
    ) -> DVec3 {
        let mut root = DVec3::ZERO;
        for joint in (0..rig.joint_count()).rev() {
            let (force, moment) = self.of_joints[joint];
            let parent = rig.parents()[joint];
            match parent {
                Some(parent) => {
                    self.of_joints[parent].0 += force;
                    self.of_joints[parent].1 += moment;
                }
                None => root += force,
            }
            if let Some(turn) = turns.get_mut(joint) {
                let pivot = world_from_rest[joint].transform_point3(rig.rest_joints()[joint]);
                let axes = parent.map_or(DMat3::IDENTITY, |parent| {
                    DMat3::from_mat4(world_from_rest[parent])
                });
                *turn += axes.transpose() * (moment - pivot.cross(force));
            }
        }
        root
    }
}

/// A point of the skin in the world.
pub(super) fn posed(point: &SkinPoint, world_from_rest: &[DMat4]) -> DVec3 {
    let places = point.weights.iter();
    places
        .map(|&(joint, weight)| world_from_rest[joint].transform_point3(point.rest) * weight)
        .sum()
}
