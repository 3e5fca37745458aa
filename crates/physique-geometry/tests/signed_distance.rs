//! Signed distances against known shapes and a slow reference.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use glam::{Affine3A, Quat, Vec3};
use physique_geometry::reference::signed_distance;
use physique_geometry::shapes::{Torus, cuboid, icosphere, torus};
use physique_geometry::space_filling_order;
use physique_geometry::{Error, Mesh, NearestSurface, SignedDistances, Triangles};
use proptest::prelude::*;

/// Points of a lattice over a cube, with an offset that is no multiple of anything.
fn lattice(half_extent: f32, aside: u32) -> Vec<Vec3> {
    let at = |i: u32| (i as f32 / (aside - 1) as f32 * 2.0 - 1.0) * half_extent + 0.001_37;
    (0..aside)
        .flat_map(|x| (0..aside).map(move |y| (x, y)))
        .flat_map(|(x, y)| (0..aside).map(move |z| Vec3::new(at(x), at(y), at(z))))
        .collect()
}

#[track_caller]
fn assert_equals_reference(mesh: &Mesh, points: &[Vec3], tolerance: f64) {
    let distances = SignedDistances::new(&mesh.triangles, &mesh.positions).unwrap();
    let mut found = vec![NearestSurface::UNKNOWN; points.len()];
    distances.fill(points, &mut found);
    for (&point, found) in points.iter().zip(&found) {
        let expected = signed_distance(&mesh.triangles, &mesh.positions, point.as_dvec3()).unwrap();
        let difference = (f64::from(found.signed_distance) - expected).abs();
        assert!(
            difference < tolerance,
            "at {point}: {} instead of {expected}",
            found.signed_distance
        );
    }
}

fn ring() -> Mesh {
    torus(Torus {
        ring_radius: 0.4,
        tube_radius: 0.15,
        ring_segments: 24,
        tube_segments: 12,
    })
}

#[test]
fn a_box_has_the_distance_of_the_formula() {
    let half = Vec3::new(0.5, 0.4, 0.3);
    let mesh = cuboid(half * 2.0);
    let distances = SignedDistances::new(&mesh.triangles, &mesh.positions).unwrap();
    for point in lattice(1.0, 12) {
        let beyond = point.abs() - half;
        let expected = beyond.max(Vec3::ZERO).length() + beyond.max_element().min(0.0);
        assert!((distances.at(point) - expected).abs() < 1e-6, "at {point}");
    }
}

#[test]
fn a_fine_sphere_has_the_distance_of_a_sphere() {
    let mesh = icosphere(0.8, 5);
    let distances = SignedDistances::new(&mesh.triangles, &mesh.positions).unwrap();
    for point in lattice(1.2, 11) {
        // Facets lie at most 0.3 mm inside the sphere.
        let difference = distances.at(point) - (point.length() - 0.8);
        assert!(
            (-1e-5..5e-4).contains(&difference),
            "at {point}: {difference}"
        );
    }
}

#[test]
fn what_surfaces_cover_together_is_inside() {
    let first = icosphere(0.5, 2);
    let second = icosphere(0.4, 3).translated(Vec3::new(0.4, 0.1, 0.2));
    let both = Mesh::joined([&first, &second]).unwrap();
    assert_equals_reference(&both, &lattice(1.0, 10), 1e-6);
}

#[test]
fn rays_through_edges_and_vertices_count_once() {
    // Every lattice point of the box's middle planes looks at edges, diagonals and corners.
    let mesh = cuboid(Vec3::ONE);
    let distances = SignedDistances::new(&mesh.triangles, &mesh.positions).unwrap();
    for x in -4..=4 {
        for y in -4..=4 {
            for z in -4..=4 {
                let point = Vec3::new(x as f32, y as f32, z as f32) / 8.0;
                let expected = point.abs().max_element() - 0.5;
                assert!((distances.at(point) - expected).abs() < 1e-6, "at {point}");
            }
        }
    }
    let ball = icosphere(1.0, 3);
    let distances = SignedDistances::new(&ball.triangles, &ball.positions).unwrap();
    for &vertex in &ball.positions {
        assert!(distances.at(vertex * 0.5) < 0.0);
        assert!(distances.at(vertex * 1.5) > 0.0);
    }
}

