//! Points without a name: whose they are, which way is up, and what only looks like them.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says where")]

use glam::{Quat, Vec3};
use physique_motion::arrays::is_statistics_file;
use physique_motion::npz::{ArchiveWriter, npy_f32};
use physique_motion::{
    Error, Motion, PositionClip, ReadOptions, SourceMotion, UpAxis, embedded, parse_motion,
    parse_motions,
};

mod support;

/// `[frames][22]` joints of an embedded clip on the figure.
fn joints(motion: &Motion) -> Vec<Vec3> {
    let body = support::figure();
    let frames = 0..motion.frame_count();
    frames
        .flat_map(|frame| support::pose(motion, &body, frame).1)
        .collect()
}

fn npy(points: &[Vec3], joints: usize) -> Vec<u8> {
    let values: Vec<f32> = points.iter().flat_map(Vec3::to_array).collect();
    npy_f32(&[points.len() / joints, joints, 3], &values).unwrap()
}

fn read_with(bytes: Vec<u8>, options: &ReadOptions) -> Result<PositionClip, Error> {
    match parse_motion(bytes, "clip.npy", options)? {
        SourceMotion::Positions(clip) => Ok(clip),
        other => panic!("positions were expected, found {other:?}"),
    }
}

fn read(points: &[Vec3]) -> Result<PositionClip, Error> {
    read_with(npy(points, 22), &ReadOptions::default())
}

/// Turns each frame's points by a quarter so that what was up is Z.
fn z_up(points: &[Vec3]) -> Vec<Vec3> {
    points.iter().map(|p| Vec3::new(p.x, -p.z, p.y)).collect()
}

#[test]
fn standing_people_tell_their_up_axis() {
    for clip in embedded::clips() {
        let recording = clip.load().unwrap();
        let to_figure = recording.rest_pelvis - support::figure().joints[0];
        let joints = joints(&recording.motion).into_iter().map(|p| p + to_figure);
        let joints: Vec<Vec3> = joints.collect();
        let here = read(&joints).unwrap();
        assert_eq!(here.positions.positions(), joints, "{}", clip.name);
        assert_eq!(here.notes.len(), 1, "{:?}", here.notes);
        // Who lies on the ground or gets up from it says nothing about Z.
        if clip.name == "get_up" {
            continue;
        }
        let turned = read(&z_up(&joints)).unwrap();
        assert_eq!(turned.positions.positions(), joints, "{}", clip.name);
        assert!(turned.notes[1].contains("Z up"), "{:?}", turned.notes);
        let down: Vec<Vec3> = joints.iter().map(|p| Vec3::new(p.x, -p.y, -p.z)).collect();
        let turned = read(&down).unwrap();
        assert_eq!(turned.positions.positions(), joints, "{}", clip.name);
    }
}

#[test]
fn lying_and_crawling_people_are_not_stood_up() {
    let figure = support::figure();
    let lies_down = Quat::from_rotation_x(std::f32::consts::FRAC_PI_2);
    // On the belly, pelvis above the origin, breathing: the body is upright along Z, and rests at
    // a height of 2 cm.
    let rest = figure.joints.map(|p| lies_down * (p - figure.joints[0]));
    let lowest = rest.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
    for speed in [0.0, 0.01] {
        let points = (0..60).flat_map(|frame| {
            let breath = 0.01 * (frame as f32 * 0.3).sin().abs();
            let here = Vec3::new(0.0, 0.02 - lowest + breath, speed * frame as f32);
            rest.map(|p| p + here)
        });
        let points: Vec<Vec3> = points.collect();
        assert_eq!(read(&points).unwrap().positions.positions(), points);
    }
}

#[test]
fn an_up_axis_that_is_given_is_taken() {
    let walk = joints(&support::walk(10));
    let up = |up_axis| ReadOptions {
        up_axis: Some(up_axis),
        ..ReadOptions::default()
    };
    let as_z = read_with(npy(&z_up(&walk), 22), &up(UpAxis::Z)).unwrap();
    assert_eq!(as_z.positions.positions(), walk);
    let as_y = read_with(npy(&z_up(&walk), 22), &up(UpAxis::Y)).unwrap();
    assert_eq!(as_y.positions.positions(), z_up(&walk));
}

#[test]
fn joints_of_hands_are_left_out() {
    let walk = joints(&support::walk(10));
    for count in [24, 52, 55] {
        let all: Vec<Vec3> = walk
            .chunks(22)
            .flat_map(|frame| [frame, &vec![frame[20]; count - 22]].concat())
            .collect();
        let clip = read_with(npy(&all, count), &ReadOptions::default()).unwrap();
        assert_eq!(clip.positions.positions(), walk);
        let note = format!("Of {count} joints");
        assert!(clip.notes[1].contains(&note), "{:?}", clip.notes);
    }
}

