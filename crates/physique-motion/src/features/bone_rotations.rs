//! From joint positions to a rotation for every bone and back, as the features define them.

use glam::{Quat, Vec3};

use super::{
    FeatureSkeleton, JointPositions,
    heading::{self, facing_with_hips_exchanged},
    quaternion::{between, multiply, rotate},
    skeleton::links,
    smoothing::gaussian,
};
use crate::Error;

/// How the root's rotation is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// From each frame alone.
    EachFrame,
    /// Smoothed over time with a Gaussian of 20 frames, as in the features.
    Smoothed,
}

/// Standard deviation of the filter on the heading, in frames.
const HEADING_SIGMA: f64 = 20.0;

/// Local rotations `[frames][joints]` of the features' skeleton.
///
/// They differ from a body's rotations: the rotation of a bone is stored at its **end**, the root's
/// turns the body *towards* +Z (the inverse of its heading), every chain starts from the root, even
/// those that hang at the chest, and no bone twists.
#[derive(Clone, Debug, PartialEq)]
pub struct BoneRotations {
    skeleton: FeatureSkeleton,
    rotations: Vec<Quat>,
}

impl BoneRotations {
    /// The rotations that point each bone where it is.
    ///
    /// The root of the first frame is the identity whatever its heading, as in the reference.
    ///
    /// # Errors
    /// [`Error::NoHeading`] when hips and shoulders do not tell where the body faces;
    /// [`Error::NoBone`] when two joints of a bone are in one place.
    pub fn from_positions(motion: &JointPositions, heading: Heading) -> Result<Self, Error> {
        let skeleton = motion.skeleton();
        let directions = skeleton.definition().directions;
        let roots = root_rotations(motion, heading)?;
        let mut rotations = vec![Quat::IDENTITY; motion.positions().len()];
        let frames = rotations.chunks_exact_mut(skeleton.joint_count());
        for (frame, ((local, joints), root)) in frames.zip(motion.frames()).zip(roots).enumerate() {
            local[0] = root;
            for chain in skeleton.definition().chains {
                let mut above = root;
                for [parent, joint] in links(chain) {
                    let bone = joints[joint] - joints[parent];
                    let bone = bone.try_normalize().ok_or_else(|| Error::NoBone {
                        frame,
                        parent: skeleton.joint_name(parent).unwrap_or_default(),
                        joint: skeleton.joint_name(joint).unwrap_or_default(),
                    })?;
                    let turn = between(directions[joint], bone);
                    local[joint] = multiply(above.conjugate(), turn);
                    above = multiply(above, local[joint]);
                }
            }
        }
        Ok(Self {
            skeleton,
            rotations,
        })
    }

    /// `[frames][joints]` rotations, flat.
    pub fn rotations(&self) -> &[Quat] {
        &self.rotations
    }

    /// The joints of each frame in turn; the first is the root's.
    pub fn frames(&self) -> std::slice::ChunksExact<'_, Quat> {
        self.rotations.chunks_exact(self.skeleton.joint_count())
    }

    /// Positions of the joints for bones of these lengths and directions, and roots at
    /// `root_positions`; flat `[frames][joints]`. The inverse of [`Self::from_positions`].
    pub fn positions(&self, offsets: &[Vec3], root_positions: &[Vec3]) -> Vec<Vec3> {
        let mut positions = vec![Vec3::ZERO; self.rotations.len()];
        let frames = positions.chunks_exact_mut(self.skeleton.joint_count());
        for ((joints, local), &root) in frames.zip(self.frames()).zip(root_positions) {
            joints[0] = root;
            for chain in self.skeleton.definition().chains {
                let mut above = local[0];
                for [parent, joint] in links(chain) {
                    above = multiply(above, local[joint]);
                    joints[joint] = rotate(above, offsets[joint]) + joints[parent];
                }
            }
        }
        positions
    }
}

fn root_rotations(motion: &JointPositions, heading: Heading) -> Result<Vec<Quat>, Error> {
    let facing = motion.frames().enumerate().map(|(frame, joints)| {
        facing_with_hips_exchanged(motion.skeleton(), joints).ok_or(heading::unknown(frame))
    });
    let mut forward = facing.collect::<Result<Vec<Vec3>, Error>>()?;
    if heading == Heading::Smoothed {
        forward = gaussian(&forward, HEADING_SIGMA);
    }
    let towards_z = forward.iter().enumerate().map(|(frame, forward)| {
        let forward = forward.try_normalize().ok_or(heading::unknown(frame))?;
        Ok(if frame == 0 {
            Quat::IDENTITY
        } else {
            between(forward, Vec3::Z)
        })
    });
    towards_z.collect()
}
