//! Writes the posed open body, its intersecting triangles and its sia volumes as text, for
//! `tools/compare_cgal/compare.py`: `cargo run --release --example dump_pairs -- FOLDER`.
#![allow(
    clippy::unwrap_used,
    reason = "an example for the developers of this crate"
)]

use std::fmt::Write;
use std::path::PathBuf;

use physique_geometry::sia::{SiaCounter, UnitBall};
use physique_geometry::{SharedVertices, TrianglePairs};

#[allow(dead_code, reason = "the labels are for the benchmarks")]
#[path = "../benches/fixtures/open_body.rs"]
mod open_body;

use open_body::{OpenBody, POSES};

fn main() {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or("pairs".into()));
    std::fs::create_dir_all(&folder).unwrap();
    let body = OpenBody::load();
    let rest = body.pose("rest");
    let ball = UnitBall::around(rest).unwrap();
    let mut counter = SiaCounter::new(&body.triangles).unwrap();
    let mut pairs = TrianglePairs::new(&body.triangles, rest, SharedVertices::Test).unwrap();
    for pose in POSES {
        let positions = body.pose(pose);
        let mut off = format!("OFF\n{} {} 0\n", positions.len(), body.triangles.len());
        for p in positions {
            // Nine digits carry an f32 exactly.
            writeln!(off, "{:.9e} {:.9e} {:.9e}", p.x, p.y, p.z).unwrap();
        }
        for [a, b, c] in body.triangles.corners() {
            writeln!(off, "3 {a} {b} {c}").unwrap();
        }
        std::fs::write(folder.join(format!("{pose}.off")), off).unwrap();

        let found = pairs.find(positions).unwrap();
        let lines: String = found.iter().map(|(a, b)| format!("{a} {b}\n")).collect();
        std::fs::write(folder.join(format!("{pose}.pairs")), lines).unwrap();

        let positions: Vec<_> = positions.iter().map(|&p| ball.ball_from_world(p)).collect();
        let points: String = positions
            .iter()
            .map(|p| format!("{:.9e} {:.9e} {:.9e}\n", p.x, p.y, p.z))
            .collect();
        std::fs::write(folder.join(format!("{pose}.ball")), points).unwrap();
        let counts = counter.counts(&positions).unwrap();
        let counts: String = counts.iter().map(|count| format!("{count}\n")).collect();
        std::fs::write(folder.join(format!("{pose}.counts")), counts).unwrap();
    }
}
