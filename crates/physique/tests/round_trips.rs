//! A motion goes from format to format and comes back, with errors in millimetres.
//!
//! `cargo test -p physique --test round_trips -- --nocapture` prints the table of docs/formats.md.

use std::path::Path;

use glam::{Quat, Vec3};
use physique::ExportFormat::{
    self, Amass, Bvh, Glb, HumanMl3d, Kit, Native, PositionCsv, Positions, RotationCsv,
};
use physique::body::{Body, Joint, Sex, open_body_low};
use physique::export::{ExportOptions, Provenance, export};
use physique::load::{LoadOptions, Loaded, RotationsFrom, load, load_recording};
use physique::motion::features::JointPositions;
use physique::motion::mapping::BodyRest;
use physique::motion::{FrameRate, Motion, embedded};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// A way through files, and what may be lost at most, in millimetres: of joints relative to the
/// pelvis, and of the pelvis.
struct Way {
    formats: &'static [ExportFormat],
    pose_mm: f32,
    path_mm: f32,
}

const fn way(formats: &'static [ExportFormat], pose_mm: f32, path_mm: f32) -> Way {
    Way {
        formats,
        pose_mm,
        path_mm,
    }
}

const WAYS: [Way; 14] = [
    way(&[Native], 1e-3, 1e-3),
    way(&[Bvh], 4e-3, 4e-3),
    way(&[Amass], 4e-3, 0.1),
    way(&[Glb], 4e-3, 4e-3),
    way(&[RotationCsv], 4e-3, 8e-3),
    way(&[PositionCsv], 4e-3, 8e-3),
    way(&[Positions], 4e-3, 8e-3),
    way(&[HumanMl3d], 0.1, 30.0),
    way(&[Kit], 80.0, 30.0),
    way(&[Bvh, Amass, Glb, Bvh], 8e-3, 0.1),
    way(&[Glb, RotationCsv, Native, Amass], 8e-3, 0.1),
    way(&[Bvh, Positions, Amass], 8e-3, 0.1),
    way(&[PositionCsv, Glb, RotationCsv, Bvh], 8e-3, 8e-3),
    way(&[Bvh, HumanMl3d, Positions, Glb], 0.1, 30.0),
];

/// The motion behind each file in turn; the last one as it was loaded.
fn through(
    formats: &[ExportFormat],
    body: &Body,
    motion: &Motion,
    options: &LoadOptions,
) -> Outcome<Loaded> {
    let folder = tempfile::tempdir()?;
    let (mut motion, mut last) = (motion.clone(), None);
    for format in formats {
        let path = folder.path().join(format!("motion.{}", format.ending()));
        write(&path, *format, body, &motion)?;
        let loaded = load(&path, body, options)?;
        motion = loaded.motion.clone();
        last = Some(loaded);
    }
    last.ok_or_else(|| "no formats".into())
}

fn write(path: &Path, format: ExportFormat, body: &Body, motion: &Motion) -> Outcome<()> {
    let options = ExportOptions::new(format);
    export(path, motion, body, Provenance::default(), &options)?;
    Ok(())
}

/// Mean and largest of distances.
#[derive(Clone, Copy, Default)]
struct Errors {
    sum: f64,
    count: usize,
    largest: f32,
}

impl Errors {
    fn add(&mut self, error: f32) {
        self.sum += f64::from(error);
        self.count += 1;
        self.largest = self.largest.max(error);
    }

    fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

/// Of poses and paths, in millimetres.
#[derive(Clone, Copy, Default)]
struct Lost {
    pose: Errors,
    path: Errors,
}

impl Lost {
    fn add(&mut self, body: &Body, before: &Motion, after: &Motion) -> Outcome<()> {
        let rest = BodyRest::from(body);
        let before = before.resampled(after.frame_rate())?;
        // Features of n frames have n - 1 rows.
        let shorter = before.frame_count() - after.frame_count();
        assert!(shorter <= 1, "{shorter} frames are lost");
        let [before, after] = [
            JointPositions::from_motion(&before, &rest)?,
            JointPositions::from_motion(after, &rest)?,
        ];
        let [(before_turn, before_start), (after_turn, after_start)] =
            [&before, &after].map(|motion| turn_and_start(motion.frame(0)));
        for frame in 0..after.frame_count() {
            let (a, b) = (before.frame(frame), after.frame(frame));
            let (pelvis_a, pelvis_b) = (before_turn * a[0], after_turn * b[0]);
            let way = (pelvis_a - before_start).distance(pelvis_b - after_start);
            self.path.add(1e3 * way);
            for (a, b) in a.iter().zip(b).skip(1) {
                let (a, b) = (before_turn * *a - pelvis_a, after_turn * *b - pelvis_b);
                self.pose.add(1e3 * a.distance(b));
            }
        }
        Ok(())
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

/// The embedded clips at 20 frames a second, which positions and features have.
fn clips(body: &Body) -> Outcome<Vec<Motion>> {
    let rate = FrameRate::new(20.0)?;
    let clips = embedded::clips().iter().map(|clip| {
        let motion = load_recording(clip.load()?, body)?.motion;
        Ok(motion.resampled(rate)?)
    });
    clips.collect()
}

#[test]
fn motions_survive_every_way_by_as_much_as_it_can_carry() -> Outcome<()> {
    let body = Body::mean(open_body_low()?, Sex::Neutral)?;
    let clips = clips(&body)?;
    println!("| way | pose: mean, mm | largest | pelvis: mean | largest |\n|---|--:|--:|--:|--:|");
    let mut too_far = Vec::new();
    for way in &WAYS {
        let mut lost = Lost::default();
        for motion in &clips {
            let back = through(way.formats, &body, motion, &LoadOptions::default())?;
            lost.add(&body, motion, &back.motion)?;
        }
        let names: Vec<&str> = way.formats.iter().map(|format| format.name()).collect();
        let names = names.join(" → ");
        let Lost { pose, path } = lost;
        println!(
            "| {names} | {:.4} | {:.4} | {:.4} | {:.4} |",
            pose.mean(),
            pose.largest,
            path.mean(),
            path.largest
        );
        if pose.largest > way.pose_mm || path.largest > way.path_mm {
            too_far.push(format!("{names}: {} and {} mm", pose.largest, path.largest));
        }
    }
    assert!(too_far.is_empty(), "{too_far:#?}");
    Ok(())
}

/// How well joints of features are met, by our inverse kinematics and by the papers' layer.
#[test]
fn joints_of_features_are_met_where_the_papers_layer_misses_them() -> Outcome<()> {
    let body = Body::mean(open_body_low()?, Sex::Neutral)?;
    for motion in clips(&body)? {
        let options = LoadOptions::default();
        let back = through(&[HumanMl3d], &body, &motion, &options)?;
        let paper = LoadOptions {
            rotations: RotationsFrom::PaperLayer,
            ..options
        };
        let layer = through(&[HumanMl3d], &body, &motion, &paper)?;
        let fit = |loaded: &Loaded| loaded.mapping_summary().map(|fit| fit.mean_error_cm);
        let (ours, theirs) = (fit(&back).unwrap_or(99.0), fit(&layer).unwrap_or(0.0));
        println!("joints within {ours:.4} cm, by the paper's layer {theirs:.2} cm");
        assert!(ours < 0.01 && theirs > 1.0, "{ours}, {theirs} cm");
        assert_eq!(back.motion.frame_count() + 1, motion.frame_count());
        let pelvis = back.motion.root_translation()[0] + body.rest_joint(Joint::Pelvis);
        assert!(pelvis.x.hypot(pelvis.z) < 1e-3, "{pelvis}");
    }
    Ok(())
}
