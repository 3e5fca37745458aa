//! The joints of a body in kernels: how they hang together, and what features say of them.

use cubecl::prelude::*;
use physique::body::Joint;
use physique_motion::features::{FeatureLayout, FeatureSkeleton};

use super::memory::JOINTS;
use super::swing::Rest;
use super::vectors::{Mat3, Vec3};

/// Numbers of a joint: its place from its parent at rest, where its bones point, whether that is
/// anywhere, and the half turn of bones that are folded straight back.
pub(super) const NUMBERS: usize = 16;

/// Column of the root's height; those of the other joints' positions follow.
pub(super) const HEIGHT: usize = FeatureLayout::of(FeatureSkeleton::HumanMl3d).root_height;

/// Left and right of hips and shoulders, which say where the body faces.
pub(super) const LEFT_HIP: usize = Joint::LeftHip.index();
pub(super) const RIGHT_HIP: usize = Joint::RightHip.index();
pub(super) const LEFT_SHOULDER: usize = Joint::LeftShoulder.index();
pub(super) const RIGHT_SHOULDER: usize = Joint::RightShoulder.index();

/// Position of a joint from its parent, at rest.
#[cube]
pub(super) fn offset(skeleton: &[f32], joint: usize) -> Vec3 {
    vec3(skeleton, NUMBERS * joint)
}

/// Whether a joint is ever swung.
#[cube]
pub(super) fn has_rest(skeleton: &[f32], joint: usize) -> bool {
    skeleton[NUMBERS * joint + 6] > 0.0f32
}

/// Where its bones point at rest.
#[cube]
pub(super) fn rest(skeleton: &[f32], joint: usize) -> Rest {
    let half_turn = NUMBERS * joint + 7;
    Rest {
        direction: vec3(skeleton, NUMBERS * joint + 3),
        half_turn: Mat3 {
            x: vec3(skeleton, half_turn),
            y: vec3(skeleton, half_turn + 3),
            z: vec3(skeleton, half_turn + 6),
        },
    }
}

#[cube]
fn vec3(numbers: &[f32], place: usize) -> Vec3 {
    Vec3::new(numbers[place], numbers[place + 1], numbers[place + 2])
}

/// The parent of a joint but the pelvis.
#[cube]
pub(super) fn parent(hierarchy: &[u32], joint: usize) -> usize {
    hierarchy[joint] as usize
}

/// One of the two joints of the features that a joint lies in the middle of.
#[cube]
pub(super) fn source(hierarchy: &[u32], joint: usize, #[comptime] which: usize) -> usize {
    hierarchy[JOINTS + 2 * joint + which] as usize
}

/// The column of a joint's height; x and z stand before and behind it, but for the root, which has
/// neither.
#[cube]
pub(super) fn column_of_height(joint: usize) -> usize {
    HEIGHT + 3 * joint - select(joint > 0, 1usize, 0usize)
}
