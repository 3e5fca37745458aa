//! The makers: closed, oriented outwards, with the volumes they promise.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use std::f64::consts::PI;

use glam::Vec3;
use physique_geometry::shapes::{Torus, cuboid, icosphere, torus};
use physique_geometry::{Mesh, signed_volume, vertex_normals};

#[track_caller]
fn assert_volume(mesh: &Mesh, ideal: f64, tolerance: f64) {
    let volume = signed_volume(&mesh.triangles, &mesh.positions).unwrap();
    assert!(
        (volume / ideal - 1.0).abs() < tolerance,
        "{volume} is not {ideal}"
    );
}

#[test]
fn boxes_hold_the_product_of_their_edges() {
    assert_volume(&cuboid(Vec3::new(0.5, 2.0, 3.0)), 3.0, 1e-12);
}

#[test]
fn spheres_approach_the_ball_from_inside() {
    let ideal = 4.0 / 3.0 * PI * 0.3_f64.powi(3);
    for (subdivisions, tolerance) in [(0, 0.4), (1, 0.15), (2, 0.04), (3, 0.01), (4, 0.003)] {
        let sphere = icosphere(0.3, subdivisions);
        assert_eq!(sphere.triangles.len(), 20 << (2 * subdivisions));
        assert_volume(&sphere, ideal, tolerance);
        assert!(signed_volume(&sphere.triangles, &sphere.positions).unwrap() < ideal);
    }
}

#[test]
fn normals_of_a_sphere_point_outwards() {
    let sphere = icosphere(2.0, 3);
    for (normal, position) in vertex_normals(&sphere.triangles, &sphere.positions)
        .unwrap()
        .iter()
        .zip(&sphere.positions)
    {
        assert!(normal.dot(*position / 2.0) > 0.999);
    }
}

#[test]
fn tori_hold_what_pappus_says() {
    let fine = Torus {
        ring_radius: 0.5,
        tube_radius: 0.2,
        ring_segments: 256,
        tube_segments: 256,
    };
    assert_volume(&torus(fine), 2.0 * PI * PI * 0.5 * 0.04, 1e-3);
    // The coarsest there is: segment counts are clamped to 3.
    let coarse = torus(Torus {
        ring_segments: 0,
        tube_segments: 1,
        ..fine
    });
    assert_eq!(coarse.triangles.len(), 18);
    coarse.triangles.require_closed().unwrap();
}

#[test]
fn a_mesh_far_away_keeps_its_volume() {
    // Positions are exact there; so must be the volume.
    assert_volume(
        &cuboid(Vec3::ONE).translated(Vec3::new(1000.0, -2000.0, 4000.0)),
        1.0,
        1e-12,
    );
}