#[test]
fn other_units_than_metres_are_brought_to_metres() {
    let walk = joints(&support::walk(10));
    for (units, name) in [
        (100.0, "centimetres"),
        (1000.0, "millimetres"),
        (39.37, "inches"),
    ] {
        let scaled: Vec<Vec3> = walk.iter().map(|&p| p * units).collect();
        let clip = read(&scaled).unwrap();
        assert!(clip.notes[1].contains(name), "{:?}", clip.notes);
        let pairs = clip.positions.positions().iter().zip(&walk);
        let largest = pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(largest < 1e-3, "{name}: {largest} m");
    }
    // A child is no adult in another unit.
    let small: Vec<Vec3> = walk.iter().map(|&p| p * 0.6).collect();
    assert_eq!(read(&small).unwrap().positions.positions(), small);
}

#[test]
fn rows_of_joints_and_rates_beside_arrays_are_read() {
    let walk: Vec<f32> = joints(&support::walk(8))
        .iter()
        .flat_map(Vec3::to_array)
        .collect();
    let flat = npy_f32(&[8, 66], &walk).unwrap();
    let clip = read_with(flat, &ReadOptions::default()).unwrap();
    assert_eq!(clip.positions.frame_count(), 8);
    let mut archive = ArchiveWriter::new();
    archive.f32("joints", &[8, 22, 3], &walk).unwrap();
    archive.integer("fps", 30).unwrap();
    let clip = read_with(archive.finish().unwrap(), &ReadOptions::default()).unwrap();
    assert_eq!(clip.positions.frame_rate().per_second(), 30.0);
    assert!(clip.notes.is_empty(), "{:?}", clip.notes);
}

#[test]
fn rotation_vectors_are_not_taken_for_positions() {
    for clip in embedded::clips() {
        let motion = clip.load().unwrap().motion;
        let turns = motion.rotations().iter().map(|turn| turn.to_scaled_axis());
        let error = read(&turns.collect::<Vec<_>>()).unwrap_err().to_string();
        for word in ["clip.npy", "look like rotations", "`poses` and `trans`"] {
            assert!(error.contains(word), "{}: {error}", clip.name);
        }
    }
    let scattered: Vec<Vec3> = (0..22 * 8)
        .map(|n| {
            let chance = |seed: f32| (seed + 12.9898 * n as f32).sin() * 4375.85 % 1.0;
            50.0 * Vec3::new(chance(0.0), chance(0.3), chance(0.7))
        })
        .collect();
    let error = read(&scattered).unwrap_err().to_string();
    assert!(error.contains("no person's proportions"), "{error}");
}

#[test]
fn stretched_bones_of_generators_are_still_a_persons() {
    let walk = joints(&support::walk(40));
    // Up to 6 cm this way and that, every joint for itself.
    let shaken: Vec<Vec3> = walk
        .iter()
        .enumerate()
        .map(|(n, &p)| {
            let n = n as f32;
            p + 0.06 * Vec3::new((n * 1.3).sin(), (n * 2.1).sin(), (n * 3.7).sin())
        })
        .collect();
    assert!(read(&shaken).is_ok());
}

#[test]
fn dictionaries_of_arrays_hold_a_motion_each() {
    let walk: Vec<f32> = joints(&support::walk(8))
        .iter()
        .flat_map(Vec3::to_array)
        .collect();
    let mut archive = ArchiveWriter::new();
    for name in ["000001", "000002"] {
        archive.f32(name, &[8, 22, 3], &walk).unwrap();
    }
    archive.f32("lengths", &[2], &[8.0, 8.0]).unwrap();
    let motions = parse_motions(
        archive.finish().unwrap(),
        "all.npz",
        &ReadOptions::default(),
    );
    let names = motions.unwrap().into_iter().map(|motion| motion.name);
    assert_eq!(
        names.collect::<Vec<_>>(),
        ["all.npz#000001", "all.npz#000002"]
    );
}

#[test]
fn statistics_are_named_and_no_motions() {
    let folder = tempfile::tempdir().unwrap();
    let row = |count: usize| npy_f32(&[count], &vec![0.5; count]).unwrap();
    let walk = npy(&joints(&support::walk(8)), 22);
    for (name, bytes, is_statistics, words) in [
        ("Mean.npy", row(263), true, "HumanML3D's 263 features"),
        ("Std.npy", row(251), true, "KIT-ML's 251 features"),
        ("t2m_mean.npy", row(263), true, "--mean or --std"),
        ("meta_272.npy", row(272), true, "272 numbers a frame"),
        ("std.npy", row(66), true, "66 numbers a frame"),
        ("lengths.npy", row(66), false, "the shape"),
        ("meander.npy", walk.clone(), false, ""),
        ("mean_walk.npy", walk, false, ""),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(is_statistics_file(&path), is_statistics, "{name}");
        match parse_motions(bytes, &path, &ReadOptions::default()) {
            Ok(_) => assert!(words.is_empty(), "{name}"),
            Err(error) => {
                let text = error.to_string();
                assert!(text.contains(words) && text.contains(name), "{text}");
                assert!(!words.is_empty(), "{text}");
            }
        }
    }
    assert!(!is_statistics_file(folder.path().join("none.npy")));
}
