//! A motion goes from format to format and comes back, within millimetres that are printed.
//!
//! `cargo test -p physique --test round_trips -- --nocapture` prints the table of docs/reading.md.

use std::path::Path;

use physique::body::{Body, Joint, Sex, open_body_low};
use physique::load::{LoadOptions, Loaded, RotationsFrom, load, load_recording};
use physique::motion::features::{
    FeatureSkeleton, JointPositions, extract, write_features, write_positions,
};
use physique::motion::{Motion, Recording, SkeletonClip, amass, bvh, csv, embedded, native};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// A format on the way: its name, the file's, and how it is written.
struct Format {
    name: &'static str,
    file: &'static str,
    write: fn(&Path, &Body, &Motion) -> Outcome<()>,
}

const AMASS: Format = Format {
    name: "AMASS",
    file: "a.npz",
    write: |path, body, motion| {
        amass::write(path, motion, Some(body.rest_joint(Joint::Pelvis)))?;
        Ok(())
    },
};
const BVH: Format = Format {
    name: "BVH",
    file: "a.bvh",
    write: |path, body, motion| {
        let clip = SkeletonClip::from_motion(motion, &body.into())?;
        Ok(bvh::write_clip(
            path,
            &clip,
            &bvh::BvhWriteOptions::default(),
        )?)
    },
};
const NATIVE: Format = Format {
    name: "Physique",
    file: "a.motion.npz",
    write: |path, body, motion| {
        let recording = Recording {
            motion: motion.clone(),
            name: "a".into(),
            rest_pelvis: body.rest_joint(Joint::Pelvis),
            source: None,
            licence: None,
            notes: Vec::new(),
        };
        Ok(native::write(path, &recording)?)
    },
};
const POSITIONS: Format = Format {
    name: "positions .npy",
    file: "a.npy",
    write: |path, body, motion| Ok(write_positions(path, &positions(body, motion)?)?),
};
const POSITIONS_CSV: Format = Format {
    name: "positions CSV",
    file: "a.csv",
    write: |path, body, motion| Ok(csv::write_positions(path, &positions(body, motion)?)?),
};
const ROTATIONS_CSV: Format = Format {
    name: "rotations CSV",
    file: "b.csv",
    write: |path, body, motion| {
        let pelvis = body.rest_joint(Joint::Pelvis);
        Ok(csv::write_rotations(path, motion, pelvis)?)
    },
};
const FEATURES: Format = Format {
    name: "HumanML3D features",
    file: "f.npy",
    write: |path, body, motion| Ok(write_features(path, &extract(&positions(body, motion)?)?)?),
};

fn joints(body: &Body, motion: &Motion, frame: usize) -> Outcome<Vec<glam::Vec3>> {
    let mut world_from_joint = Vec::new();
    body.pose_joints(&motion.pose(frame), &mut world_from_joint)?;
    let positions = world_from_joint.iter().map(|at| at.translation.into());
    Ok(positions.take(Joint::COUNT).collect())
}

fn positions(body: &Body, motion: &Motion) -> Outcome<JointPositions> {
    let mut positions = Vec::new();
    for frame in 0..motion.frame_count() {
        positions.extend(joints(body, motion, frame)?);
    }
    let skeleton = FeatureSkeleton::HumanMl3d;
    Ok(JointPositions::new(
        motion.frame_rate(),
        skeleton,
        positions,
    )?)
}

/// Writes and reads a motion in each format in turn. AMASS and positions do not say all that is
/// needed: the rest pelvis and the frame rate are given.
fn through(
    formats: &[Format],
    body: &Body,
    motion: &Motion,
    options: &LoadOptions,
) -> Outcome<Loaded> {
    let folder = tempfile::tempdir()?;
    let mut options = options.clone();
    options.read.rest_pelvis = Some(body.rest_joint(Joint::Pelvis));
    options.read.frame_rate = Some(motion.frame_rate());
    let mut motion = motion.clone();
    let mut last = None;
    for format in formats {
        let path = folder.path().join(format.file);
        (format.write)(&path, body, &motion)?;
        let loaded = load(&path, body, &options)?;
        motion = loaded.motion.clone();
        last = Some(loaded);
    }
    last.ok_or_else(|| "no formats".into())
}

