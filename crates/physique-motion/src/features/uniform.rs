//! Bringing a motion to the data set's one skeleton, onto the floor, to the origin, facing +Z.

use glam::Vec3;

use super::{
    BoneRotations, FeatureSkeleton, Heading, JointPositions,
    heading::{self, facing},
    quaternion::{between, rotate},
};
use crate::Error;

/// The motion as it is before features are taken of it: the data set's bone lengths, the lowest
/// joint of all frames at height 0, the root of the first frame above the origin and facing +Z.
///
/// # Errors
/// [`Error::NoHeading`] and [`Error::NoBone`] as [`BoneRotations::from_positions`].
pub fn canonicalise(motion: &JointPositions) -> Result<JointPositions, Error> {
    let mut positions = with_uniform_bones(motion)?;
    let lowest = positions
        .iter()
        .fold(f32::INFINITY, |lowest, joint| lowest.min(joint.y));
    for joint in &mut positions {
        joint.y -= lowest;
    }
    placed(motion, positions)
}

/// A window of a motion that stands on its floor already, as [`canonicalise`] leaves it: heights
/// stay, for a window in mid-air has no foot on the ground; all else is done anew, so that the
/// window begins at the origin facing +Z. The mirror image of such a motion is welcome, too.
///
/// # Errors
/// As [`canonicalise`].
pub fn canonicalise_window(motion: &JointPositions) -> Result<JointPositions, Error> {
    placed(motion, with_uniform_bones(motion)?)
}

/// The positions from the origin on, facing +Z.
fn placed(motion: &JointPositions, mut positions: Vec<Vec3>) -> Result<JointPositions, Error> {
    let start = Vec3::new(positions[0].x, 0.0, positions[0].z);
    for joint in &mut positions {
        *joint -= start;
    }
    let forward = facing(motion.skeleton(), &positions).and_then(Vec3::try_normalize);
    let turn = between(forward.ok_or(heading::unknown(0))?, Vec3::Z);
    for joint in &mut positions {
        *joint = rotate(turn, *joint);
    }
    motion.with_positions(positions)
}

/// Keeps the directions of all bones and gives them the data set's lengths.
fn with_uniform_bones(motion: &JointPositions) -> Result<Vec<Vec3>, Error> {
    let skeleton = motion.skeleton();
    let scale = leg_scale(skeleton, motion.frame(0));
    let roots: Vec<Vec3> = motion.frames().map(|joints| joints[0] * scale).collect();
    let rotations = BoneRotations::from_positions(motion, Heading::EachFrame)?;
    Ok(rotations.positions(&skeleton.offsets(), &roots))
}

/// Thigh and shin of the data set's skeleton over those of a frame, of the right leg only.
fn leg_scale(skeleton: FeatureSkeleton, joints: &[Vec3]) -> f32 {
    let definition = skeleton.definition();
    let lengths = definition.leg.map(|joint| {
        let above = skeleton
            .bones()
            .find(|bone| bone[1] == joint)
            .map_or(joint, |bone| bone[0]);
        joints[joint].distance(joints[above])
    });
    let target = definition.leg.map(|joint| definition.bone_lengths[joint]);
    (target[0] + target[1]) / (lengths[0] + lengths[1])
}
