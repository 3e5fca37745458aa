//! The column scan against volumes known from geometry.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use std::f64::consts::PI;

use glam::Vec3;
use physique_geometry::shapes::{Torus, cuboid, icosphere, torus};
use physique_geometry::{Axis, ColumnScanner, CoveredVolumes, Mesh, ScanOptions, signed_volume};

fn scan(mesh: &Mesh, spacing: f32, axis: Axis) -> CoveredVolumes {
    let options = ScanOptions {
        spacing,
        axis,
        ..ScanOptions::default()
    };
    ColumnScanner::new(&mesh.triangles, options)
        .unwrap()
        .scan(&mesh.positions)
        .unwrap()
        .volumes()
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not within {tolerance} of {expected}"
    );
}

#[test]
fn a_box_is_exact_but_for_the_lines_at_its_rim() {
    let size = Vec3::new(0.3, 0.5, 0.7);
    let brick = cuboid(size).translated(Vec3::new(0.011, -0.023, 0.037));
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        for spacing in [0.06, 0.02, 0.01, 0.005] {
            let volumes = scan(&brick, spacing, axis);
            let longest = match axis {
                Axis::X => 0.5 * 0.7,
                Axis::Y => 0.3 * 0.7,
                Axis::Z => 0.3 * 0.5,
            };
            // One line more or less on either side.
            let rim = f64::from(spacing) * 2.0 * (0.3 + 0.5 + 0.7);
            let tolerance = 0.3 * 0.5 * 0.7 * rim / longest;
            assert_near(volumes.covered, 0.3 * 0.5 * 0.7, tolerance);
            assert_eq!(volumes.covered, volumes.signed);
            assert_eq!(volumes.doubly_covered, 0.0);
            assert_eq!(volumes.multiplicity_weighted, 0.0);
        }
    }
}

#[test]
fn two_spheres_overlap_in_a_lens() {
    let (r, s) = (0.5_f64, 0.45);
    let offset = Vec3::new(0.45, 0.05, 0.1);
    let d = f64::from(offset.length());
    let lens =
        PI * (r + s - d).powi(2) * (d * d + 2.0 * d * (r + s) - 3.0 * (r - s).powi(2)) / (12.0 * d);
    let (first, second) = (icosphere(0.5, 5), icosphere(0.45, 5).translated(offset));
    let both = Mesh::joined([&first, &second]).unwrap();
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        let volumes = scan(&both, 0.01, axis);
        // The facets lie up to 0.04 % of the radius inside the ball.
        assert_near(volumes.doubly_covered, lens, 0.003 * lens);
        assert_eq!(volumes.multiplicity_weighted, 2.0 * volumes.doubly_covered);
        let signed = signed_volume(&both.triangles, &both.positions).unwrap();
        assert_near(volumes.signed, signed, 1e-4 * signed);
        assert_near(
            volumes.covered + volumes.doubly_covered,
            volumes.signed,
            1e-12,
        );
    }
}

#[test]
fn a_torus_has_its_volume() {
    let measures = Torus {
        ring_radius: 0.4,
        tube_radius: 0.15,
        ring_segments: 128,
        tube_segments: 64,
    };
    let ring = torus(measures);
    let exact = signed_volume(&ring.triangles, &ring.positions).unwrap();
    assert_near(exact, 2.0 * PI * PI * 0.4 * 0.15 * 0.15, 0.01 * exact);
    // Seen from the side, a cross-section y below the flat rim has the area a(y) = 4 pi R sqrt(2 r y).
    // Summing a square root at steps of h is off by h a(h) times Hurwitz' zeta(-1/2, shift), which
    // stays within 0.21; there are two rims.
    let spacing = 0.01_f64;
    let tolerance = 2.0 * 0.21 * spacing * 4.0 * PI * 0.4 * (2.0 * 0.15 * spacing).sqrt();
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        let volumes = scan(&ring, 0.01, axis);
        assert_near(volumes.covered, exact, tolerance);
        assert_eq!(volumes.doubly_covered, 0.0);
    }
}

#[test]
fn an_inside_out_surface_covers_nothing_and_has_negative_volume() {
    let mut sphere = icosphere(0.3, 3);
    sphere.positions.iter_mut().for_each(|p| p.x = -p.x);
    let volumes = scan(&sphere, 0.01, Axis::Z);
    assert_eq!(volumes.covered, 0.0);
    assert!(volumes.signed < -0.1);
}

/// The error against the spacing, for the lens of two balls of radius r at distance d along the lines.
///
/// Its thickness grows from the rim (radius p, p² = r² - d²/4) inwards by 4 p / d per length. A line in
/// a cell on the rim stands for the whole cell: half a cell's area times the thickness one spacing from
/// the rim, for each of the 2 pi p / h cells on the rim, independently of each other.
#[test]
fn the_error_of_a_lens_falls_with_the_spacing_as_expected() {
    let (radius, distance) = (0.15_f64, 0.2_f64);
    let ball = icosphere(radius as f32, 6);
    let both = Mesh::joined([&ball, &ball.clone().translated(Vec3::Z * distance as f32)]).unwrap();
    let lens = PI * (4.0 * radius + distance) * (2.0 * radius - distance).powi(2) / 12.0;
    let rim = (radius * radius - distance * distance / 4.0).sqrt();
    for spacing in [0.06, 0.03, 0.02, 0.01, 0.005] {
        let options = ScanOptions {
            spacing: spacing as f32,
            ..ScanOptions::default()
        };
        let mut scanner = ColumnScanner::new(&both.triangles, options).unwrap();
        let thickness = 4.0 * rim / distance * spacing;
        let expected = 0.5 * spacing * spacing * thickness * (2.0 * PI * rim / spacing).sqrt();
        for step in 0..16_u8 {
            let offset =
                Vec3::new(f32::from(step % 4), f32::from(step / 4), 0.0) * 0.25 * spacing as f32;
            let moved = both.clone().translated(offset);
            let found = scanner
                .scan(&moved.positions)
                .unwrap()
                .volumes()
                .doubly_covered;
            // The facets take 0.04 % off the lens.
            assert_near(found, lens, expected + 0.0005 * lens);
        }
    }
}
