//! What must hold of every scan: invariants on random poses, and hostile input.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use glam::{Affine3A, DVec3, Quat, Vec3};
use physique_geometry::reference::{signed_distance, winding_number};
use physique_geometry::shapes::{cuboid, icosphere};
use physique_geometry::{
    Axis, ColumnScanner, CoveredVolumes, Error, LabelDistances, Mesh, PairOverlaps, ScanOptions,
    TriangleLabels, Triangles, signed_volume,
};
use proptest::prelude::*;

/// Three balls of 5 to 20 cm around the origin, so that they mostly overlap.
fn balls() -> impl Strategy<Value = Mesh> {
    let ball = (prop::array::uniform3(-0.15_f32..0.15), 0.05_f32..0.2);
    prop::array::uniform3(ball).prop_map(|balls| {
        let meshes = balls.map(|(centre, radius)| icosphere(radius, 3).translated(centre.into()));
        Mesh::joined(&meshes).unwrap()
    })
}

fn rotation() -> impl Strategy<Value = Quat> {
    prop::array::uniform4(-1.0_f32..1.0)
        .prop_filter("a direction", |q| {
            q.iter().map(|x| x * x).sum::<f32>() > 0.01
        })
        .prop_map(|[x, y, z, w]| Quat::from_xyzw(x, y, z, w).normalize())
}

fn scan(mesh: &Mesh, options: ScanOptions) -> CoveredVolumes {
    ColumnScanner::new(&mesh.triangles, options)
        .unwrap()
        .scan(&mesh.positions)
        .unwrap()
        .volumes()
}

fn fine() -> ScanOptions {
    ScanOptions {
        spacing: 0.005,
        ..ScanOptions::default()
    }
}

/// Generous bound on a scan's error: half a cell's area times the thickness, for every cell on the rim
/// of the overlap, whose errors are independent. At most 20 cm thick, at most 2 pi 20 cm around.
fn tolerance(spacing: f64) -> f64 {
    let rim_cells: f64 = 2.0 * std::f64::consts::PI * 0.2 / spacing;
    0.5 * spacing * spacing * 0.2 * rim_cells.sqrt()
}

