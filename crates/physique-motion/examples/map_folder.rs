//! Maps every BVH file below the given folders to the open body and prints a row for each:
//! `cargo run --release -p physique-motion --example map_folder -- FOLDER... [--dump DIR]`.
//!
//! The columns say how the skeleton was understood, how far joints are from the source, and
//! whether the result is human: the share of bent frames in which knees and elbows bend the right
//! way, whether toes point forwards, how far wrists twist, how high the stance feet are.

use std::{
    error::Error,
    fs,
    path::{Path, PathBuf},
    time::Instant,
};

use glam::{Quat, Vec3};
use physique_body::{Body, Joint, open_body};
use physique_motion::{
    Motion, bvh,
    mapping::{BodyRest, MappingOptions, map_to_body},
};

fn main() -> Result<(), Box<dyn Error>> {
    let mut folders = Vec::new();
    let mut dump = None;
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--dump" => dump = arguments.next().map(PathBuf::from),
            _ => folders.push(PathBuf::from(argument)),
        }
    }
    let body = BodyRest::from(&Body::new(open_body()?, &[])?);
    println!(
        "file,joints by,axes by,fps,frames,scale,ground,mean cm,p95 cm,max cm,ankle max cm,\
         knees,elbows,toes,wrist twist p95,stance cm,forward,leg fix deg,notes"
    );
    let (mut files, mut failures, mut frames) = (0, 0, 0);
    let started = Instant::now();
    for path in folders.iter().flat_map(|folder| bvh_files(folder)) {
        files += 1;
        match row(&path, &body, dump.as_deref()) {
            Ok((count, row)) => {
                frames += count;
                println!("{},{row}", path.display());
            }
            Err(error) => {
                failures += 1;
                println!("{},FAILED {error}", path.display());
            }
        }
    }
    eprintln!(
        "{files} files, {failures} failures, {frames} frames in {:.1} s",
        started.elapsed().as_secs_f64()
    );
    Ok(())
}

/// BVH files below a folder, or the file itself, in order of name.
fn bvh_files(path: &Path) -> Vec<PathBuf> {
    if path.is_file() {
        return vec![path.into()];
    }
    let mut entries: Vec<PathBuf> = fs::read_dir(path)
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    entries.sort();
    let is_bvh = |path: &Path| {
        path.extension()
            .is_some_and(|ext| ext.eq_ignore_ascii_case("bvh"))
    };
    entries
        .into_iter()
        .flat_map(|entry| {
            if entry.is_dir() {
                bvh_files(&entry)
            } else if is_bvh(&entry) {
                vec![entry]
            } else {
                Vec::new()
            }
        })
        .collect()
}

fn row(
    path: &Path,
    body: &BodyRest,
    dump: Option<&Path>,
) -> Result<(usize, String), Box<dyn Error>> {
    let clip = bvh::read(path, &bvh::BvhOptions::default())?;
    let mapped = map_to_body(&clip, body, &MappingOptions::default())?;
    let (motion, report) = (&mapped.motion, &mapped.report);
    let checks = Checks::of(motion, body);
    let error = &report.fit_error;
    let ankle = error
        .by_joint
        .iter()
        .filter(|(joint, _)| matches!(joint, Joint::LeftAnkle | Joint::RightAnkle))
        .map(|(_, distances)| distances.max_cm)
        .fold(0.0, f32::max);
    if let Some(folder) = dump {
        write_positions(folder, path, motion, body)?;
    }
    let row = format!(
        "{},{},{:.2},{},{:.3},{:.3},{:.1},{:.1},{:.1},{ankle:.1},{},{:.1},{}",
        report.found_by,
        report.aligned_by.to_string().replace(',', ""),
        motion.frame_rate().per_second(),
        motion.frame_count(),
        report.scale,
        report.ground,
        error.all.mean_cm,
        error.all.percentile_95_cm,
        error.all.max_cm,
        checks.columns(),
        report.largest_leg_correction_degrees,
        report.notes.join("; ").replace(',', ""),
    );
    Ok((motion.frame_count(), row))
}

/// Is the motion human?
#[derive(Default)]
struct Checks {
    knees: Share,
    elbows: Share,
    toes: Share,
    wrist_twists: Vec<f32>,
    lowest_soles: Vec<f32>,
    /// Mean of the horizontal velocity along the body's facing, in m/s.
    forward: f32,
}

/// How many of some frames are as they should be.
#[derive(Default)]
struct Share {
    good: usize,
    all: usize,
}

impl Share {
    fn add(&mut self, good: bool) {
        self.good += usize::from(good);
        self.all += 1;
    }

    fn text(&self) -> String {
        if self.all == 0 {
            return "-".into();
        }
        format!("{:.3}", self.good as f64 / self.all as f64)
    }
}

