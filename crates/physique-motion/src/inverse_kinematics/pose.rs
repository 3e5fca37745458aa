//! One frame on its way: world rotations, and where they put the joints.

use glam::{DMat3, DQuat, Quat, Vec3};
use physique_body::Joint::{
    self, Head, LeftCollar, LeftHip, LeftShoulder, Neck, Pelvis, RightCollar, RightHip,
    RightShoulder, Spine1, Spine2, Spine3,
};

use super::{
    rigid::{aim, best_rotation},
    source_bones::SourceBones,
};

/// Ends of the bones that the pelvis carries.
pub(super) const PELVIS_BONES: [Joint; 3] = [LeftHip, RightHip, Spine1];
/// Ends of the bones that the chest carries.
pub(super) const CHEST_BONES: [Joint; 3] = [Neck, LeftCollar, RightCollar];

/// World rotations and positions of all joints.
pub(super) struct SolvedPose {
    pub(super) world: [Quat; Joint::COUNT],
    pub(super) positions: [Vec3; Joint::COUNT],
}

impl SolvedPose {
    /// Solves pelvis, spine, chest, neck, head and collars; arms and legs follow.
    pub(super) fn trunk(bones: &SourceBones, wanted: &[Vec3; Joint::COUNT]) -> Self {
        let mut pose = Self {
            world: [Quat::IDENTITY; Joint::COUNT],
            positions: [wanted[Pelvis.index()]; Joint::COUNT],
        };
        let at = |joint: Joint| wanted[joint.index()];
        let pelvis = pose.fit(bones, wanted, Pelvis, PELVIS_BONES, upright(wanted));
        // Where the chest will be, up to what the spine below it lacks in length.
        let pairs = CHEST_BONES.map(|end| (bones.offset(end), at(end) - at(Spine3)));
        let chest = best_rotation(&pairs, pelvis);
        for joint in PELVIS_BONES {
            pose.put(bones, joint);
        }
        for (joint, next, share) in [(Spine1, Spine2, 1.0 / 3.0), (Spine2, Spine3, 2.0 / 3.0)] {
            let between = pelvis.slerp(chest, share);
            let bone = at(next) - pose.positions[joint.index()];
            pose.world[joint.index()] = aim(between, bones.offset(next), bone);
            pose.put(bones, next);
        }
        let chest = pose.fit(bones, wanted, Spine3, CHEST_BONES, chest);
        for joint in CHEST_BONES {
            pose.put(bones, joint);
        }
        for (joint, next) in [
            (Neck, Head),
            (LeftCollar, LeftShoulder),
            (RightCollar, RightShoulder),
        ] {
            let bone = at(next) - pose.positions[joint.index()];
            pose.world[joint.index()] = aim(chest, bones.offset(next), bone);
            pose.put(bones, next);
        }
        pose.world[Head.index()] = pose.world[Neck.index()];
        pose
    }

    /// The pose of local rotations that were found elsewhere.
    pub(super) fn of_rotations(
        bones: &SourceBones,
        root: Vec3,
        local: &[DMat3; Joint::COUNT],
    ) -> Self {
        let mut pose = Self {
            world: [Quat::IDENTITY; Joint::COUNT],
            positions: [root; Joint::COUNT],
        };
        for joint in Joint::ALL {
            let above = joint.parent().map(|parent| pose.world[parent.index()]);
            let turn = DQuat::from_mat3(&local[joint.index()]).as_quat();
            pose.world[joint.index()] = (above.unwrap_or_default() * turn).normalize();
            pose.put(bones, joint);
        }
        pose
    }

    /// Turns a joint so that its bones come closest to the joints wanted.
    fn fit(
        &mut self,
        bones: &SourceBones,
        wanted: &[Vec3; Joint::COUNT],
        joint: Joint,
        ends: [Joint; 3],
        start: Quat,
    ) -> Quat {
        let origin = self.positions[joint.index()];
        let pairs = ends.map(|end| (bones.offset(end), wanted[end.index()] - origin));
        let rotation = best_rotation(&pairs, start);
        self.world[joint.index()] = rotation;
        rotation
    }

    /// Puts a joint where its parent's rotation takes it.
    pub(super) fn put(&mut self, bones: &SourceBones, joint: Joint) {
        if let Some(parent) = joint.parent() {
            let bone = self.world[parent.index()] * bones.offset(joint);
            self.positions[joint.index()] = self.positions[parent.index()] + bone;
        }
    }

    /// `parent_from_joint` of all joints.
    pub(super) fn local_rotations(&self) -> [Quat; Joint::COUNT] {
        Joint::ALL.map(|joint| {
            let world = self.world[joint.index()];
            joint.parent().map_or(world, |parent| {
                (self.world[parent.index()].inverse() * world).normalize()
            })
        })
    }
}

/// A rotation of the pelvis to start from: left by the hips, up by the spine.
pub(super) fn upright(wanted: &[Vec3]) -> Quat {
    let at = |joint: Joint| wanted[joint.index()];
    let left = (at(LeftHip) - at(RightHip))
        .try_normalize()
        .unwrap_or(Vec3::X);
    let up = (at(Spine1) - at(Pelvis)).reject_from_normalized(left);
    let up = up
        .try_normalize()
        .unwrap_or_else(|| left.any_orthonormal_vector());
    Quat::from_mat3(&glam::Mat3::from_cols(left, up, left.cross(up))).normalize()
}
