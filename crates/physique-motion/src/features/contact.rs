//! Which joints of the feet rest.

use glam::Vec3;

use super::FeatureSkeleton;

/// 1 for each of the four joints of the feet that moves less than the data set's threshold to the
/// next frame, else 0. Height does not matter.
pub(super) fn contacts(skeleton: FeatureSkeleton, now: &[Vec3], next: &[Vec3]) -> [f32; 4] {
    let definition = skeleton.definition();
    definition.feet.map(|joint| {
        let rests = now[joint].distance_squared(next[joint]) < definition.contact_threshold;
        f32::from(u8::from(rests))
    })
}
