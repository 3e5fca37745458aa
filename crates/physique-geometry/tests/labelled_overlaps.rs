//! Which solids overlap, on labelled boxes that pass through each other.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use glam::Vec3;
use physique_geometry::shapes::cuboid;
use physique_geometry::{
    ColumnScanner, LabelDistances, Mesh, PairOverlap, PairOverlaps, ScanOptions, TriangleLabels,
};

/// Labelled meshes as one, all labels `apart` from each other.
struct Scene {
    mesh: Mesh,
    labels: TriangleLabels,
    label_count: usize,
}

impl Scene {
    fn new(parts: &[(u8, Mesh)], distance: impl Fn(u8, u8) -> u8) -> Self {
        let mesh = Mesh::joined(parts.iter().map(|(_, mesh)| mesh)).unwrap();
        let labels: Vec<u8> = parts
            .iter()
            .flat_map(|(label, mesh)| vec![*label; mesh.triangles.len()])
            .collect();
        let label_count = usize::from(*labels.iter().max().unwrap()) + 1;
        let all = || 0..label_count as u8;
        let table: Vec<u8> = all()
            .flat_map(|a| all().map(move |b| (a, b)))
            .map(|(a, b)| distance(a, b))
            .collect();
        let labels = TriangleLabels::new(
            &mesh.triangles,
            &labels,
            LabelDistances::new(&table).unwrap(),
        );
        Self {
            mesh,
            labels: labels.unwrap(),
            label_count,
        }
    }

    /// Overlaps by pair, after checking that they add up to the doubly covered volume.
    fn overlaps(&self) -> Vec<PairOverlap> {
        let options = ScanOptions::default();
        let mut scanner = ColumnScanner::new(&self.mesh.triangles, options).unwrap();
        let mut scan = scanner.scan(&self.mesh.positions).unwrap();
        let mut pairs = PairOverlaps::new(self.label_count);
        scan.add_overlaps(&self.labels, &mut pairs).unwrap();
        let overlaps: Vec<PairOverlap> = pairs.iter().collect();
        let sum: f64 = overlaps.iter().map(|pair| pair.volume).sum();
        assert_near(sum, scan.volumes().doubly_covered, 1e-12);
        overlaps
    }
}

fn brick(size: [f32; 3], centre: [f32; 3]) -> Mesh {
    cuboid(size.into()).translated(centre.into())
}

/// Labels on a line: the distance is their difference.
fn chain(a: u8, b: u8) -> u8 {
    a.abs_diff(b)
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not within {tolerance} of {expected}"
    );
}

#[track_caller]
fn assert_pair(pair: &PairOverlap, labels: [u8; 2], volume: f64, centre: [f32; 3]) {
    assert_eq!(pair.labels, labels);
    // Boxes whose edges are multiples of the spacing hold the same number of lines wherever they are.
    assert_near(pair.volume, volume, 1e-6);
    assert!(
        pair.centroid.distance(Vec3::from(centre)) < 0.005,
        "{}",
        pair.centroid
    );
}

#[test]
fn boxes_that_overlap_partly() {
    let parts = [
        (0, brick([0.2, 0.2, 0.2], [0.0; 3])),
        (1, brick([0.2, 0.2, 0.2], [0.1, 0.0, 0.15])),
    ];
    let [pair] = Scene::new(&parts, chain).overlaps()[..] else {
        panic!("one pair")
    };
    assert_pair(&pair, [0, 1], 0.1 * 0.2 * 0.05, [0.05, 0.0, 0.075]);
    assert_near(f64::from(pair.longest), 0.05, 1e-5);
    assert_near(f64::from(pair.most.z - pair.least.z), 0.05, 1e-5);
}

#[test]
fn a_box_inside_another() {
    let parts = [
        (3, brick([0.4; 3], [0.0; 3])),
        (1, brick([0.1; 3], [0.02, 0.0, -0.05])),
    ];
    let [pair] = Scene::new(&parts, chain).overlaps()[..] else {
        panic!("one pair")
    };
    assert_pair(&pair, [1, 3], 0.001, [0.02, 0.0, -0.05]);
}

#[test]
fn a_rod_through_a_plate() {
    let parts = [
        (0, brick([0.4, 0.4, 0.05], [0.0; 3])),
        (1, brick([0.1, 0.1, 0.6], [0.0; 3])),
    ];
    let [pair] = Scene::new(&parts, chain).overlaps()[..] else {
        panic!("one pair")
    };
    assert_pair(&pair, [0, 1], 0.1 * 0.1 * 0.05, [0.0; 3]);
}