/// How far snapping moves a point of the surface at most: half a subcell in both directions across the
/// lines, a depth unit along them, and the rounding of a position within a metre.
fn snapped_by(spacing: f32) -> f64 {
    let spacing = f64::from(spacing);
    spacing * (std::f64::consts::SQRT_2 / 2048.0 + 1.0 / 65536.0) + 1e-6
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn rigid_motion_changes_nothing_beyond_the_error(mesh in balls(), turn in rotation(), x in -3.0_f32..3.0) {
        let moved = mesh.clone().transformed(Affine3A::from_rotation_translation(turn, Vec3::new(x, 1.0, -x)));
        let (before, after) = (scan(&mesh, fine()), scan(&moved, fine()));
        prop_assert!((before.covered - after.covered).abs() < 2.0 * tolerance(0.005));
        prop_assert!((before.doubly_covered - after.doubly_covered).abs() < 2.0 * tolerance(0.005));
    }

    #[test]
    fn moving_by_whole_spacings_changes_nothing_beyond_rounding(mesh in balls(), steps in prop::array::uniform3(-64_i8..64)) {
        // A spacing that f32 holds exactly.
        let options = ScanOptions { spacing: 1.0 / 128.0, ..ScanOptions::default() };
        let offset = Vec3::from(steps.map(f32::from)) / 128.0;
        let (before, after) = (scan(&mesh, options), scan(&mesh.clone().translated(offset), options));
        // Vertices move by up to 2^-24 m and may be snapped differently: some lines more or less at
        // the silhouette, where the surface is thin.
        prop_assert!((before.covered - after.covered).abs() < 2e-6);
        prop_assert!((before.doubly_covered - after.doubly_covered).abs() < 2e-6);
    }

    #[test]
    fn the_order_of_triangles_and_of_their_corners_is_irrelevant(mesh in balls(), seed in any::<u64>()) {
        let mut corners = mesh.triangles.corners().to_vec();
        let mut state = seed | 1;
        for last in (1..corners.len()).rev() {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            corners.swap(last, (state >> 33) as usize % (last + 1));
        }
        let shuffled = Mesh { triangles: Triangles::new(mesh.positions.len(), &corners).unwrap(), ..mesh.clone() };
        prop_assert_eq!(scan(&mesh, fine()), scan(&shuffled, fine()));
    }

    #[test]
    fn a_mirrored_surface_turned_inside_out_covers_as_much(mesh in balls()) {
        // Mirrored along the lines, these cross the same places in reverse.
        let positions: Vec<Vec3> = mesh.positions.iter().map(|p| *p * Vec3::new(1.0, 1.0, -1.0)).collect();
        let corners: Vec<[u32; 3]> = mesh.triangles.corners().iter().map(|&[a, b, c]| [a, c, b]).collect();
        let mirrored = Mesh { triangles: Triangles::new(positions.len(), &corners).unwrap(), positions };
        let (before, after) = (scan(&mesh, fine()), scan(&mirrored, fine()));
        // Every crossing may round to the next depth unit: 1/65536 of a spacing, times a cell's area,
        // for two crossings on each line that meets one of three balls of at most 20 cm.
        let unit = 0.005_f64.powi(3) / 65536.0;
        let crossings = 3.0 * 2.0 * std::f64::consts::PI * (0.2_f64 / 0.005).powi(2);
        prop_assert!((before.covered - after.covered).abs() < unit * crossings);
        prop_assert!((before.doubly_covered - after.doubly_covered).abs() < unit * crossings);
    }

    #[test]
    fn volumes_are_consistent(mesh in balls()) {
        let volumes = scan(&mesh, fine());
        let signed = signed_volume(&mesh.triangles, &mesh.positions).unwrap();
        prop_assert!((volumes.signed - signed).abs() < 3.0 * tolerance(0.005));
        prop_assert!(volumes.doubly_covered <= volumes.covered);
        prop_assert!(volumes.multiplicity_weighted >= 2.0 * volumes.doubly_covered);
        prop_assert!(volumes.multiplicity_weighted <= 3.0 * volumes.doubly_covered + 1e-12);
        // Nothing is inside out: the signed volume counts once what is covered once, and so on.
        let once = volumes.covered - volumes.doubly_covered;
        prop_assert!((volumes.signed - once - volumes.multiplicity_weighted).abs() < 1e-12);
    }

    #[test]
    fn overlaps_lie_where_the_winding_number_says(mesh in balls()) {
        let options = ScanOptions { spacing: 0.02, ..ScanOptions::default() };
        let mut scanner = ColumnScanner::new(&mesh.triangles, options).unwrap();
        let mut scan = scanner.scan(&mesh.positions).unwrap();
        let (mut sum, mut wrong) = (0.0, 0);
        scan.visit_overlaps(&TriangleLabels::uniform(&mesh.triangles), |overlap| {
            sum += overlap.volume;
            let middle = overlap.middle().as_dvec3();
            let winding = winding_number(&mesh.triangles, &mesh.positions, middle).unwrap();
            if (winding - f64::from(overlap.winding)).abs() > 1e-3 {
                // Snapping moved the surface, but no farther than this. How long the overlap is says
                // nothing: a line that grazes a ball of 16 cm by 10 micrometres runs 4 mm inside it.
                let distance = signed_distance(&mesh.triangles, &mesh.positions, middle).unwrap().abs();
                wrong += u32::from(distance > snapped_by(options.spacing));
            }
        }).unwrap();
        prop_assert_eq!(wrong, 0);
        prop_assert!((sum - scan.volumes().doubly_covered).abs() < 1e-12);
    }

    #[test]
    fn any_labels_add_up(mesh in balls(), labels in prop::collection::vec(0..4_u8, 3840), axis in 0..3) {
        let axis = [Axis::X, Axis::Y, Axis::Z][axis as usize];
        let distances = LabelDistances::new(&[0, 1, 2, 3, 1, 0, 1, 2, 2, 1, 0, 1, 3, 2, 1, 0]).unwrap();
        let labels = TriangleLabels::new(&mesh.triangles, &labels, distances).unwrap();
        let options = ScanOptions { spacing: 0.02, axis, ..ScanOptions::default() };
        let mut scanner = ColumnScanner::new(&mesh.triangles, options).unwrap();
        let mut scan = scanner.scan(&mesh.positions).unwrap();
        let mut pairs = PairOverlaps::new(4);
        scan.add_overlaps(&labels, &mut pairs).unwrap();
        let sum: f64 = pairs.iter().map(|pair| pair.volume).sum();
        prop_assert!((sum - scan.volumes().doubly_covered).abs() < 1e-12);
        pairs.clear();
        prop_assert_eq!(pairs.iter().count(), 0);
    }

    /// Whatever the positions are, a scan ends with a result or an error.
    #[test]
    fn any_positions_end_well(bits in prop::collection::vec(any::<u32>(), 24)) {
        let cube = cuboid(Vec3::ONE);
        let numbers: Vec<f32> = bits.into_iter().map(f32::from_bits).collect();
        let positions: Vec<Vec3> = numbers.as_chunks().0.iter().map(|&p: &[f32; 3]| p.into()).collect();
        let mut scanner = ColumnScanner::new(&cube.triangles, ScanOptions::default()).unwrap();
        if let Ok(scan) = scanner.scan(&positions) {
            prop_assert!(scan.volumes().covered.is_finite());
        }
        prop_assert!(scanner.scan(&cube.positions).is_ok());
    }

    /// Vertices on lines, on each other and on a coarse lattice: every tie there is.
    #[test]
    fn ties_never_leak(steps in prop::collection::vec(prop::array::uniform3(-3_i8..4), 42)) {
        let sphere = icosphere(1.0, 1);
        let positions: Vec<Vec3> = steps.iter().map(|p| Vec3::from(p.map(f32::from)) / 64.0).collect();
        let options = ScanOptions { spacing: 1.0 / 64.0, ..ScanOptions::default() };
        let mut scanner = ColumnScanner::new(&sphere.triangles, options).unwrap();
        let volumes = scanner.scan(&positions).unwrap().volumes();
        // A line that misses a crossing would leave a winding number behind, whose volume reaches from
        // the surface to nowhere; the winding number itself stays within the number of triangles.
        let extent = (7.0_f64 / 64.0).powi(3);
        prop_assert!(volumes.covered <= 2.0 * extent);
        prop_assert!(volumes.signed.abs() <= 80.0 * extent);
    }
}

