//! Joint positions of a motion of the body.

use glam::Quat;
use physique_body::Joint;

use super::{FeatureSkeleton, JointPositions};
use crate::{Error, Motion, mapping::BodyRest};

impl JointPositions {
    /// Where the 22 joints of `body` are in every frame of `motion`, in metres in the world.
    ///
    /// # Errors
    /// [`Error::NoFrames`]; [`Error::NotFinite`] when sums of huge numbers overflow.
    pub fn from_motion(motion: &Motion, body: &BodyRest) -> Result<Self, Error> {
        let mut positions = Vec::with_capacity(motion.frame_count() * Joint::COUNT);
        for frame in 0..motion.frame_count() {
            let root = body.joint(Joint::Pelvis) + motion.root_translation()[frame];
            let mut world = [Quat::IDENTITY; Joint::COUNT];
            let start = positions.len();
            for (joint, &local) in Joint::ALL.iter().zip(motion.frame_rotations(frame)) {
                let (rotation, position) = match joint.parent().map(Joint::index) {
                    None => (local, root),
                    Some(parent) => (
                        (world[parent] * local).normalize(),
                        positions[start + parent] + world[parent] * body.offset(*joint),
                    ),
                };
                world[joint.index()] = rotation;
                positions.push(position);
            }
        }
        Self::new(motion.frame_rate(), FeatureSkeleton::HumanMl3d, positions)
    }
}
