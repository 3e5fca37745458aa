//! The lights, and how skin answers them.

use glam::Vec3;

/// Towards the key light: high, before the body and at its left. Unit length.
pub(crate) const KEY_DIRECTION: Vec3 = Vec3::new(0.36, 0.8, 0.48);

/// Linear light from sky and floor, from the key light, and from beside the camera.
const SKY: Vec3 = Vec3::new(0.43, 0.455, 0.50);
const BOUNCE: Vec3 = Vec3::new(0.27, 0.255, 0.24);
const KEY: Vec3 = Vec3::new(0.50, 0.48, 0.44);
const FILL: Vec3 = Vec3::new(0.29, 0.285, 0.28);

/// The light that leaves a surface towards the viewer, linear.
///
/// `normal` and `towards_eye` are of unit length, `albedo` is linear.
pub(crate) fn shade(albedo: Vec3, normal: Vec3, towards_eye: Vec3) -> Vec3 {
    let facing = normal.dot(towards_eye).clamp(0.0, 1.0);
    let ambient = BOUNCE.lerp(SKY, normal.y * 0.5 + 0.5);
    // Wrapped a little around the edge of night, as light is in skin.
    let key = ((normal.dot(KEY_DIRECTION) + 0.15) / 1.15).max(0.0);
    let half = (KEY_DIRECTION + towards_eye).normalize_or_zero();
    let gloss = 0.045 * normal.dot(half).max(0.0).powi(24);
    let rim = 0.16 * (1.0 - facing).powi(4) * (0.4 + 0.6 * normal.y.max(0.0));
    // Surface seen at a slant is a little darker: outlines part limbs of the same colour.
    let outline = 0.62 + 0.38 * (facing * 2.2).min(1.0);
    let light = ambient + KEY * key + FILL * facing;
    albedo * light * outline + Vec3::splat(gloss + rim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_key_direction_is_a_unit_vector_from_above() {
        assert!(KEY_DIRECTION.is_normalized());
        assert!(KEY_DIRECTION.dot(Vec3::Y) > 0.5);
    }

    #[test]
    fn surface_towards_the_light_is_brighter() {
        let albedo = Vec3::splat(0.5);
        let towards = shade(albedo, KEY_DIRECTION, Vec3::Z);
        let away = shade(albedo, Vec3::new(-0.6, -0.6, 0.53).normalize(), Vec3::Z);
        assert!(towards.min_element() > away.max_element() * 1.5);
    }
}
