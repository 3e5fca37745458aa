//! Our own format: bit for bit there and back, and broken files say what is wrong.

#![allow(clippy::unwrap_used)]

use glam::{Quat, Vec3};
use physique_motion::npz::{Archive, ArchiveWriter, ArrayLimits};
use physique_motion::{
    Error, FrameRate, Limits, Motion, MotionShape, ReadOptions, Recording, ShapeSpace, native,
};
use proptest::prelude::*;

fn parse(bytes: &[u8], options: &ReadOptions) -> Result<Recording, Error> {
    let archive = Archive::open(bytes.to_vec(), ArrayLimits::default());
    let mut archive = archive.map_err(|problem| Error::Array {
        path: "walk.npz".into(),
        problem,
    })?;
    native::from_archive(&mut archive, "walk.npz", options)
}

fn recording(frames: usize) -> Recording {
    let wave = |n: usize| (n as f32 * 0.7 + 0.3).sin();
    let rotations = (0..frames * 22)
        .map(|n| Quat::from_xyzw(wave(n), wave(n + 1), wave(n + 2), wave(n + 5)).normalize());
    let shape = MotionShape {
        space: ShapeSpace::Open,
        gender: Some("female".into()),
        betas: vec![0.5, -1.25],
    };
    let translations = (0..frames).map(|n| Vec3::new(wave(n), wave(n + 3), wave(n + 9)));
    Recording {
        motion: Motion::new(
            FrameRate::new(60.002_400_1).unwrap(),
            Some(shape),
            translations.collect(),
            rotations.collect(),
        )
        .unwrap(),
        name: "a wäve".into(),
        rest_pelvis: Vec3::new(0.0, -0.22, 0.03),
        source: Some("made by a test".into()),
        licence: None,
        notes: vec!["One.".into(), "Two.".into()],
    }
}

#[test]
fn a_recording_comes_back_bit_for_bit() {
    let before = recording(5);
    let bytes = native::to_npz(&before).unwrap();
    let after = parse(&bytes, &ReadOptions::default()).unwrap();
    assert_eq!(after, before);
    for (a, b) in after
        .motion
        .rotations()
        .iter()
        .zip(before.motion.rotations())
    {
        assert_eq!(
            a.to_array().map(f32::to_bits),
            b.to_array().map(f32::to_bits)
        );
    }
    assert_eq!(native::to_npz(&after).unwrap(), bytes);
}

#[test]
fn a_bare_motion_comes_back() {
    let mut before = recording(1);
    let motion = &before.motion;
    before.motion = Motion::new(
        motion.frame_rate(),
        None,
        motion.root_translation().to_vec(),
        motion.rotations().to_vec(),
    )
    .unwrap();
    before.source = None;
    before.notes.clear();
    let bytes = native::to_npz(&before).unwrap();
    assert_eq!(parse(&bytes, &ReadOptions::default()).unwrap(), before);
}

#[test]
fn a_file_on_disk() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.motion.npz");
    native::write(&path, &recording(2)).unwrap();
    assert_eq!(
        native::read(&path, &ReadOptions::default()).unwrap(),
        recording(2)
    );
    let size = std::fs::metadata(&path).unwrap().len();
    let small = ReadOptions {
        limits: Limits {
            bytes: size - 1,
            ..Limits::default()
        },
        ..ReadOptions::default()
    };
    assert!(matches!(
        native::read(&path, &small),
        Err(Error::Limit { .. })
    ));
    let missing = native::read(folder.path().join("none"), &small).unwrap_err();
    assert!(missing.to_string().contains("none"));
}

#[test]
fn broken_files_say_what_is_wrong() {
    type Change = fn(&mut ArchiveWriter);
    let cases: [(&str, Change); 6] = [
        ("version 1, found 2", |file| {
            file.integer("physique_motion", 2).unwrap()
        }),
        ("`joints`", |file| {
            file.integer("physique_motion", 1).unwrap();
            file.text("joints", "tail").unwrap();
        }),
        ("frame rate", |file| {
            base(file, 0.0);
        }),
        ("`rotations`", |file| {
            base(file, 30.0);
            file.f32("rotations", &[1, 21, 4], &[0.5; 84]).unwrap();
        }),
        ("[1][3]", |file| {
            base(file, 30.0);
            file.f32("rotations", &[1, 22, 4], &[0.5; 88]).unwrap();
            file.f32("root_translation", &[2, 3], &[0.0; 6]).unwrap();
        }),
        ("Frame 0, joint spine1", |file| {
            base(file, 30.0);
            let mut rotations = [0.5; 88];
            rotations[13] = f32::NAN;
            file.f32("rotations", &[1, 22, 4], &rotations).unwrap();
            file.f32("root_translation", &[1, 3], &[0.0; 3]).unwrap();
            file.f32("rest_pelvis", &[3], &[0.0; 3]).unwrap();
        }),
    ];
    for (expected, change) in cases {
        let mut file = ArchiveWriter::new();
        change(&mut file);
        let error = parse(&file.finish().unwrap(), &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    }
}

fn base(file: &mut ArchiveWriter, frame_rate: f64) {
    let names = physique_body::Joint::ALL.map(physique_body::Joint::name);
    file.integer("physique_motion", 1).unwrap();
    file.text("joints", &names.join(" ")).unwrap();
    file.f64("frame_rate", &[], &[frame_rate]).unwrap();
}

#[test]
fn every_truncation_is_an_error() {
    let bytes = native::to_npz(&recording(2)).unwrap();
    for length in (0..bytes.len()).step_by(11) {
        assert!(
            parse(&bytes[..length], &ReadOptions::default()).is_err(),
            "{length}"
        );
    }
}

#[test]
fn more_frames_than_the_limit() {
    let bytes = native::to_npz(&recording(3)).unwrap();
    let options = ReadOptions {
        limits: Limits {
            frames: 2,
            ..Limits::default()
        },
        ..ReadOptions::default()
    };
    assert!(matches!(
        parse(&bytes, &options),
        Err(Error::Limit {
            found: 3,
            limit: 2,
            ..
        })
    ));
}

proptest! {
    #[test]
    fn flipped_bytes_never_panic(position in 0_usize..5000, byte: u8) {
        let mut bytes = native::to_npz(&recording(1)).unwrap();
        let position = position % bytes.len();
        bytes[position] = byte;
        let _ = parse(&bytes, &ReadOptions::default());
    }
}
