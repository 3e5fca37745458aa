//! Volume and normals of a whole mesh, each by its textbook formula.

use glam::{DVec3, Vec3};

use crate::{Error, Triangles};

/// Signed volume that a closed surface encloses, in cubic metres: the sum of the signed tetrahedra
/// between the triangles and a point (divergence theorem). What is covered twice counts twice, what
/// is turned inside out counts negative.
///
/// # Errors
///
/// If the surface is not closed (its volume would depend on the origin), or if there is not one
/// finite position a vertex.
///
/// ```
/// use physique_geometry::{shapes, signed_volume};
///
/// let brick = shapes::cuboid([1.0, 2.0, 3.0].into());
/// assert!((signed_volume(&brick.triangles, &brick.positions)? - 6.0).abs() < 1e-12);
/// # Ok::<(), physique_geometry::Error>(())
/// ```
pub fn signed_volume(triangles: &Triangles, positions: &[Vec3]) -> Result<f64, Error> {
    triangles.require_closed()?;
    triangles.check_positions(positions)?;
    // A point of the surface as apex, not the origin: a mesh far away must not lose its digits.
    let apex = positions.first().map_or(DVec3::ZERO, |p| p.as_dvec3());
    let six_volumes: f64 = corners(triangles, positions)
        .map(|[a, b, c]| (a - apex).dot((b - apex).cross(c - apex)))
        .sum();
    Ok(six_volumes / 6.0)
}

/// Unit normals of the vertices, pointing outwards: the mean of the neighbouring triangles' normals
/// weighted by their area. Zero where a vertex has no triangle or its triangles cancel out.
///
/// # Errors
///
/// If there is not one finite position a vertex.
pub fn vertex_normals(triangles: &Triangles, positions: &[Vec3]) -> Result<Vec<Vec3>, Error> {
    triangles.check_positions(positions)?;
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for (vertices, [a, b, c]) in triangles
        .corners()
        .iter()
        .zip(corners(triangles, positions))
    {
        // Twice the area long: the weight comes for free.
        let normal = (b - a).cross(c - a);
        for &vertex in vertices {
            sums[vertex as usize] += normal;
        }
    }
    Ok(sums
        .iter()
        .map(|sum| sum.normalize_or_zero().as_vec3())
        .collect())
}

fn corners(triangles: &Triangles, positions: &[Vec3]) -> impl Iterator<Item = [DVec3; 3]> {
    triangles
        .corners()
        .iter()
        .map(|corners| corners.map(|v| positions[v as usize].as_dvec3()))
}
