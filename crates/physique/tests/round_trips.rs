//! What a motion loses on its way through every format, in millimetres: the table of
//! `docs/formats.md` (run with `--nocapture`).

#![allow(clippy::unwrap_used)]

use std::path::Path;

use glam::{Quat, Vec3};
use physique::body::{Body, Joint, Sex, open_body_low};
use physique::export::{ExportFormat, ExportOptions, Provenance, export};
use physique::load::{LoadOptions, load, load_recording};
use physique::motion::features::JointPositions;
use physique::motion::mapping::BodyRest;
use physique::motion::{FrameRate, Motion, embedded};

use ExportFormat::{Amass, Bvh, Glb, HumanMl3d, Kit, Native, PositionCsv, Positions, RotationCsv};

/// A way through files, and what may be lost: joints relative to the pelvis, and the pelvis.
struct Way {
    formats: &'static [ExportFormat],
    pose_mm: f32,
    path_mm: f32,
    rotation_degrees: f32,
}

const fn way(
    formats: &'static [ExportFormat],
    [pose_mm, path_mm, rotation_degrees]: [f32; 3],
) -> Way {
    Way {
        formats,
        pose_mm,
        path_mm,
        rotation_degrees,
    }
}

/// Largest errors over all joints and frames of three clips.
const WAYS: [Way; 11] = [
    way(&[Native], [1e-3, 1e-3, 0.0]),
    way(&[Bvh], [0.1, 0.1, 0.1]),
    way(&[Amass], [0.1, 0.1, 0.1]),
    way(&[Glb], [0.1, 0.1, 0.1]),
    way(&[RotationCsv], [0.1, 0.1, 0.1]),
    way(&[Bvh, Glb, Amass, RotationCsv, Bvh], [0.1, 0.1, 0.1]),
    way(&[PositionCsv], [1.0, 1.0, 180.0]),
    way(&[Positions], [1.0, 1.0, 180.0]),
    way(&[HumanMl3d], [1.0, 1.0, 180.0]),
    way(&[Kit], [1.0, 1.0, 180.0]),
    way(&[Bvh, HumanMl3d, Positions, Bvh], [1.0, 1.0, 180.0]),
];

fn rate(per_second: f64) -> FrameRate {
    FrameRate::new(per_second).unwrap()
}

/// The motion behind each file in turn.
fn through(motion: &Motion, body: &Body, formats: &[ExportFormat], folder: &Path) -> Motion {
    let mut motion = motion.clone();
    for format in formats {
        let path = folder.join(format!("motion.{}", format.ending()));
        let options = ExportOptions::new(*format);
        export(&path, &motion, body, Provenance::default(), &options).unwrap();
        motion = load(&path, body, &LoadOptions::default()).unwrap().motion;
    }
    motion
}

/// Mean and largest of distances or angles.
#[derive(Clone, Copy, Default)]
struct Error {
    sum: f64,
    count: usize,
    largest: f32,
}

impl Error {
    fn add(&mut self, error: f32) {
        self.sum += f64::from(error);
        self.count += 1;
        self.largest = self.largest.max(error);
    }

    fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

/// Features start above the origin and face +Z: the first frames of both are laid on each other.
fn turn_and_start(joints: &[Vec3]) -> (Quat, Vec3) {
    let across = joints[Joint::LeftHip.index()] - joints[Joint::RightHip.index()]
        + joints[Joint::LeftShoulder.index()]
        - joints[Joint::RightShoulder.index()];
    let forward = across.cross(Vec3::Y);
    let turn = Quat::from_rotation_y(-forward.x.atan2(forward.z));
    (turn, turn * Vec3::new(joints[0].x, 0.0, joints[0].z))
}

#[test]
fn motions_survive_every_format_by_as_much_as_it_can_carry() {
    let body = Body::mean(open_body_low().unwrap(), Sex::Neutral).unwrap();
    let rest = BodyRest::from(&body);
    let folder = tempfile::tempdir().unwrap();
    let mut too_far = Vec::new();
    println!("| way | pose: mean, max mm | path: mean, max mm | rotations: mean, max degrees |");
    println!("|---|--:|--:|--:|");
    for way in &WAYS {
        let [mut pose, mut path, mut turn] = [Error::default(); 3];
        for name in ["dance", "walk", "jump"] {
            let recording = embedded::clip(name).unwrap().load().unwrap();
            let original = load_recording(recording, &body).unwrap().motion;
            let original = original.resampled(rate(20.0)).unwrap();
            let result = through(&original, &body, way.formats, folder.path());
            let original = original.resampled(result.frame_rate()).unwrap();
            let [ours, theirs] = [&result, &original]
                .map(|motion| JointPositions::from_motion(motion, &rest).unwrap());
            // Features of n frames have n - 1 rows.
            let lost = original.frame_count() - result.frame_count();
            assert!(lost <= 1, "{name}: {lost} frames are lost");
            let (our_turn, our_start) = turn_and_start(ours.frame(0));
            let (their_turn, their_start) = turn_and_start(theirs.frame(0));
            for frame in 0..result.frame_count() {
                let (a, b) = (ours.frame(frame), theirs.frame(frame));
                let (pelvis, their_pelvis) = (our_turn * a[0], their_turn * b[0]);
                path.add(1e3 * (pelvis - our_start).distance(their_pelvis - their_start));
                for (a, b) in a.iter().zip(b).skip(1) {
                    let (a, b) = (our_turn * *a - pelvis, their_turn * *b - their_pelvis);
                    pose.add(1e3 * a.distance(b));
                }
                let locals = result.frame_rotations(frame).iter();
                for (a, b) in locals.zip(original.frame_rotations(frame)).skip(1) {
                    turn.add(a.angle_between(*b).to_degrees());
                }
            }
        }
        let names: Vec<&str> = way.formats.iter().map(|format| format.name()).collect();
        println!(
            "| {} | {:.3}, {:.3} | {:.3}, {:.3} | {:.2}, {:.1} |",
            names.join(" → "),
            pose.mean(),
            pose.largest,
            path.mean(),
            path.largest,
            turn.mean(),
            turn.largest
        );
        let found = [pose.largest, path.largest, turn.largest];
        let allowed = [way.pose_mm, way.path_mm, way.rotation_degrees];
        if found
            .iter()
            .zip(allowed)
            .any(|(found, allowed)| *found > allowed)
        {
            too_far.push(format!("{names:?}: {found:?} above {allowed:?}"));
        }
    }
    assert!(too_far.is_empty(), "{too_far:#?}");
}
