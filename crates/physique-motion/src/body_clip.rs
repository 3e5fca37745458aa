//! A motion of the body as a clip of its own skeleton, for formats that hold skeletons.

use glam::Quat;
use physique_body::Joint;

use crate::{Conversion, Error, Motion, Skeleton, SkeletonClip, SkeletonJoint, mapping::BodyRest};

impl SkeletonClip {
    /// The clip of a motion on the 22 joints of a body: names as [`Joint::name`], rest pose the
    /// body's, the pelvis moved.
    ///
    /// # Errors
    /// [`Error::Skeleton`] when a rest joint is not finite.
    pub fn from_motion(motion: &Motion, body: &BodyRest) -> Result<Self, Error> {
        let joints = Joint::ALL.into_iter().map(|joint| SkeletonJoint {
            name: joint.name().into(),
            parent: joint.parent().map(Joint::index),
            rest_translation: match joint.parent() {
                Some(_) => body.offset(joint),
                None => body.joint(joint),
            },
            rest_rotation: Quat::IDENTITY,
            end_sites: Vec::new(),
        });
        let pelvis = body.joint(Joint::Pelvis);
        let translations = motion
            .root_translation()
            .iter()
            .map(|&moved| pelvis + moved);
        Self::new(
            Skeleton::new(joints.collect())?,
            motion.frame_rate(),
            Conversion::default(),
            motion.rotations().to_vec(),
            vec![Joint::Pelvis.index()],
            translations.collect(),
        )
    }
}
