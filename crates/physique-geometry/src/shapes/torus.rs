use std::f64::consts::TAU;

use glam::Vec3;

use super::Mesh;

/// Measures of a [`torus`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Torus {
    /// Radius of the circle that the tube follows, in metres.
    pub ring_radius: f32,
    /// Radius of the tube, in metres. May exceed the ring radius: the torus then overlaps itself.
    pub tube_radius: f32,
    /// Segments around the ring (3 to 4,096).
    pub ring_segments: u32,
    /// Segments around the tube (3 to 4,096).
    pub tube_segments: u32,
}

/// A torus around the y axis with all vertices on the ideal surface, of `2 * ring_segments *
/// tube_segments` triangles. Segment counts are clamped to 3 to 4,096.
#[must_use]
pub fn torus(measures: Torus) -> Mesh {
    let rings = measures.ring_segments.clamp(3, 4096);
    let tubes = measures.tube_segments.clamp(3, 4096);
    let (ring_radius, tube_radius) = (
        f64::from(measures.ring_radius),
        f64::from(measures.tube_radius),
    );
    let mut positions = Vec::new();
    let mut corners = Vec::new();
    for ring in 0..rings {
        let (ring_sin, ring_cos) = (TAU * f64::from(ring) / f64::from(rings)).sin_cos();
        for tube in 0..tubes {
            let (tube_sin, tube_cos) = (TAU * f64::from(tube) / f64::from(tubes)).sin_cos();
            let from_axis = ring_radius + tube_radius * tube_cos;
            let (x, y, z) = (
                from_axis * ring_cos,
                tube_radius * tube_sin,
                from_axis * ring_sin,
            );
            positions.push(Vec3::new(x as f32, y as f32, z as f32));

            let at = |ring: u32, tube: u32| ring % rings * tubes + tube % tubes;
            let (a, b) = (at(ring, tube), at(ring + 1, tube));
            let (c, d) = (at(ring + 1, tube + 1), at(ring, tube + 1));
            corners.extend([[a, d, c], [a, c, b]]);
        }
    }
    Mesh::made(positions, &corners)
}