/// What the winding number alone cannot tell: behind the overlap, which of the two goes on?
#[test]
fn where_two_solids_meet_a_third_the_labels_tell_which_one_does() {
    // Along z: 0 is entered, 4 is entered, 0 is left, 8 is entered, 4 is left, 8 is left.
    let parts = [
        (0, brick([0.2, 0.2, 0.2], [0.0, 0.0, 0.0])),
        (4, brick([0.2, 0.2, 0.3], [0.0, 0.0, 0.2])),
        (8, brick([0.2, 0.2, 0.2], [0.0, 0.0, 0.4])),
    ];
    let [first, second] = Scene::new(&parts, chain).overlaps()[..] else {
        panic!("two pairs")
    };
    assert_pair(&first, [0, 4], 0.2 * 0.2 * 0.05, [0.0, 0.0, 0.075]);
    assert_pair(&second, [4, 8], 0.2 * 0.2 * 0.05, [0.0, 0.0, 0.325]);
}

#[test]
fn of_three_solids_the_farthest_labels_are_told() {
    // All three cover the middle; 0 and 1 are neighbours, 5 is a stranger to both, most to 0.
    let parts = [
        (0, brick([0.2, 0.2, 0.4], [0.0, 0.0, 0.0])),
        (1, brick([0.2, 0.2, 0.4], [0.0, 0.0, 0.1])),
        (5, brick([0.2, 0.2, 0.1], [0.0, 0.0, 0.05])),
    ];
    let [crease, true_one] = Scene::new(&parts, chain).overlaps()[..] else {
        panic!("two pairs")
    };
    assert_pair(&crease, [0, 1], 0.2 * 0.2 * 0.2, [0.0, 0.0, 0.05]);
    assert_pair(&true_one, [0, 5], 0.2 * 0.2 * 0.1, [0.0, 0.0, 0.05]);
}

#[test]
fn a_solid_entered_by_one_label_and_left_by_another_counts_as_the_nearer_one() {
    // One box whose lower half (z < 0) is labelled 0 and whose upper half 1, pierced near its top.
    let body = brick([0.2, 0.2, 0.4], [0.0; 3]);
    let hand = brick([0.1, 0.1, 0.1], [0.0, 0.0, 0.2]);
    let mesh = Mesh::joined([&body, &hand]).unwrap();
    let labels: Vec<u8> = mesh
        .triangles
        .corners()
        .iter()
        .enumerate()
        .map(|(triangle, corners)| {
            let height: f32 = corners.iter().map(|&v| mesh.positions[v as usize].z).sum();
            if triangle >= 12 {
                4
            } else {
                u8::from(height > 0.0)
            }
        })
        .collect();
    let distances: Vec<u8> = (0..25).map(|k| (k / 5_u8).abs_diff(k % 5)).collect();
    let distances = LabelDistances::new(&distances).unwrap();
    let labels = TriangleLabels::new(&mesh.triangles, &labels, distances).unwrap();
    let [pair] = Scene {
        mesh,
        labels,
        label_count: 5,
    }
    .overlaps()[..] else {
        panic!("one pair")
    };
    assert_pair(&pair, [1, 4], 0.1 * 0.1 * 0.05, [0.0, 0.0, 0.175]);
}

#[test]
fn every_overlap_names_the_triangles_that_bound_its_solids() {
    let parts = [
        (0, brick([0.2; 3], [0.0; 3])),
        (1, brick([0.2; 3], [0.0, 0.0, 0.1])),
    ];
    let scene = Scene::new(&parts, chain);
    let mut scanner = ColumnScanner::new(&scene.mesh.triangles, ScanOptions::default()).unwrap();
    let mut scan = scanner.scan(&scene.mesh.positions).unwrap();
    let mut visited = 0;
    scan.visit_overlaps(&scene.labels, |overlap| {
        visited += 1;
        assert_eq!(overlap.winding, 2);
        assert!((overlap.start.z - 0.0).abs() < 1e-5 && (overlap.end.z - 0.1).abs() < 1e-5);
        let [first, second] = overlap.solids;
        assert!(first.enter_triangle < 12 && first.leave_triangle < 12);
        assert!(second.enter_triangle >= 12 && second.leave_triangle >= 12);
    })
    .unwrap();
    assert_eq!(visited, 20 * 20);
}
