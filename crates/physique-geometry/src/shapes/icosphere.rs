use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::Mesh;

/// A sphere of `20 * 4^subdivisions` triangles around the origin: an icosahedron whose triangles are
/// split in four, again and again, their new vertices moved onto the sphere. All vertices lie on the
/// sphere, so that the mesh holds less than the ball (at four subdivisions 0.3 % less).
/// More than 9 subdivisions (5 million triangles) are cut to 9.
#[must_use]
pub fn icosphere(radius: f32, subdivisions: u32) -> Mesh {
    let (mut points, mut corners) = icosahedron();
    for _ in 0..subdivisions.min(9) {
        let mut midpoints = HashMap::new();
        let mut midpoint = |a: u32, b: u32, points: &mut Vec<DVec3>| {
            *midpoints.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize());
                points.len() as u32 - 1
            })
        };
        corners = corners
            .iter()
            .flat_map(|&[a, b, c]| {
                let ab = midpoint(a, b, &mut points);
                let bc = midpoint(b, c, &mut points);
                let ca = midpoint(c, a, &mut points);
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let positions: Vec<Vec3> = points
        .iter()
        .map(|p| (*p * f64::from(radius)).as_vec3())
        .collect();
    Mesh::made(positions, &corners)
}

/// The icosahedron on the unit sphere: three golden rectangles, one in each coordinate plane.
fn icosahedron() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut points = Vec::new();
    for (long, short) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let (long, short) = (golden * long, short);
        points.extend([
            DVec3::new(short, long, 0.0).normalize(),
            DVec3::new(0.0, short, long).normalize(),
            DVec3::new(long, 0.0, short).normalize(),
        ]);
    }
    // Its faces are the triples of vertices at the least distance from each other.
    let edge = 2.0 / (1.0 + golden * golden).sqrt();
    let near = |a: usize, b: usize| points[a].distance(points[b]) < 1.01 * edge;
    let mut corners = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outwards = points[a].dot(points[b].cross(points[c])) > 0.0;
                    let (b, c) = if outwards { (b, c) } else { (c, b) };
                    corners.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    (points, corners)
}
