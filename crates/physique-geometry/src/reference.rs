//! Slow, readable twins of the fast paths, for tests and doubts.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use crate::sia::{POINTS_ASIDE, SiaVolumes, coordinate, in_ball};
use crate::{ConicField, Error, Triangles};

const HALF: f32 = std::f32::consts::FRAC_1_SQRT_2;
const THIRD: f32 = 0.577_350_26;

/// The 13 directions of the `sia` protocol: to a cube's neighbours, one of each opposite pair.
const DIRECTIONS: [[f32; 3]; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, HALF, HALF],
    [HALF, 0.0, HALF],
    [HALF, HALF, 0.0],
    [0.0, HALF, -HALF],
    [HALF, 0.0, -HALF],
    [HALF, -HALF, 0.0],
    [THIRD, THIRD, THIRD],
    [-THIRD, THIRD, THIRD],
    [THIRD, -THIRD, THIRD],
    [THIRD, THIRD, -THIRD],
];

/// The published rule of [`sia`](crate::sia): how often a surface covers each of the 35³ points, x
/// slowest, z fastest, 0 outside the ball. Thirteen rays leave every point; a triangle counts +1 for a
/// ray that leaves the surface through it and -1 for one that enters; the sum is divided by 13 and
/// truncated towards zero. Single precision throughout. Seconds a mesh: use
/// [`SiaCounter`](crate::sia::SiaCounter).
///
/// # Errors
///
/// If there is not one finite position a vertex.
pub fn sia_counts(triangles: &Triangles, ball_positions: &[Vec3]) -> Result<Vec<i32>, Error> {
    triangles.check_positions(ball_positions)?;
    let faces: Vec<[Vec3; 3]> = triangles
        .corners()
        .iter()
        .map(|t| t.map(|v| ball_positions[v as usize]))
        .collect();
    let mut counts = Vec::with_capacity(POINTS_ASIDE.pow(3));
    for x in 0..POINTS_ASIDE {
        for y in 0..POINTS_ASIDE {
            for z in 0..POINTS_ASIDE {
                let point = Vec3::new(coordinate(x), coordinate(y), coordinate(z));
                counts.push(if in_ball(point) {
                    sum_of_rays(&faces, point) / 13
                } else {
                    0
                });
            }
        }
    }
    Ok(counts)
}

/// Sums counts as the protocol does.
#[must_use]
pub fn sia_volumes(counts: &[i32]) -> SiaVolumes {
    let sum = |least: i32| {
        counts
            .iter()
            .filter(|&&count| count >= least)
            .map(|&count| i64::from(count))
            .sum()
    };
    SiaVolumes::from_sums(sum(2), sum(i32::MIN))
}

/// How often a closed surface winds around a point: the sum of the solid angles of its triangles over
/// 4 pi (Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983). A whole number up to
/// rounding, unless the point lies on the surface.
///
/// # Errors
///
/// If there is not one finite position a vertex.
pub fn winding_number(
    triangles: &Triangles,
    positions: &[Vec3],
    point: DVec3,
) -> Result<f64, Error> {
    triangles.check_positions(positions)?;
    let half_angle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| positions[v as usize].as_dvec3() - point);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        a.dot(b.cross(c)).atan2(denominator)
    };
    Ok(triangles.corners().iter().map(half_angle).sum::<f64>() / (2.0 * PI))
}

/// Signed distance of a point to a closed surface, negative where the surface winds around it: the
/// least distance to a triangle (Ericson, "Real-Time Collision Detection", 2005, 5.1.5), and
/// [`winding_number`]. Use [`SignedDistances`](crate::SignedDistances).
///
/// # Errors
///
/// If there is not one finite position a vertex.
pub fn signed_distance(
    triangles: &Triangles,
    positions: &[Vec3],
    point: DVec3,
) -> Result<f64, Error> {
    let winding = winding_number(triangles, positions, point)?;
    let distance = triangles
        .corners()
        .iter()
        .map(|corners| {
            let [a, b, c] = corners.map(|v| positions[v as usize].as_dvec3());
            (closest_point(point, a, b, c) - point).length()
        })
        .fold(f64::INFINITY, f64::min);
    Ok(if winding > 0.5 { -distance } else { distance })
}

/// The point of a triangle that is closest to `p`.
fn closest_point(p: DVec3, a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    a + ab * (vb / sum) + ac * (vc / sum)
}

/// The cost of two triangles in each other's [conic distance fields](crate::ConicField), term by term
/// as published. Has no gradient: take differences.
#[must_use]
pub fn conic_pair_cost(field: &ConicField, first: [DVec3; 3], second: [DVec3; 3]) -> f64 {
    let in_units = |corners: [DVec3; 3]| corners.map(|corner| corner / field.unit);
    let (first, second) = (in_units(first), in_units(second));
    let sum = |triangle, points: [DVec3; 3]| -> f64 {
        let intrusion = |point| conic_field(field.sigma, triangle, point);
        points
            .into_iter()
            .map(|point| intrusion(point).powi(2))
            .sum()
    };
    sum(first, second) + sum(second, first)
}

/// Psi of the paper: the square of `(1 - F) Y`.
fn conic_field(sigma: f64, [a, b, c]: [DVec3; 3], point: DVec3) -> f64 {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    // The circumcentre by its weights: opposite side's square times the sum of the others less it.
    let [u, v, w] = [
        b.distance_squared(c),
        c.distance_squared(a),
        a.distance_squared(b),
    ];
    let weights = [u * (v + w - u), v * (w + u - v), w * (u + v - w)];
    let total: f64 = weights.iter().sum();
    if normal == DVec3::ZERO || total <= 0.0 {
        return 0.0;
    }
    let centre = (a * weights[0] + b * weights[1] + c * weights[2]) / total;
    let radius = centre.distance(a);
    let height = normal.dot(point - centre);
    let aside = (point - centre - normal * height).length();
    let outside = aside / (-(radius / sigma) * height + radius);
    if height >= sigma || outside >= 1.0 {
        return 0.0;
    }
    let depth = if height <= -sigma {
        -height + 1.0 - sigma
    } else {
        -(1.0 - 2.0 * sigma) / (4.0 * sigma * sigma) * height * height - height / (2.0 * sigma)
            + (3.0 - 2.0 * sigma) / 4.0
    };
    ((1.0 - outside) * depth).powi(2)
}

fn sum_of_rays(faces: &[[Vec3; 3]], point: Vec3) -> i32 {
    let crossings = |&direction: &[f32; 3]| -> i32 {
        faces
            .iter()
            .map(|&face| crossing(face, point, direction.into()))
            .sum()
    };
    DIRECTIONS.iter().map(crossings).sum()
}

/// Möller and Trumbore's test with the protocol's tolerances: +1 if the ray leaves through the
/// triangle, -1 if it enters, 0 if it misses or hits the rim.
fn crossing([a, b, c]: [Vec3; 3], point: Vec3, direction: Vec3) -> i32 {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant.abs() < 1e-8 {
        return 0;
    }
    let inverse = 1.0 / determinant;
    let u = ap.dot(p) * inverse;
    let q = ap.cross(ab);
    let v = direction.dot(q) * inverse;
    let distance = ac.dot(q) * inverse;
    let hits = u > 0.0 && u < 1.0 && v > 0.0 && u + v < 1.0 && distance > 1e-4;
    match hits {
        true if ab.cross(ac).dot(direction) >= 0.0 => 1,
        true => -1,
        false => 0,
    }
}