#[test]
fn the_nearest_triangle_is_at_that_distance() {
    let mesh = ring();
    let distances = SignedDistances::new(&mesh.triangles, &mesh.positions).unwrap();
    let points = lattice(0.7, 9);
    let mut found = vec![NearestSurface::UNKNOWN; points.len()];
    distances.fill(&points, &mut found);
    for (&point, found) in points.iter().zip(&found) {
        // Alone, and turned inside out, which leaves the distance.
        let corners = mesh.triangles.corners()[found.triangle as usize];
        let [a, b, c] = corners;
        let alone = Triangles::new(mesh.positions.len(), &[[a, b, c], [c, b, a]]).unwrap();
        let distance = signed_distance(&alone, &mesh.positions, point.as_dvec3()).unwrap();
        assert!((distance - f64::from(found.signed_distance.abs())).abs() < 1e-6);
    }
}

#[test]
fn triangles_without_area_do_no_harm() {
    let mut mesh = icosphere(0.5, 2);
    let [a, b, _] = mesh.triangles.corners()[7];
    mesh.positions[a as usize] = mesh.positions[b as usize];
    assert_equals_reference(&mesh, &lattice(0.8, 8), 1e-6);
}

#[test]
fn what_is_no_surface_is_refused() {
    let mesh = icosphere(0.5, 1);
    let open = Triangles::new(mesh.positions.len(), &mesh.triangles.corners()[1..]).unwrap();
    let refused = |triangles: &Triangles, positions: &[Vec3]| {
        SignedDistances::new(triangles, positions).unwrap_err()
    };
    assert!(matches!(
        refused(&open, &mesh.positions),
        Error::OpenEdge { .. }
    ));
    let none = Triangles::new(0, &[]).unwrap();
    assert!(matches!(refused(&none, &[]), Error::NoTriangles));
    assert!(matches!(
        refused(&mesh.triangles, &mesh.positions[1..]),
        Error::PositionCount { .. }
    ));
    let huge: Vec<Vec3> = mesh.positions.iter().map(|p| *p * 1e30).collect();
    assert!(matches!(
        refused(&mesh.triangles, &huge),
        Error::TooFarForPairs { .. }
    ));
}

#[test]
fn points_that_are_not_finite_get_no_finite_distance() {
    let mesh = icosphere(0.5, 1);
    let distances = SignedDistances::new(&mesh.triangles, &mesh.positions).unwrap();
    for point in [Vec3::NAN, Vec3::INFINITY, Vec3::new(0.0, f32::NAN, 0.0)] {
        assert!(!distances.at(point).is_finite());
    }
}

#[test]
fn the_curve_visits_every_point_once_and_stays_near() {
    let points = lattice(1.0, 16);
    let order = space_filling_order(&points);
    let mut sorted = order.clone();
    sorted.sort_unstable();
    assert!(sorted.iter().copied().eq(0..points.len() as u32));
    let step = |pair: &[u32]| points[pair[0] as usize].distance(points[pair[1] as usize]);
    let mean = order.windows(2).map(step).sum::<f32>() / (points.len() - 1) as f32;
    // Lattice neighbours are 0.133 apart; a random order would take steps of 1.3.
    assert!(mean < 0.3, "{mean}");
}

proptest! {
    #[test]
    fn any_pose_of_a_shape_equals_the_reference(
        axis in prop::array::uniform3(-1.0f32..1.0),
        angle in -3.0f32..3.0,
        scale in prop::array::uniform3(0.2f32..2.0),
        shift in prop::array::uniform3(-1.0f32..1.0),
        points in prop::collection::vec(prop::array::uniform3(-2.0f32..2.0), 40),
    ) {
        let axis = Vec3::from(axis).try_normalize().unwrap_or(Vec3::X);
        let pose = Affine3A::from_scale_rotation_translation(
            scale.into(),
            Quat::from_axis_angle(axis, angle),
            shift.into(),
        );
        let mesh = ring().transformed(pose);
        let points: Vec<Vec3> = points.into_iter().map(Vec3::from).collect();
        assert_equals_reference(&mesh, &points, 5e-6);
    }
}
