//! What a body costs: column scan, `sia` voxels and intersecting triangles of the open body
//! (13,776 triangles) in four poses, one thread. Run with `cargo bench -p physique-geometry`.
#![allow(clippy::expect_used, reason = "a benchmark has no one to report to")]

use divan::{Bencher, black_box, counter::ItemsCount};
use glam::Vec3;
use physique_geometry::sia::{SiaCounter, UnitBall};
use physique_geometry::{
    ColumnScanner, NearestSurface, PairOverlaps, ScanOptions, SharedVertices, SignedDistances,
    TrianglePairs, space_filling_order,
};

#[path = "fixtures/open_body.rs"]
mod open_body;

use open_body::{OpenBody, POSES};

fn main() {
    divan::main();
}

#[divan::bench(args = POSES, consts = [10, 20])]
fn covered_volumes<const MILLIMETRES: u32>(bencher: Bencher<'_, '_>, pose: &str) {
    let body = OpenBody::load();
    let positions = body.pose(pose);
    let options = ScanOptions {
        spacing: MILLIMETRES as f32 * 1e-3,
        ..ScanOptions::default()
    };
    let mut scanner = ColumnScanner::new(&body.triangles, options).expect("closed");
    bencher.bench_local(|| {
        scanner
            .scan(black_box(positions))
            .expect("finite")
            .volumes()
    });
}

#[divan::bench(args = POSES)]
fn overlaps_by_body_part(bencher: Bencher<'_, '_>, pose: &str) {
    let body = OpenBody::load();
    let positions = body.pose(pose);
    let mut scanner = ColumnScanner::new(&body.triangles, ScanOptions::default()).expect("closed");
    let mut pairs = PairOverlaps::new(22);
    bencher.bench_local(|| {
        pairs.clear();
        let mut scan = scanner.scan(black_box(positions)).expect("finite");
        scan.add_overlaps(&body.labels, &mut pairs)
            .expect("one label a triangle");
        scan.volumes()
    });
}

#[divan::bench(args = POSES)]
fn sia_voxels(bencher: Bencher<'_, '_>, pose: &str) {
    let body = OpenBody::load();
    let ball = UnitBall::around(body.pose("rest")).expect("has extent");
    let positions: Vec<_> = body
        .pose(pose)
        .iter()
        .map(|&p| ball.ball_from_world(p))
        .collect();
    let mut counter = SiaCounter::new(&body.triangles).expect("closed");
    bencher.bench_local(|| counter.count(black_box(&positions)).expect("finite"));
}

#[divan::bench(args = POSES)]
fn triangle_pairs(bencher: Bencher<'_, '_>, pose: &str) {
    find_pairs(bencher, pose, SharedVertices::Skip);
}

#[divan::bench(args = POSES)]
fn triangle_pairs_with_shared_vertices(bencher: Bencher<'_, '_>, pose: &str) {
    find_pairs(bencher, pose, SharedVertices::Test);
}

fn find_pairs(bencher: Bencher<'_, '_>, pose: &str, shared: SharedVertices) {
    let body = OpenBody::load();
    let mut pairs = TrianglePairs::new(&body.triangles, body.pose("rest"), shared).expect("finite");
    let positions = body.pose(pose);
    bencher.bench_local(|| pairs.find(black_box(positions)).expect("finite").len());
}

/// 100,000 points up to 7 cm from the skin, along a space-filling curve.
#[divan::bench]
fn signed_distances(bencher: Bencher<'_, '_>) {
    let body = OpenBody::load();
    let skin = body.pose("rest");
    let distances = SignedDistances::new(&body.triangles, skin).expect("closed");
    let points: Vec<Vec3> = (0..100_000_u32)
        .map(|number| {
            // Fractions of multiples of irrational numbers are spread evenly.
            let spread = |ratio: f64| (f64::from(number) * ratio).fract() as f32 - 0.5;
            let near = skin[number as usize % skin.len()];
            near + 0.14 * Vec3::new(spread(0.819_173), spread(0.671_044), spread(0.549_701))
        })
        .collect();
    let order = space_filling_order(&points);
    let points: Vec<Vec3> = order.iter().map(|&index| points[index as usize]).collect();
    let mut nearest = vec![NearestSurface::UNKNOWN; points.len()];
    bencher
        .counter(ItemsCount::new(points.len()))
        .bench_local(|| distances.fill(black_box(&points), &mut nearest));
}

#[divan::bench]
fn prepare_signed_distances(bencher: Bencher<'_, '_>) {
    let body = OpenBody::load();
    let skin = body.pose("rest");
    bencher.bench_local(|| SignedDistances::new(&body.triangles, black_box(skin)).expect("closed"));
}
