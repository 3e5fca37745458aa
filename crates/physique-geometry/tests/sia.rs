//! The `sia` protocol against golden counts, and the fast counter against the published rule.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use glam::{DVec3, Vec3};
use npyz::Deserialize;
use npyz::npz::NpzArchive;
use physique_geometry::reference::{sia_counts, sia_volumes, winding_number};
use physique_geometry::shapes::{cuboid, icosphere};
use physique_geometry::sia::{POINTS_ASIDE, SiaCounter, UnitBall};
use physique_geometry::{Error, Mesh, Triangles};
use rayon::prelude::*;

const CASES: [&str; 5] = ["single", "overlap2", "overlap3", "flipped", "flipped_plus"];

struct Golden {
    triangles: Triangles,
    positions: Vec<Vec3>,
    counts: Vec<i32>,
    /// Self-intersection, volume and percent.
    metric: [f64; 3],
}

impl Golden {
    fn load(case: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/si_incount.npz");
        let mut archive = NpzArchive::open(path).unwrap();
        let coordinates: Vec<f32> = entry(&mut archive, case, "verts");
        let indices: Vec<i32> = entry(&mut archive, case, "faces");
        let counts: Vec<i8> = entry(&mut archive, case, "count");
        let metric: Vec<f64> = entry(&mut archive, case, "metric");
        let positions: Vec<Vec3> = coordinates
            .as_chunks()
            .0
            .iter()
            .map(|&p: &[f32; 3]| p.into())
            .collect();
        let corners: Vec<[u32; 3]> = indices
            .as_chunks()
            .0
            .iter()
            .map(|t: &[i32; 3]| t.map(|v| v as u32))
            .collect();
        Self {
            triangles: Triangles::new(positions.len(), &corners).unwrap(),
            positions,
            counts: counts.into_iter().map(i32::from).collect(),
            metric: metric.try_into().unwrap(),
        }
    }
}

fn entry<T: Deserialize>(
    archive: &mut NpzArchive<BufReader<File>>,
    case: &str,
    name: &str,
) -> Vec<T> {
    archive
        .by_name(&format!("{case}_{name}"))
        .unwrap()
        .unwrap()
        .into_vec()
        .unwrap()
}

#[track_caller]
fn assert_near(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() <= 1e-12 * expected.abs(),
        "{found} is not {expected}"
    );
}

#[test]
fn the_published_rule_gives_the_golden_counts() {
    // The slow rule takes seconds a mesh.
    CASES.into_par_iter().for_each(|case| {
        let golden = Golden::load(case);
        let counts = sia_counts(&golden.triangles, &golden.positions).unwrap();
        assert_eq!(counts, golden.counts, "{case}");
        let volumes = sia_volumes(&counts);
        assert_near(volumes.self_intersection_cm3, golden.metric[0]);
        assert_near(volumes.volume_cm3, golden.metric[1]);
        assert_near(volumes.percent().unwrap(), golden.metric[2]);
    });
}

/// The counter gives winding numbers; the published rule loses a point to a ray that grazes an edge.
/// Of the five golden meshes' 102,395 points in the ball that is one.
#[test]
fn the_counter_gives_the_golden_counts_but_for_a_grazing_ray() {
    let mut differing = Vec::new();
    for case in CASES {
        let golden = Golden::load(case);
        let mut counter = SiaCounter::new(&golden.triangles).unwrap();
        let counts = counter.counts(&golden.positions).unwrap();
        for (number, (&found, &published)) in counts.iter().zip(&golden.counts).enumerate() {
            if found != published {
                let winding = winding_number(&golden.triangles, &golden.positions, point(number));
                assert_near(winding.unwrap().round(), f64::from(found));
                differing.push((case, number, found, published));
            }
        }
        assert_eq!(
            counter.count(&golden.positions).unwrap(),
            sia_volumes(&counts),
            "{case}"
        );
    }
    assert_eq!(differing, [("flipped", 16530, -1, 0)]);
}

#[test]
fn every_count_in_the_ball_is_the_winding_number() {
    let golden = Golden::load("overlap3");
    let counts = SiaCounter::new(&golden.triangles)
        .unwrap()
        .counts(&golden.positions)
        .unwrap();
    // Every 11th point, to save time.
    let numbers = (0..counts.len()).into_par_iter().step_by(11);
    numbers.for_each(|number| {
        let in_ball = point(number).length_squared() <= 1.0;
        let winding = winding_number(&golden.triangles, &golden.positions, point(number)).unwrap();
        let expected = if in_ball { winding.round() as i32 } else { 0 };
        assert_eq!(counts[number], expected, "at {}", point(number));
    });
}

#[test]
fn parts_outside_the_ball_are_not_counted() {
    let inside = icosphere(0.3, 3);
    let both = Mesh::joined([
        &inside,
        &inside.clone().translated(Vec3::new(0.0, 5.0, 1.2)),
    ])
    .unwrap();
    let mut alone = SiaCounter::new(&inside.triangles).unwrap();
    let mut counter = SiaCounter::new(&both.triangles).unwrap();
    assert_eq!(
        counter.count(&both.positions).unwrap(),
        alone.count(&inside.positions).unwrap()
    );
}

#[test]
fn the_unit_ball_holds_the_rest_pose() {
    let brick = cuboid(Vec3::new(0.4, 1.6, 0.3)).translated(Vec3::new(3.0, 0.9, -1.0));
    let ball = UnitBall::around(&brick.positions).unwrap();
    assert!(ball.centre.distance(Vec3::new(3.0, 0.9, -1.0)) < 1e-6);
    let farthest = brick
        .positions
        .iter()
        .map(|&p| ball.ball_from_world(p).length())
        .fold(0.0, f32::max);
    assert!((farthest - 1.0).abs() < 1e-6);
}

#[test]
fn hostile_input_is_refused() {
    let mut sphere = icosphere(0.5, 1);
    let mut counter = SiaCounter::new(&sphere.triangles).unwrap();
    let rest = sphere.positions.clone();
    for (bad, name) in [
        (f32::NAN, "NotFinite"),
        (f32::INFINITY, "NotFinite"),
        (1e30, "OutsideUnitBall"),
    ] {
        sphere.positions[7].z = bad;
        let error = counter.count(&sphere.positions).unwrap_err();
        assert!(format!("{error:?}").starts_with(name), "{error:?}");
    }
    assert!(matches!(UnitBall::around(&[]), Err(Error::NoExtent { .. })));
    assert!(matches!(
        UnitBall::around(&[Vec3::ONE; 3]),
        Err(Error::NoExtent { .. })
    ));
    // The last bad position, 1e30, has a square beyond f32.
    assert!(matches!(
        UnitBall::around(&sphere.positions),
        Err(Error::NoExtent { .. })
    ));
    sphere.positions[7].z = f32::NAN;
    assert!(matches!(
        UnitBall::around(&sphere.positions),
        Err(Error::NotFinite { vertex: 7, .. })
    ));
    // Still usable.
    assert!(counter.count(&rest).unwrap().volume_cm3 > 0.0);
}

/// Point number `number` of the grid, x slowest, z fastest.
fn point(number: usize) -> DVec3 {
    let side = POINTS_ASIDE;
    let index = DVec3::new(
        (number / side / side) as f64,
        (number / side % side) as f64,
        (number % side) as f64,
    );
    index * 2.0 / (side - 1) as f64 - 1.0
}
