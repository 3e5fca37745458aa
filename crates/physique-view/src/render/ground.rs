//! The floor: a plane with a grid that fades, and the shadows on it.

use glam::{Vec2, Vec3};

use super::projection::{Ray, ViewTransform};
use super::shadow::GroundShadow;
use crate::palette;

/// The floor to draw: a horizontal disc that fades towards its rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Its height: y in metres.
    pub height: f32,
    /// Its middle: x and z in metres.
    pub centre: [f32; 2],
    /// Where it has faded away, in metres from the middle.
    pub radius: f32,
}

impl Ground {
    /// The floor at y = 0 around the origin, 2.5 m in radius.
    #[must_use]
    pub fn new() -> Self {
        Self {
            height: 0.0,
            centre: [0.0, 0.0],
            radius: 2.5,
        }
    }

    /// The distance along a ray at which it meets the plane from above.
    pub(super) fn hit(&self, ray: &Ray) -> Option<f32> {
        if ray.direction.y > -1e-5 {
            return None;
        }
        let distance = (self.height - ray.origin.y) / ray.direction.y;
        (distance > 0.0).then_some(distance)
    }

    /// Colour and opacity of the floor where a ray through a pixel meets it, `distance` along.
    pub(super) fn shade(
        &self,
        view: &ViewTransform,
        ray: &Ray,
        distance: f32,
        shadow: Option<&GroundShadow>,
    ) -> (Vec3, f32) {
        let point = ray.origin + ray.direction * distance;
        let from_centre = Vec2::new(point.x - self.centre[0], point.z - self.centre[1]).length();
        if from_centre >= self.radius {
            return (Vec3::ZERO, 0.0);
        }
        let fade = 1.0 - smoothstep(0.35, 1.0, from_centre / self.radius);
        // A pixel's footprint: a metre across the line of sight, stretched along it by the slant.
        let across = view.metres_per_pixel(distance);
        let sight = ray.direction.normalize_or_zero();
        let stretch = 1.0 / (-sight.y).max(0.02);
        let level = Vec3::new(sight.x, 0.0, sight.z);
        let along = level.normalize_or_zero().abs();
        let footprint_x = across * (1.0 - along.x + along.x * stretch);
        let footprint_z = across * (1.0 - along.z + along.z * stretch);
        let lines = |spacing: f32, width: f32| {
            let x = line_coverage(point.x, footprint_x, spacing, width.max(across * 0.9));
            let z = line_coverage(point.z, footprint_z, spacing, width.max(across * 0.9));
            x + z - x * z
        };
        let floor = palette::FLOOR.linear();
        let line = palette::GRID.linear();
        let minor = 0.30 * lines(0.25, 0.003);
        let major = 0.75 * lines(1.0, 0.005);
        let colour = floor.lerp(line, minor.max(major));
        let light = 1.0 - shadow.map_or(0.0, |shadow| shadow.at(point.x, point.z));
        (colour * light, fade)
    }
}

impl Default for Ground {
    fn default() -> Self {
        Self::new()
    }
}

fn smoothstep(low: f32, high: f32, value: f32) -> f32 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The share of an interval `footprint` wide around `position` that lies on lines `width` wide,
/// one every `spacing` metres: exact, so a grid seen from far turns grey instead of flickering.
fn line_coverage(position: f32, footprint: f32, spacing: f32, width: f32) -> f32 {
    let width = width.min(spacing);
    // The length of line from zero to `x`.
    let length = |x: f32| {
        let shifted = x + width * 0.5;
        let whole = floor(shifted / spacing);
        whole * width + (shifted - whole * spacing).min(width)
    };
    let half = footprint.max(1e-6) * 0.5;
    ((length(position + half) - length(position - half)) / (2.0 * half)).clamp(0.0, 1.0)
}

/// `f32::floor` for moderate values: a library call without SSE 4.1, and this runs for each pixel.
pub(super) fn floor(value: f32) -> f32 {
    let whole = value as i32 as f32;
    if whole > value { whole - 1.0 } else { whole }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_footprint_sees_the_lines_share() {
        let coverage = line_coverage(0.123, 8.0, 1.0, 0.1);
        assert!((coverage - 0.1).abs() < 1e-3, "{coverage}");
    }

    #[test]
    fn a_narrow_footprint_sees_line_or_floor() {
        assert!((line_coverage(3.0, 0.001, 1.0, 0.1) - 1.0).abs() < 1e-3);
        assert!(line_coverage(-2.5, 0.001, 1.0, 0.1) < 1e-3);
        // Half on the line's edge.
        assert!((line_coverage(2.05, 0.02, 1.0, 0.1) - 0.5).abs() < 1e-3);
    }
}
