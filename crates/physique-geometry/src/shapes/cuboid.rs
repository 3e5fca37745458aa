use glam::Vec3;

use super::Mesh;

/// An axis-parallel box of 12 triangles around the origin, with the edge lengths `size` in metres.
#[must_use]
pub fn cuboid(size: Vec3) -> Mesh {
    // Vertex k sits at the sign bits of k: bit 0 is x, bit 1 is y, bit 2 is z.
    let sign = |k: u32, bit: u32| if k >> bit & 1 == 1 { 0.5 } else { -0.5 };
    let positions = (0..8)
        .map(|k| size * Vec3::new(sign(k, 0), sign(k, 1), sign(k, 2)))
        .collect();
    // Counter-clockwise seen from outside: -z, +z, -y, +y, -x, +x.
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let corners: Vec<[u32; 3]> = faces
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    Mesh::made(positions, &corners)
}