impl Checks {
    fn of(motion: &Motion, body: &BodyRest) -> Self {
        let mut checks = Self::default();
        let rate = motion.frame_rate().per_second() as f32;
        let mut before: Option<Vec3> = None;
        for frame in 0..motion.frame_count() {
            let (world, positions) = pose(motion, body, frame);
            let at = |joint: Joint| positions[joint.index()];
            for [hip, knee, ankle, foot] in Joint::LEGS {
                let bend = (at(knee) - at(hip)).cross(at(ankle) - at(knee));
                // A knee bends about its left; the shin then carries the foot, which points on.
                let hinge = world[knee.index()] * Vec3::X;
                if bend.length() > 0.3 * (at(knee) - at(hip)).length_squared() {
                    checks.knees.add(bend.normalize().dot(hinge) > 0.5);
                }
                let toes = (at(foot) - at(ankle)).dot(world[knee.index()] * Vec3::Z);
                checks.toes.add(toes > 0.0);
            }
            for (shoulder, elbow, wrist, outward) in [
                (
                    Joint::LeftShoulder,
                    Joint::LeftElbow,
                    Joint::LeftWrist,
                    Vec3::X,
                ),
                (
                    Joint::RightShoulder,
                    Joint::RightElbow,
                    Joint::RightWrist,
                    Vec3::NEG_X,
                ),
            ] {
                let upper = at(elbow) - at(shoulder);
                let bend = upper.cross(at(wrist) - at(elbow));
                let hinge = world[shoulder.index()] * outward.cross(Vec3::Z);
                if bend.length() > 0.3 * upper.length_squared() {
                    checks.elbows.add(bend.normalize().dot(hinge) > 0.5);
                }
                let local = motion.frame_rotations(frame)[wrist.index()];
                checks.wrist_twists.push(twist_degrees(local, outward));
            }
            let sole = |joint: Joint| at(joint).y - body.height(joint);
            checks.lowest_soles.push(
                Joint::FEET
                    .map(sole)
                    .into_iter()
                    .fold(f32::INFINITY, f32::min),
            );
            let facing = (world[0] * Vec3::Z).with_y(0.0).normalize_or_zero();
            if let Some(before) = before {
                let step = (at(Joint::Pelvis) - before).with_y(0.0);
                checks.forward += step.dot(facing) * rate / motion.frame_count() as f32;
            }
            before = Some(at(Joint::Pelvis));
        }
        checks
    }

    fn columns(mut self) -> String {
        self.wrist_twists.sort_by(f32::total_cmp);
        self.lowest_soles.sort_by(f32::total_cmp);
        let part = |values: &[f32], of_100: usize| {
            values
                .get((values.len().max(1) - 1) * of_100 / 100)
                .copied()
                .unwrap_or(f32::NAN)
        };
        format!(
            "{},{},{},{:.0},{:.1},{:.2}",
            self.knees.text(),
            self.elbows.text(),
            self.toes.text(),
            part(&self.wrist_twists, 95),
            100.0 * part(&self.lowest_soles, 50),
            self.forward,
        )
    }
}

fn pose(
    motion: &Motion,
    body: &BodyRest,
    frame: usize,
) -> ([Quat; Joint::COUNT], [Vec3; Joint::COUNT]) {
    let local = motion.frame_rotations(frame);
    let mut world = [local[0]; Joint::COUNT];
    let root = body.joint(Joint::Pelvis) + motion.root_translation()[frame];
    let mut positions = [root; Joint::COUNT];
    for joint in Joint::ALL {
        if let Some(parent) = joint.parent() {
            let parent = parent.index();
            world[joint.index()] = world[parent] * local[joint.index()];
            positions[joint.index()] = positions[parent] + world[parent] * body.offset(joint);
        }
    }
    (world, positions)
}

/// Size of the turn of a rotation about an axis.
fn twist_degrees(rotation: Quat, axis: Vec3) -> f32 {
    let along = rotation.xyz().dot(axis);
    let degrees = (2.0 * along.atan2(rotation.w)).to_degrees();
    (degrees - 360.0 * (degrees / 360.0).round()).abs()
}

/// Joint positions as rows of 66 numbers, for plotting.
fn write_positions(
    folder: &Path,
    path: &Path,
    motion: &Motion,
    body: &BodyRest,
) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let rows: Vec<String> = (0..motion.frame_count())
        .map(|frame| {
            let (_, positions) = pose(motion, body, frame);
            let numbers = positions.iter().flat_map(|position| position.to_array());
            numbers
                .map(|number| format!("{number:.4}"))
                .collect::<Vec<_>>()
                .join(" ")
        })
        .collect();
    fs::write(folder.join(format!("{name}.txt")), rows.join("\n"))?;
    Ok(())
}