/// Mean and largest distance of joints in millimetres.
fn errors(body: &Body, before: &Motion, after: &Motion) -> Outcome<[f64; 2]> {
    assert_eq!(before.frame_count(), after.frame_count());
    let (mut sum, mut most) = (0.0, 0.0_f64);
    for frame in 0..before.frame_count() {
        let pairs = joints(body, before, frame)?;
        for (a, b) in pairs.iter().zip(joints(body, after, frame)?) {
            let distance = 1000.0 * f64::from(a.distance(b));
            sum += distance;
            most = most.max(distance);
        }
    }
    Ok([sum / (before.frame_count() * Joint::COUNT) as f64, most])
}

#[test]
fn motions_survive_the_way_from_format_to_format() -> Outcome<()> {
    let body = Body::mean(open_body_low()?, Sex::Neutral)?;
    println!("| way | mean, mm | largest, mm |\n|---|--:|--:|");
    for (way, allowed_mm) in [
        (vec![NATIVE], 1e-3),
        (vec![AMASS], 2e-3),
        (vec![BVH], 2e-3),
        (vec![ROTATIONS_CSV], 2e-3),
        (vec![POSITIONS], 2e-3),
        (vec![POSITIONS_CSV], 4e-3),
        (vec![AMASS, BVH, NATIVE], 4e-3),
        (vec![BVH, POSITIONS, AMASS], 4e-3),
        (vec![POSITIONS_CSV, NATIVE, ROTATIONS_CSV, BVH], 4e-3),
    ] {
        let names: Vec<_> = way.iter().map(|format| format.name).collect();
        let mut worst = [0.0_f64; 2];
        for clip in embedded::clips() {
            let motion = load_recording(clip.load()?, &body)?.motion;
            let back = through(&way, &body, &motion, &LoadOptions::default())?.motion;
            let found = errors(&body, &motion, &back)?;
            worst = [0, 1].map(|index| worst[index].max(found[index]));
        }
        let [mean, most] = worst;
        println!("| {} | {mean:.4} | {most:.4} |", names.join(" → "));
        assert!(most < allowed_mm, "{names:?}: {most} mm");
    }
    Ok(())
}

/// Features bring everybody to the data set's one skeleton, turn a clip to +Z, put it at the origin
/// and drop a frame: what can be compared is how well their joints are met.
#[test]
fn joints_of_features_are_met_where_the_papers_layer_misses_them() -> Outcome<()> {
    let body = Body::mean(open_body_low()?, Sex::Neutral)?;
    for clip in embedded::clips() {
        let motion = load_recording(clip.load()?, &body)?.motion;
        let options = LoadOptions::default();
        let back = through(&[FEATURES], &body, &motion, &options)?;
        let paper = LoadOptions {
            rotations: RotationsFrom::PaperLayer,
            ..options
        };
        let layer = through(&[FEATURES], &body, &motion, &paper)?;
        let fit = |loaded: &Loaded| loaded.mapping_summary().map(|fit| fit.mean_error_cm);
        let (ours, theirs) = (fit(&back).unwrap_or(99.0), fit(&layer).unwrap_or(0.0));
        println!(
            "{}: joints within {ours:.4} cm, by the paper's layer {theirs:.2} cm",
            clip.name
        );
        assert!(
            ours < 0.01 && theirs > 1.0,
            "{}: {ours}, {theirs} cm",
            clip.name
        );
        assert_eq!(back.motion.frame_count() + 1, motion.frame_count());
        let pelvis = back.motion.root_translation()[0] + body.rest_joint(Joint::Pelvis);
        assert!(pelvis.x.hypot(pelvis.z) < 1e-3, "{pelvis}");
    }
    Ok(())
}