#[test]
fn hostile_positions_are_refused_and_the_scanner_stays_usable() {
    let cube = cuboid(Vec3::ONE);
    let mut scanner = ColumnScanner::new(&cube.triangles, ScanOptions::default()).unwrap();
    let mut with = |value: f32| {
        let mut positions = cube.positions.clone();
        positions[2].y = value;
        scanner.scan(&positions).map(|scan| scan.volumes())
    };
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(matches!(with(bad), Err(Error::NotFinite { vertex: 2, .. })));
    }
    assert!(matches!(with(f32::MAX), Err(Error::TooFarAway { .. })));
    assert!(matches!(with(2e4), Err(Error::TooFarAway { .. })));
    assert!(matches!(with(100.0), Err(Error::TooManyLines { .. })));
    assert!(with(0.5).is_ok());
    let short = scanner
        .scan(&cube.positions[..7])
        .map(|scan| scan.volumes());
    assert_eq!(
        short,
        Err(Error::PositionCount {
            expected: 8,
            found: 7
        })
    );
}

#[test]
fn too_many_crossings_are_refused_before_memory_is_taken() {
    let cube = cuboid(Vec3::ONE);
    let options = ScanOptions {
        most_crossings: 1000,
        ..ScanOptions::default()
    };
    let mut scanner = ColumnScanner::new(&cube.triangles, options).unwrap();
    // Two faces of two triangles each, whose boxes hold some 100 by 100 lines.
    let Err(Error::TooManyCrossings { found, limit: 1000 }) =
        scanner.scan(&cube.positions).map(drop)
    else {
        panic!("expected too many crossings");
    };
    assert!((39_000..=41_000).contains(&found), "{found}");
}

