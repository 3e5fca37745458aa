//! A skeleton that is the body's own, as [`from_motion`](crate::SkeletonClip::from_motion) writes it.

use physique_body::Joint;

use super::{MappingOptions, body_rest::BodyRest};
use crate::Skeleton;

/// Joints may lie this far from the body's, in metres: what text files round.
const ROUNDING: f32 = 1e-3;

/// Whether a skeleton is the body's: same names, parents and bones, world axes at rest.
///
/// Its motion needs no fitting: what is guessed for others (soles, twist, ground) would only
/// change it.
pub(super) fn is_own(skeleton: &Skeleton, body: &BodyRest) -> bool {
    Joint::ALL.into_iter().all(|joint| {
        let Some(index) = skeleton.find(joint.name()) else {
            return false;
        };
        let found = &skeleton.joints()[index];
        let parent = found.parent.map(|parent| &skeleton.joints()[parent].name);
        let same_parent = parent.map(String::as_str) == joint.parent().map(Joint::name);
        let level = found.rest_rotation.angle_between(glam::Quat::IDENTITY) < 1e-3;
        // A root's place is that of the clip, not of the body.
        let same_bone = joint.parent().is_none()
            || found.rest_translation.distance(body.offset(joint)) < ROUNDING;
        same_parent && level && same_bone
    })
}

/// Options that leave such a motion as it is.
pub(super) fn unchanged(options: &MappingOptions) -> MappingOptions {
    MappingOptions {
        table: options.table.clone(),
        keep_t_pose: options.keep_t_pose,
        plant_feet: false,
        level_floor: false,
        share_wrist_twist: false,
    }
}
