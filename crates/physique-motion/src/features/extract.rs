//! Positions to features.

use glam::Vec3;

use super::{
    BoneRotations, Heading, JointPositions, MotionFeatures, Rotation6d,
    contact::contacts,
    quaternion::{matrix, multiply, rotate},
    uniform::{canonicalise, canonicalise_window},
};
use crate::Error;

/// The features of a motion of `n` frames: `n - 1` rows, for steps need a next frame.
///
/// Equal to the published pipeline within 1e-5 (HumanML3D, metres) and 1e-2 (KIT, its units). The
/// motion is first brought to the common skeleton and place by [`canonicalise`].
///
/// # Errors
/// [`Error::NoFrames`] for fewer than two frames; [`Error::NoHeading`] and [`Error::NoBone`].
pub fn extract(motion: &JointPositions) -> Result<MotionFeatures, Error> {
    features_of(&canonicalise(motion)?)
}

/// The features of a window of a motion that [`canonicalise`] brought to its floor, or of the mirror
/// image of one: as [`extract`], but heights stay.
///
/// Rotations of the hips and the spine depend on how the first frame faces, so that rows cut out of
/// the features of a longer motion disagree with their own positions by some 2 cm; these do not.
///
/// # Errors
/// As [`extract`].
pub fn extract_window(motion: &JointPositions) -> Result<MotionFeatures, Error> {
    features_of(&canonicalise_window(motion)?)
}

/// The features of a motion that is in its place.
fn features_of(motion: &JointPositions) -> Result<MotionFeatures, Error> {
    let skeleton = motion.skeleton();
    let bones = BoneRotations::from_positions(motion, Heading::Smoothed)?;
    let mut values = Vec::with_capacity(motion.frame_count() * skeleton.feature_count());
    let now = motion.frames().zip(bones.frames());
    let next = motion.frames().zip(bones.frames()).skip(1);
    for ((joints, rotations), (next_joints, next_rotations)) in now.zip(next) {
        let (root, next_root) = (rotations[0], next_rotations[0]);
        let turn = multiply(next_root, root.conjugate());
        // The step is seen from the heading at its end; those of the joints, below, at its start.
        let step = rotate(next_root, next_joints[0] - joints[0]);
        // The arcsine of a quaternion's component: half the angle.
        values.extend([turn.y.clamp(-1.0, 1.0).asin(), step.x, step.z, joints[0].y]);
        let under_root = Vec3::new(joints[0].x, 0.0, joints[0].z);
        for &joint in &joints[1..] {
            values.extend(rotate(root, joint - under_root).to_array());
        }
        for &rotation in &rotations[1..] {
            values.extend(Rotation6d::columns_of(&matrix(rotation)));
        }
        for (&joint, &next) in joints.iter().zip(next_joints) {
            values.extend(rotate(root, next - joint).to_array());
        }
        values.extend(contacts(skeleton, joints, next_joints));
    }
    MotionFeatures::new(motion.frame_rate(), skeleton, values)
}
