//! Points inside a closed surface: where the mass is.

use glam::{DVec2, DVec3};

/// A point inside, and the volume it stands for in m3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct InteriorPoint {
    pub(crate) position: DVec3,
    pub(crate) volume: f64,
}

/// Lines run off the multiples of the spacing, so that none runs within a face of a box (the
/// plastic number's low-discrepancy sequence).
const SHIFT: DVec2 = DVec2::new(0.754_877_666_246_693, 0.569_840_290_998_053);

/// Fills a closed surface with points `spacing` apart.
///
/// Lines upwards, `spacing` apart, are cut where they enter and leave the surface (winding number
/// 1 or more is inside); every stretch inside is divided into equal pieces of at most `spacing`,
/// one point each. Exact along the lines, the midpoint rule across.
pub(crate) fn interior_points(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    spacing: f64,
) -> Vec<InteriorPoint> {
    let across = |p: DVec3| DVec2::new(p.x, p.z) / spacing - SHIFT;
    let mut crossings = Vec::new();
    for triangle in triangles {
        let corners = triangle.map(|vertex| positions[vertex as usize]);
        let flat = corners.map(across);
        let low = flat[0].min(flat[1]).min(flat[2]).ceil();
        let high = flat[0].max(flat[1]).max(flat[2]).floor();
        for row in low.y as i64..=high.y as i64 {
            for column in low.x as i64..=high.x as i64 {
                let line = DVec2::new(column as f64, row as f64);
                if let Some((height, step)) = crossing(corners, flat, line) {
                    crossings.push((row, column, height, step));
                }
            }
        }
    }
    crossings.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));

    let mut points = Vec::new();
    for line in crossings.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let place = (DVec2::new(line[0].1 as f64, line[0].0 as f64) + SHIFT) * spacing;
        let mut winding = 0;
        for pair in line.windows(2) {
            winding += pair[0].3;
            let length = pair[1].2 - pair[0].2;
            if winding < 1 || length <= 0.0 {
                continue;
            }
            let pieces = (length / spacing).ceil();
            for piece in 0..pieces as usize {
                let height = pair[0].2 + length * (piece as f64 + 0.5) / pieces;
                points.push(InteriorPoint {
                    position: DVec3::new(place.x, height, place.y),
                    volume: spacing * spacing * length / pieces,
                });
            }
        }
    }
    points
}

/// Where a vertical line meets a triangle, and how the winding number changes upwards.
///
/// An edge belongs to the triangle on one side of it only: the edge function of two neighbours is
/// the same number with the opposite sign, whichever way round it is computed.
fn crossing(corners: [DVec3; 3], flat: [DVec2; 3], line: DVec2) -> Option<(f64, i32)> {
    let edge = |a: DVec2, b: DVec2| {
        let ordered = (a.x, a.y) < (b.x, b.y);
        let (from, to) = if ordered { (a, b) } else { (b, a) };
        let value = (to - from).perp_dot(line - from);
        if ordered { value } else { -value }
    };
    let weights = [
        edge(flat[1], flat[2]),
        edge(flat[2], flat[0]),
        edge(flat[0], flat[1]),
    ];
    let area: f64 = weights.iter().sum();
    let inside = weights.iter().all(|&w| w > 0.0) || weights.iter().all(|&w| w < 0.0);
    if !inside || area == 0.0 {
        return None;
    }
    let height =
        (weights[0] * corners[0].y + weights[1] * corners[1].y + weights[2] * corners[2].y) / area;
    // In the plane (x, z) an upward-facing triangle, counter-clockwise seen from above, runs
    // clockwise: going up through it leaves the body.
    Some((height, if area < 0.0 { -1 } else { 1 }))
}

#[cfg(test)]
mod tests {
    use physique_geometry::{Mesh, shapes};

    use super::*;

    fn fill(mesh: &Mesh, spacing: f64) -> (f64, DVec3) {
        let positions: Vec<_> = mesh.positions.iter().map(|p| p.as_dvec3()).collect();
        let points = interior_points(&positions, mesh.triangles.corners(), spacing);
        let volume: f64 = points.iter().map(|p| p.volume).sum();
        let moment: DVec3 = points.iter().map(|p| p.position * p.volume).sum();
        (volume, moment / volume)
    }

    #[test]
    fn a_ball_has_its_volume_and_middle() {
        let middle = DVec3::new(0.2, 1.0, -0.3);
        let ball = shapes::icosphere(0.5, 5).translated(middle.as_vec3());
        let (volume, found) = fill(&ball, 0.02);
        let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.125;
        assert!((volume / exact - 1.0).abs() < 3e-3, "{volume} {exact}");
        assert!((found - middle).length() < 1e-3, "{found}");
    }

    #[test]
    fn a_hollow_is_not_filled() {
        let outer = shapes::icosphere(0.5, 4);
        let mut inner = shapes::icosphere(0.3, 4);
        inner.positions.iter_mut().for_each(|p| *p = -*p);
        let hollow = Mesh::joined([&outer, &inner]).unwrap();
        let (full, _) = fill(&outer, 0.02);
        let (volume, _) = fill(&hollow, 0.02);
        assert!(
            (volume / full - (1.0 - 0.216)).abs() < 5e-3,
            "{volume} {full}"
        );
    }
}
