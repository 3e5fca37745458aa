//! Where a body faces, in the two ways of the pipeline.

use glam::Vec3;

use super::FeatureSkeleton;
use crate::Error;

/// Horizontal direction in which the body faces in one frame, by hips and shoulders.
pub(super) fn facing(skeleton: FeatureSkeleton, joints: &[Vec3]) -> Option<Vec3> {
    let [right_hip, left_hip, right_shoulder, left_shoulder] = skeleton.definition().face;
    let hips = joints[right_hip] - joints[left_hip];
    across_to_forward(hips + (joints[right_shoulder] - joints[left_shoulder]))
}

/// The heading that the features' rotations use, not of unit length.
///
/// The reference exchanges the two hips when it unpacks its list of face joints, so that hips
/// count against the shoulders: up to some degrees off where the two differ. All published
/// features were made so.
pub(super) fn facing_with_hips_exchanged(
    skeleton: FeatureSkeleton,
    joints: &[Vec3],
) -> Option<Vec3> {
    let [right_hip, left_hip, right_shoulder, left_shoulder] = skeleton.definition().face;
    let hips = joints[left_hip] - joints[right_hip];
    across_to_forward(hips + (joints[right_shoulder] - joints[left_shoulder]))
}

/// From the direction across the body, right hip minus left, to the one it faces.
fn across_to_forward(across: Vec3) -> Option<Vec3> {
    let forward = Vec3::Y.cross(across.try_normalize()?);
    (forward.length_squared() > 0.0).then_some(forward)
}

/// The error for a frame in which nobody can say where the body faces.
pub(super) const fn unknown(frame: usize) -> Error {
    Error::NoHeading { frame }
}
