//! How motion files keep their balance on the mean body, clip by clip, and the medians of all:
//! `cargo run --release --example balance -- walk.bvh ...`.
//!
//! Columns: frames, and those judged, without support and in flight; judged frames whose zero moment point is inside the base
//! of support, and within 2 cm of it; median signed distance (negative inside); height of the
//! centre of mass in per cent of the stature, and how far it is before the middle of the ankles.

use std::path::Path;

use glam::{DMat3, DVec3};
use physique::body::{Body, Joint, Sex, open_body};
use physique::load::{LoadOptions, load};
use physique::motion::Motion;
use physique::physics::{Physics, PhysicsMeasures, PhysicsOptions, Support};

/// One row of the table.
const COLUMNS: [&str; 9] = [
    "frames", "judged %", "unsup. %", "flight %", "inside %", "+2 cm %", "dist cm", "height %",
    "fore cm",
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let body = Body::mean(open_body()?, Sex::Neutral)?;
    let physics = Physics::new(&body)?;
    let mut rows = Vec::new();
    print_header();
    for file in std::env::args().skip(1) {
        let path = Path::new(&file);
        let motion = match load(path, &body, &LoadOptions::default()) {
            Ok(loaded) => loaded.motion,
            Err(problem) => {
                eprintln!("{problem}");
                continue;
            }
        };
        let found = physics.measure(&motion, &PhysicsOptions::default())?;
        let row = row(&physics, &motion, &found);
        print_row(&file, &row);
        rows.push(row);
    }
    let medians = std::array::from_fn(|column| median(rows.iter().map(|row| row[column])));
    print_row(&format!("median of {}", rows.len()), &medians);
    Ok(())
}

fn row(physics: &Physics, motion: &Motion, found: &PhysicsMeasures) -> [f64; 9] {
    let frames = found.frames.len() as f64;
    let percent = |count: usize, of: f64| 100.0 * count as f64 / of;
    let supported = |kind| found.frames.iter().filter(|f| f.support == kind).count();
    let distances = || found.frames.iter().filter_map(|f| f.zero_moment_distance_m);
    let judged = distances().count();
    let inside = |reach: f64| distances().filter(|&d| d < reach).count();
    let height = found.frames.iter().map(|f| f.centre_of_mass.y);
    let fore = found
        .frames
        .iter()
        .enumerate()
        .map(|(frame, found)| fore(physics, motion, frame, found.centre_of_mass));
    [
        frames,
        percent(judged, frames),
        percent(supported(Support::Nothing), frames),
        percent(supported(Support::Flight), frames),
        percent(inside(0.0), judged as f64),
        percent(inside(0.02), judged as f64),
        100.0 * median(distances()),
        100.0 * median(height) / physics.body().stature(),
        100.0 * median(fore),
    ]
}

/// How far a point is before the middle of the ankles, in the pelvis's heading.
fn fore(physics: &Physics, motion: &Motion, frame: usize, point: DVec3) -> f64 {
    let rotations = motion.frame_rotations(frame);
    let mut world_from_rest = Vec::new();
    physics.rig().pose(
        rotations.iter().map(|q| DMat3::from_quat(q.as_dquat())),
        motion.root_translation()[frame].as_dvec3(),
        &mut world_from_rest,
    );
    let at = |joint: Joint| {
        let rest = physics.rig().rest_joints()[joint.index()];
        world_from_rest[joint.index()].transform_point3(rest)
    };
    let left = at(Joint::LeftHip) - at(Joint::RightHip);
    let forwards = left.cross(DVec3::Y).normalize_or_zero();
    (point - at(Joint::LeftAnkle).midpoint(at(Joint::RightAnkle))).dot(forwards)
}

/// NaN of nothing.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<_> = values.filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn print_header() {
    print!("{:40}", "");
    COLUMNS.iter().for_each(|name| print!("{name:>10}"));
    println!();
}

fn print_row(name: &str, values: &[f64; 9]) {
    let begin = name.chars().count().saturating_sub(39);
    print!("{:40}", name.chars().skip(begin).collect::<String>());
    values.iter().for_each(|value| print!("{value:10.1}"));
    println!();
}
