//! KIT's 21 joints as SMPL's 22.

use glam::{DVec3, Vec3};

use super::{FeatureSkeleton, JointPositions};
use crate::Error;

/// By SMPL joint: the two KIT joints that it lies in the middle of, or one of them twice.
#[rustfmt::skip]
const SOURCES: [[usize; 2]; 22] = [
    [0, 0], [11, 11], [16, 16], [1, 1], [12, 12], [17, 17], [1, 2], [13, 13], [18, 18], [2, 2],
    [15, 15], [20, 20], [3, 3], [2, 5], [2, 8], [4, 4], [5, 5], [8, 8], [6, 6], [9, 9], [7, 7],
    [10, 10],
];

/// KIT is mirrored: its left is at -X.
const HANDED: DVec3 = DVec3::new(-1.0, 1.0, 1.0);

/// SMPL's joints from KIT's of one frame, unmirrored, still in KIT's unit.
///
/// The spine's middle and the collars are put half-way between neighbours, the heels are dropped.
///
/// # Errors
/// [`Error::PositionCount`] unless there are 21 joints.
pub fn smpl_from_kit(joints: &[Vec3]) -> Result<[Vec3; 22], Error> {
    let joints: &[Vec3; 21] = joints.try_into().map_err(|_| count_error(joints.len()))?;
    let middle = |[a, b]: [usize; 2]| (joints[a] + joints[b]) / 2.0 * HANDED.as_vec3();
    Ok(SOURCES.map(middle))
}

/// The gradient by KIT's joints from the one by SMPL's: the transpose of [`smpl_from_kit`].
pub fn smpl_from_kit_gradient(by_smpl: &[DVec3; 22]) -> [DVec3; 21] {
    let mut by_kit = [DVec3::ZERO; 21];
    for (sources, gradient) in SOURCES.iter().zip(by_smpl) {
        for &joint in sources {
            by_kit[joint] += *gradient / 2.0 * HANDED;
        }
    }
    by_kit
}

impl JointPositions {
    /// This motion with SMPL's 22 joints: as it is, or by [`smpl_from_kit`].
    ///
    /// Lengths are not scaled: KIT's stay in its own unit.
    ///
    /// # Errors
    /// [`Error::NotFinite`] when sums of huge numbers overflow.
    pub fn to_smpl_joints(&self) -> Result<Self, Error> {
        if self.skeleton() == FeatureSkeleton::HumanMl3d {
            return Ok(self.clone());
        }
        let mut positions = Vec::with_capacity(self.frame_count() * 22);
        for joints in self.frames() {
            positions.extend(smpl_from_kit(joints)?);
        }
        Self::new(self.frame_rate(), FeatureSkeleton::HumanMl3d, positions)
    }
}

const fn count_error(found: usize) -> Error {
    Error::PositionCount { joints: 21, found }
}
