//! Arms: collars point to the side, elbows bend forward, palms face down.

use glam::Vec3;

use super::{Anatomy, SNAP_DEGREES, Side};
use crate::mapping::axes::snapped;

impl Anatomy<'_> {
    pub(super) fn arm(&mut self, side: Side) {
        let limbs = *side.limbs(self.human);
        let (shoulder, elbow) = (limbs.shoulder, limbs.elbow);
        if let Some(collar) = limbs.collar {
            // A clavicle at rest points to the side; the body's own slope stays the body's.
            let chest = self.human.chest();
            let chest_from_body = self.joint_from_body[chest];
            let forward = self.seen_from(collar, |pose| {
                pose.rotations[chest] * (chest_from_body * Vec3::Z)
            });
            let bone = snapped(self.bone(collar, shoulder), SNAP_DEGREES);
            let local = [bone, snapped(forward, SNAP_DEGREES)];
            self.set(collar, [side.outward, Vec3::Z], local);
        }
        // An elbow bends forward.
        let body_upper = self.body.bone(side.shoulder, side.elbow);
        let body_hinge = side.outward.cross(Vec3::Z);
        let upper = self.bone(shoulder, elbow);
        let Some(wrist) = limbs.wrist else {
            let hinge = self.chest_axis(shoulder, body_hinge);
            self.set(shoulder, [body_upper, body_hinge], [upper, hinge]);
            self.carry(shoulder, elbow);
            return;
        };
        let bones = [shoulder, elbow, wrist];
        let mut hinge = self.hinge(shoulder, bones);
        if hinge == Vec3::ZERO {
            hinge = self.chest_axis(shoulder, body_hinge);
        }
        self.set(shoulder, [body_upper, body_hinge], [upper, hinge]);

        let fore = self.bone(elbow, wrist);
        let fore_hinge = self.carried_if_straight(upper, hinge, [shoulder, elbow], fore, bones);
        let body_fore = self.body.bone(side.elbow, side.wrist);
        self.set(elbow, [body_fore, body_hinge], [fore, fore_hinge]);
        self.carry(elbow, wrist);
        self.palm(side, wrist);
    }

    /// A palm faces down in a T-pose: the knuckle of the index lies before that of the little
    /// finger. Without fingers the hand stays as the zero pose has it.
    fn palm(&mut self, side: Side, wrist: usize) {
        let knuckle = |names: &[&str]| {
            (wrist + 1..self.skeleton.joint_count()).find(|&joint| {
                let name = self.skeleton.joints()[joint].name.to_lowercase();
                names.iter().any(|finger| name.contains(finger))
                    && self.skeleton.is_at_or_below(joint, wrist)
            })
        };
        let (Some(index), Some(little)) = (knuckle(&["index"]), knuckle(&["pinky", "little"]))
        else {
            return;
        };
        let across = self.seen_from(wrist, |pose| pose.positions[index] - pose.positions[little]);
        let along = self.joint_from_body[wrist] * side.outward;
        self.set(wrist, [side.outward, Vec3::Z], [along, across]);
    }

    /// Mean of one of the chest's body axes seen from a joint: for an arm that never bends.
    fn chest_axis(&self, joint: usize, body_axis: Vec3) -> Vec3 {
        let chest = self.human.chest();
        let axis = self.joint_from_body[chest] * body_axis;
        snapped(
            self.seen_from(joint, |pose| pose.rotations[chest] * axis),
            SNAP_DEGREES,
        )
    }
}
