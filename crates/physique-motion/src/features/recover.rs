//! Features to positions.

use glam::{DVec3, Mat3, Quat, Vec3};

use super::{
    FeatureLayout, FeatureSkeleton, JointPositions, MotionFeatures, Rotation6d,
    quaternion::{matrix, rotate},
    skeleton::links,
};
use crate::Error;

/// Where the root is in a frame, and the rotation that turns its heading towards +Z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root {
    pub(super) towards_z: Quat,
    pub(super) position: Vec3,
}

/// Sums the root's turns and steps up. Every motion starts above the origin and faces +Z.
pub(super) fn root_path(features: &MotionFeatures) -> Vec<Root> {
    let layout = features.layout();
    // PyTorch's cumsum adds 32-bit numbers in 64 bits: so do we.
    let (mut half_turn, mut place) = (0.0_f64, DVec3::ZERO);
    let mut last_row: Option<&[f32]> = None;
    let roots = features.rows().map(|row| {
        if let Some(last) = last_row {
            half_turn += f64::from(last[layout.root_turn]);
        }
        let (sine, cosine) = (half_turn as f32).sin_cos();
        let towards_z = Quat::from_xyzw(0.0, sine, 0.0, cosine);
        if let Some(last) = last_row {
            let step = &last[layout.root_velocity.clone()];
            place += rotate(towards_z.conjugate(), Vec3::new(step[0], 0.0, step[1])).as_dvec3();
        }
        last_row = Some(row);
        let position = Vec3::new(place.x as f32, row[layout.root_height], place.z as f32);
        Root {
            towards_z,
            position,
        }
    });
    roots.collect()
}

/// Joint positions from the positions in the features (RIC), as all published motions are made.
///
/// # Errors
/// [`Error::NotFinite`] when sums overflow.
pub fn recover_from_positions(features: &MotionFeatures) -> Result<JointPositions, Error> {
    let skeleton = features.skeleton();
    let columns = features.layout().positions;
    let mut positions = Vec::with_capacity(features.frame_count() * skeleton.joint_count());
    for (row, root) in features.rows().zip(root_path(features)) {
        let from_root = root.towards_z.conjugate();
        let under_root = Vec3::new(root.position.x, 0.0, root.position.z);
        positions.push(root.position);
        for &joint in row[columns.clone()].as_chunks().0 {
            positions.push(rotate(from_root, Vec3::from_array(joint)) + under_root);
        }
    }
    JointPositions::new(features.frame_rate(), skeleton, positions)
}

/// Joint positions from the rotations in the features and the bones of `offsets`, `[joints]`
/// vectors from the parent; [`FeatureSkeleton::offsets`] are the data set's.
///
/// Once the heading has passed half a turn, the reference's turn has the wrong sign for one frame
/// and this recovery drifts away from [`recover_from_positions`]: a fault of the features.
///
/// # Errors
/// [`Error::NoRotation`] for six numbers that are no rotation; [`Error::PositionCount`] unless
/// there is an offset for each joint; [`Error::NotFinite`] when sums overflow.
pub fn recover_from_rotations(
    features: &MotionFeatures,
    offsets: &[Vec3],
) -> Result<JointPositions, Error> {
    let skeleton = features.skeleton();
    if offsets.len() != skeleton.joint_count() {
        let joints = skeleton.joint_count();
        return Err(Error::PositionCount {
            joints,
            found: offsets.len(),
        });
    }
    let mut positions = Vec::with_capacity(features.frame_count() * skeleton.joint_count());
    for (frame, (row, root)) in features.rows().zip(root_path(features)).enumerate() {
        let local = local_rotations(skeleton, row, frame)?;
        let start = positions.len();
        positions.resize(start + skeleton.joint_count(), root.position);
        let joints = &mut positions[start..];
        for chain in skeleton.definition().chains {
            let mut above = matrix(root.towards_z);
            for [parent, joint] in links(chain) {
                above *= local[joint - 1];
                joints[joint] = above * offsets[joint] + joints[parent];
            }
        }
    }
    JointPositions::new(features.frame_rate(), skeleton, positions)
}

/// Rotations of joints 1 and up.
fn local_rotations(
    skeleton: FeatureSkeleton,
    row: &[f32],
    frame: usize,
) -> Result<Vec<Mat3>, Error> {
    let numbers = row[FeatureLayout::of(skeleton).rotations].as_chunks().0;
    let matrices = numbers.iter().enumerate().map(|(index, &numbers)| {
        Rotation6d::columns(numbers)
            .to_matrix()
            .ok_or_else(|| Error::NoRotation {
                frame,
                joint: skeleton.joint_name(index + 1).unwrap_or_default(),
            })
    });
    matrices.collect()
}