#[test]
fn unusable_spacings_are_refused() {
    let cube = cuboid(Vec3::ONE);
    for spacing in [0.0, -0.01, f32::NAN, f32::INFINITY, 1e-9, 1e9] {
        let options = ScanOptions {
            spacing,
            ..ScanOptions::default()
        };
        let made = ColumnScanner::new(&cube.triangles, options);
        assert!(matches!(made, Err(Error::Spacing { .. })), "{spacing}");
    }
}

#[test]
fn an_open_surface_is_refused_by_its_first_open_edge() {
    let cube = cuboid(Vec3::ONE);
    let open = Triangles::new(8, &cube.triangles.corners()[1..]).unwrap();
    let Err(Error::OpenEdge {
        from,
        to,
        forward,
        backward,
    }) = ColumnScanner::new(&open, fine()).map(drop)
    else {
        panic!("expected an open edge");
    };
    // The missing triangle is 0, 2, 3.
    assert_eq!((from, to, forward, backward), (0, 2, 0, 1));
    let mut flipped = cube.triangles.corners().to_vec();
    flipped[4].swap(0, 1);
    let flipped = Triangles::new(8, &flipped).unwrap();
    assert!(matches!(
        ColumnScanner::new(&flipped, fine()),
        Err(Error::OpenEdge { .. })
    ));
}

#[test]
fn bad_triangles_and_labels_are_refused() {
    assert_eq!(
        Triangles::new(3, &[[0, 1, 3]]),
        Err(Error::VertexOutOfRange {
            triangle: 0,
            vertex: 3,
            vertex_count: 3
        })
    );
    assert_eq!(
        Triangles::new(3, &[[0, 1, 2], [1, 2, 1]]),
        Err(Error::RepeatedVertex {
            triangle: 1,
            vertex: 1
        })
    );
    assert_eq!(
        LabelDistances::new(&[0; 5]),
        Err(Error::LabelTableSize { found: 5 })
    );
    assert_eq!(
        LabelDistances::new(&[]),
        Err(Error::LabelTableSize { found: 0 })
    );
    let asymmetric = LabelDistances::new(&[0, 1, 2, 0]);
    assert_eq!(
        asymmetric,
        Err(Error::LabelDistance {
            row: 1,
            column: 0,
            found: 2,
            expected: 1
        })
    );
    let triangles = cuboid(Vec3::ONE).triangles;
    let distances = LabelDistances::new(&[0, 1, 1, 0]).unwrap();
    let short = TriangleLabels::new(&triangles, &[0; 3], distances.clone());
    assert_eq!(
        short,
        Err(Error::LabelCount {
            expected: 12,
            found: 3
        })
    );
    let mut labels = [1; 12];
    labels[9] = 2;
    let unknown = TriangleLabels::new(&triangles, &labels, distances);
    assert_eq!(
        unknown,
        Err(Error::LabelOutOfRange {
            triangle: 9,
            label: 2,
            label_count: 2
        })
    );
}

#[test]
fn nothing_covers_nothing() {
    let nothing = Triangles::new(0, &[]).unwrap();
    let volumes = ColumnScanner::new(&nothing, fine())
        .unwrap()
        .scan(&[])
        .unwrap()
        .volumes();
    assert_eq!(volumes, CoveredVolumes::default());
}

#[test]
fn a_thousand_nested_shells_are_counted_and_attributed() {
    let shells: Vec<Mesh> = (1..=1000)
        .map(|k| cuboid(Vec3::splat(k as f32 * 1e-4)))
        .collect();
    let mesh = Mesh::joined(&shells).unwrap();
    let mut scanner = ColumnScanner::new(&mesh.triangles, ScanOptions::default()).unwrap();
    let mut scan = scanner.scan(&mesh.positions).unwrap();
    let (mut greatest, mut sum) = (0, 0.0);
    scan.visit_overlaps(&TriangleLabels::uniform(&mesh.triangles), |overlap| {
        greatest = greatest.max(overlap.winding);
        sum += overlap.volume;
    })
    .unwrap();
    assert!(greatest > 800, "{greatest}");
    assert!((sum - scan.volumes().doubly_covered).abs() < 1e-12);
    assert!(winding_number(&mesh.triangles, &mesh.positions, DVec3::ZERO).unwrap() > 999.0);
}
