//! Intersecting pairs against an exact test of all pairs.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use glam::{Quat, Vec3};
use physique_geometry::exact::triangles_meet;
use physique_geometry::shapes::{Torus, cuboid, icosphere, torus};
use physique_geometry::{Error, Mesh, SharedVertices, TrianglePairs, Triangles};

/// Every pair that shares no vertex, tested exactly.
fn brute_force(triangles: &Triangles, positions: &[Vec3]) -> Vec<(u32, u32)> {
    let corners = triangles.corners();
    let points = |t: usize| corners[t].map(|v| positions[v as usize]);
    let mut pairs = Vec::new();
    for first in 0..corners.len() {
        for second in first + 1..corners.len() {
            let share = corners[first].iter().any(|v| corners[second].contains(v));
            if !share && triangles_meet(points(first), points(second)) {
                pairs.push((first as u32, second as u32));
            }
        }
    }
    pairs
}

#[track_caller]
fn assert_equals_brute_force(rest: &Mesh, positions: &[Vec3]) -> usize {
    let mut pairs =
        TrianglePairs::new(&rest.triangles, &rest.positions, SharedVertices::Skip).unwrap();
    let found = pairs.find(positions).unwrap();
    assert_eq!(found, brute_force(&rest.triangles, positions));
    found.len()
}

#[test]
fn spheres_that_pass_through_each_other() {
    let (a, b) = (
        icosphere(0.5, 3),
        icosphere(0.4, 3).translated(Vec3::new(0.4, 0.1, 0.2)),
    );
    let both = Mesh::joined([&a, &b]).unwrap();
    assert!(assert_equals_brute_force(&both, &both.positions) > 50);
}

#[test]
fn a_torus_wrung_into_itself() {
    let measures = Torus {
        ring_radius: 0.4,
        tube_radius: 0.15,
        ring_segments: 24,
        tube_segments: 16,
    };
    let ring = torus(measures);
    // Squeezed and wrung around the x axis: the tree still has the shape of the rest pose.
    let wrung: Vec<Vec3> = ring
        .positions
        .iter()
        .map(|p| {
            Quat::from_rotation_x(9.0 * p.x) * (*p * Vec3::new(1.0, 0.5, 0.5)) - Vec3::X * p.z * 0.8
        })
        .collect();
    assert!(assert_equals_brute_force(&ring, &wrung) > 50);
}

#[test]
fn boxes_that_touch_in_faces_edges_and_corners() {
    let cube = cuboid(Vec3::ONE);
    for step in [
        Vec3::X,
        Vec3::new(1.0, 1.0, 0.0),
        Vec3::ONE,
        Vec3::new(0.5, 0.25, 1.0),
    ] {
        let both = Mesh::joined([&cube, &cube.clone().translated(step)]).unwrap();
        assert!(
            assert_equals_brute_force(&both, &both.positions) > 0,
            "touching at {step}"
        );
        let apart = Mesh::joined([&cube, &cube.clone().translated(step * 1.000_001)]).unwrap();
        assert_eq!(
            assert_equals_brute_force(&apart, &apart.positions),
            0,
            "apart at {step}"
        );
    }
}

#[test]
fn flat_and_collapsed_meshes() {
    let flat = icosphere(0.5, 2);
    for scale in [
        Vec3::new(1.0, 1.0, 0.0),
        Vec3::new(1.0, 0.0, 0.0),
        Vec3::ZERO,
    ] {
        let collapsed: Vec<Vec3> = flat.positions.iter().map(|p| *p * scale).collect();
        assert!(assert_equals_brute_force(&flat, &collapsed) > 100);
    }
}

#[test]
fn a_convex_surface_does_not_intersect_itself() {
    let sphere = icosphere(1.0, 4);
    for shared in [SharedVertices::Skip, SharedVertices::Test] {
        let mut pairs = TrianglePairs::new(&sphere.triangles, &sphere.positions, shared).unwrap();
        assert_eq!(pairs.find(&sphere.positions).unwrap(), []);
    }
}

#[test]
fn a_fold_is_found_only_where_shared_vertices_are_tested() {
    // Two triangles with a common edge, folded flat onto each other; then opened.
    let triangles = Triangles::new(4, &[[0, 1, 2], [1, 0, 3]]).unwrap();
    let folded = [
        Vec3::ZERO,
        Vec3::X,
        Vec3::new(0.2, 1.0, 0.0),
        Vec3::new(0.8, 1.0, 0.0),
    ];
    let mut open = folded;
    open[3] = Vec3::new(0.8, 1.0, 1e-6);
    let find = |shared, positions: &[Vec3]| {
        TrianglePairs::new(&triangles, &folded, shared)
            .unwrap()
            .find(positions)
            .unwrap()
            .to_vec()
    };
    assert_eq!(find(SharedVertices::Test, &folded), [(0, 1)]);
    assert_eq!(find(SharedVertices::Skip, &folded), []);
    assert_eq!(find(SharedVertices::Test, &open), []);
}

#[test]
fn triangles_with_a_common_corner_may_pass_through_each_other() {
    let triangles = Triangles::new(5, &[[2, 0, 1], [3, 4, 0]]).unwrap();
    let wing = |x: f32| {
        let (tip, low, high) = (Vec3::ZERO, Vec3::new(x, -0.5, 0.0), Vec3::new(x, 0.5, 0.0));
        [
            tip,
            Vec3::new(1.0, 0.0, -0.5),
            Vec3::new(1.0, 0.0, 0.5),
            low,
            high,
        ]
    };
    let find = |positions: &[Vec3]| {
        let mut pairs = TrianglePairs::new(&triangles, positions, SharedVertices::Test).unwrap();
        pairs.find(positions).unwrap().len()
    };
    assert_eq!(find(&wing(1.0)), 1);
    assert_eq!(find(&wing(0.3)), 1);
    assert_eq!(find(&wing(-0.3)), 0);
}

#[test]
fn hostile_positions_are_refused() {
    let cube = cuboid(Vec3::ONE);
    let mut pairs =
        TrianglePairs::new(&cube.triangles, &cube.positions, SharedVertices::Skip).unwrap();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut positions = cube.positions.clone();
        positions[3].y = bad;
        assert!(matches!(
            pairs.find(&positions),
            Err(Error::NotFinite { vertex: 3, .. })
        ));
    }
    let mut positions = cube.positions.clone();
    positions[5].z = -2e9;
    assert!(matches!(
        pairs.find(&positions),
        Err(Error::TooFarForPairs { .. })
    ));
    assert!(matches!(
        pairs.find(&positions[..4]),
        Err(Error::PositionCount {
            expected: 8,
            found: 4
        })
    ));
    assert_eq!(pairs.find(&cube.positions).unwrap(), []);
}

#[test]
fn no_triangles_have_no_pairs() {
    let none = Triangles::new(0, &[]).unwrap();
    let mut pairs = TrianglePairs::new(&none, &[], SharedVertices::Test).unwrap();
    assert_eq!(pairs.find(&[]).unwrap(), []);
}
