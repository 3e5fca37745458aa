//! KIT's 21 joints as SMPL's 22.

use glam::{DVec3, Vec3};

use super::{FeatureSkeleton, JointPositions};
use crate::Error;

/// By SMPL joint: the two KIT joints that it lies in the middle of, or one of them twice.
#[rustfmt::skip]
pub const KIT_SOURCES: [[usize; 2]; 22] = [
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
    Ok(KIT_SOURCES.map(middle))
}

/// The gradient by KIT's joints from the one by SMPL's: the transpose of [`smpl_from_kit`].
pub fn smpl_from_kit_gradient(by_smpl: &[DVec3; 22]) -> [DVec3; 21] {
    let mut by_kit = [DVec3::ZERO; 21];
    for (sources, gradient) in KIT_SOURCES.iter().zip(by_smpl) {
        for &joint in sources {
            by_kit[joint] += *gradient / 2.0 * HANDED;
        }
    }
    by_kit
}

/// Rest of the ankle's bone to LMrot, over that to the toes: the two lengths of KIT's feet.
const MIDFOOT: f32 = 30.27 / (30.27 + 56.29);

/// KIT's joints from SMPL's of one frame, mirrored as KIT's are, in the unit they come in.
///
/// KIT knows no collars and one spine joint less; those of SMPL are dropped. The middle of the
/// foot, which SMPL does not know, is put between ankle and toes, where KIT's bone lengths have it.
///
/// # Errors
/// [`Error::PositionCount`] unless there are 22 joints.
pub fn kit_from_smpl(joints: &[Vec3]) -> Result<[Vec3; 21], Error> {
    let joints: &[Vec3; 22] = joints.try_into().map_err(|_| Error::PositionCount {
        joints: 22,
        found: joints.len(),
    })?;
    let [left_ankle, right_ankle, left_toes, right_toes] = [7, 8, 10, 11].map(|j| joints[j]);
    let kit = [
        joints[0],
        joints[3],
        joints[9],
        joints[12],
        joints[15],
        joints[16],
        joints[18],
        joints[20],
        joints[17],
        joints[19],
        joints[21],
        joints[1],
        joints[4],
        left_ankle,
        left_ankle.lerp(left_toes, MIDFOOT),
        left_toes,
        joints[2],
        joints[5],
        right_ankle,
        right_ankle.lerp(right_toes, MIDFOOT),
        right_toes,
    ];
    Ok(kit.map(|joint| joint * HANDED.as_vec3()))
}

impl JointPositions {
    /// This motion with KIT's 21 joints: as it is, or by [`kit_from_smpl`].
    ///
    /// Lengths are not scaled: metres stay metres, until [`super::extract`] brings them to the
    /// data set's bones.
    ///
    /// # Errors
    /// None for a sound motion.
    pub fn to_kit_joints(&self) -> Result<Self, Error> {
        if self.skeleton() == FeatureSkeleton::Kit {
            return Ok(self.clone());
        }
        let mut positions = Vec::with_capacity(self.frame_count() * 21);
        for joints in self.frames() {
            positions.extend(kit_from_smpl(joints)?);
        }
        Self::new(self.frame_rate(), FeatureSkeleton::Kit, positions)
    }

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
