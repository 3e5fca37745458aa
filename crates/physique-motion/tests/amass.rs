//! AMASS files: both forms against NumPy, the turn to Y up, round trips, and broken files.

#![allow(clippy::unwrap_used)]

use glam::{Quat, Vec3};
use physique_body::Joint;
use physique_motion::amass::{self, SMPL_REST_PELVIS};
use physique_motion::npz::{Archive, ArchiveWriter, ArrayLimits};
use physique_motion::{
    Error, FrameRate, Limits, Motion, MotionShape, ReadOptions, Recording, ShapeSpace, UpAxis,
};
use proptest::prelude::*;

const SMPLH: &[u8] = include_bytes!("fixtures/amass_smplh.npz");
const SMPLX: &[u8] = include_bytes!("fixtures/amass_smplx.npz");
const EXPECTED: &[u8] = include_bytes!("fixtures/amass_expected.npz");

fn open(bytes: &[u8]) -> Archive {
    Archive::open(bytes.to_vec(), ArrayLimits::default()).unwrap()
}

fn read(bytes: &[u8], options: &ReadOptions) -> Result<Recording, Error> {
    let archive = Archive::open(bytes.to_vec(), ArrayLimits::default());
    let mut archive = archive.map_err(|problem| Error::Array {
        path: "walk.npz".into(),
        problem,
    })?;
    amass::from_archive(&mut archive, "walk.npz", options)
}

/// A file of the named arrays, each filled with 0.1.
fn file(arrays: &[(&str, &[usize])], frame_rate: Option<(&str, f64)>) -> Vec<u8> {
    let mut writer = ArchiveWriter::new();
    for (key, shape) in arrays {
        let values = vec![0.1; shape.iter().product()];
        writer.f64(key, shape, &values).unwrap();
    }
    if let Some((key, rate)) = frame_rate {
        writer.f64(key, &[], &[rate]).unwrap();
    }
    writer.finish().unwrap()
}

/// World positions of the 22 joints of a frame, for a body with these rest joints.
fn joints(motion: &Motion, frame: usize, rest: &[Vec3]) -> Vec<Vec3> {
    let mut world: Vec<(Quat, Vec3)> = Vec::new();
    for joint in Joint::ALL {
        let rotation = motion.frame_rotations(frame)[joint.index()];
        world.push(match joint.parent() {
            None => (rotation, rest[0] + motion.root_translation()[frame]),
            Some(parent) => {
                let (parent_rotation, parent_position) = world[parent.index()];
                let offset = rest[joint.index()] - rest[parent.index()];
                (
                    parent_rotation * rotation,
                    parent_position + parent_rotation * offset,
                )
            }
        });
    }
    world.into_iter().map(|(_, position)| position).collect()
}

fn vectors(values: &[f32]) -> Vec<Vec3> {
    values.chunks_exact(3).map(Vec3::from_slice).collect()
}

#[test]
fn both_forms_land_where_numpy_does() {
    let mut expected = open(EXPECTED);
    let rest = vectors(&expected.array("rest").unwrap().to_f32().unwrap());
    let positions = vectors(&expected.array("joints").unwrap().to_f32().unwrap());
    let options = ReadOptions {
        rest_pelvis: Some(rest[0]),
        ..ReadOptions::default()
    };
    for bytes in [SMPLH, SMPLX] {
        let recording = read(bytes, &options).unwrap();
        assert_eq!(recording.motion.frame_count(), 4);
        for (frame, positions) in positions.chunks_exact(22).enumerate() {
            for (found, expected) in joints(&recording.motion, frame, &rest)
                .iter()
                .zip(positions)
            {
                assert!(found.distance(*expected) < 2e-6, "{found} {expected}");
            }
        }
    }
}

#[test]
fn what_the_files_say_is_kept() {
    let smplh = read(SMPLH, &ReadOptions::default()).unwrap();
    let shape = smplh.motion.shape().unwrap();
    assert_eq!(smplh.name, "walk");
    assert_eq!(smplh.motion.frame_rate().per_second(), 120.0);
    assert_eq!(shape.space, ShapeSpace::Smpl);
    assert_eq!(shape.gender.as_deref(), Some("female"));
    assert_eq!(shape.betas.len(), 16);
    assert_eq!(shape.betas[1], (2_f64).sin() as f32);
    assert_eq!(smplh.rest_pelvis, SMPL_REST_PELVIS);
    for word in ["hands", "dmpls", "rest pelvis"] {
        assert!(smplh.notes.iter().any(|note| note.contains(word)), "{word}");
    }
    let smplx = read(SMPLX, &ReadOptions::default()).unwrap();
    assert_eq!(smplx.motion.frame_rate().per_second(), 59.94);
    assert_eq!(smplx.motion.shape().unwrap().space, ShapeSpace::SmplX);
    assert_eq!(
        smplx.motion.shape().unwrap().gender.as_deref(),
        Some("male")
    );
}

#[test]
fn a_body_that_stands_on_the_floor_of_z_up_stands_on_ours() {
    // Rest pelvis 0.9 m above the origin and a turn that stands the body up along Z: in the file
    // the pelvis is at trans + J = (0.5, 0.25, 1): 1 m above the floor, 0.25 m along +Y.
    let pelvis = Vec3::new(0.0, 0.9, 0.1);
    let mut writer = ArchiveWriter::new();
    let mut pose = [0.0; 66];
    pose[0] = std::f64::consts::FRAC_PI_2;
    writer.f64("poses", &[1, 66], &pose).unwrap();
    writer
        .f64("trans", &[1, 3], &[0.5, 0.25 - 0.9, 1.0 - 0.1])
        .unwrap();
    writer.f64("mocap_framerate", &[], &[30.0]).unwrap();
    let bytes = writer.finish().unwrap();

    let options = ReadOptions {
        rest_pelvis: Some(pelvis),
        ..ReadOptions::default()
    };
    let motion = read(&bytes, &options).unwrap().motion;
    let stands_at = pelvis + motion.root_translation()[0];
    assert!(
        stands_at.distance(Vec3::new(0.5, 1.0, -0.25)) < 1e-6,
        "{stands_at}"
    );
    let upright = motion.frame_rotations(0)[0];
    assert!(upright.angle_between(Quat::IDENTITY) < 1e-6, "{upright}");

    let options = ReadOptions {
        up_axis: Some(UpAxis::Y),
        ..options
    };
    let motion = read(&bytes, &options).unwrap().motion;
    assert!((pelvis + motion.root_translation()[0]).distance(Vec3::new(0.5, 0.25, 1.0)) < 1e-6);
}

#[test]
fn pose_arrays_of_every_width() {
    let rate = Some(("mocap_framerate", 30.0));
    for (shape, left_out) in [
        (vec![2, 66], false),
        (vec![2, 72], true),
        (vec![2, 156], true),
        (vec![2, 165], true),
        (vec![2, 22, 3], false),
        (vec![2, 52, 3], true),
    ] {
        let bytes = file(&[("poses", &shape), ("trans", &[2, 3])], rate);
        let recording = read(&bytes, &ReadOptions::default()).unwrap();
        assert_eq!(recording.motion.frame_count(), 2);
        let noted = recording.notes.iter().any(|note| note.contains("left out"));
        assert_eq!(noted, left_out, "{shape:?}");
    }
    for shape in [
        vec![2, 63],
        vec![2, 67],
        vec![132],
        vec![2, 2, 33],
        vec![0, 66],
        vec![],
    ] {
        let bytes = file(&[("poses", &shape), ("trans", &[2, 3])], rate);
        // [2][2][33] has 66 numbers a frame and so is read; the others are refused.
        let result = read(&bytes, &ReadOptions::default());
        assert_eq!(result.is_ok(), shape == [2, 2, 33], "{shape:?}");
    }
}

#[test]
fn a_missing_frame_rate_is_asked_for_and_taken_from_the_options() {
    let bytes = file(&[("poses", &[1, 66]), ("trans", &[1, 3])], None);
    let error = read(&bytes, &ReadOptions::default())
        .unwrap_err()
        .to_string();
    for word in ["walk.npz", "mocap_framerate", "mocap_frame_rate", "option"] {
        assert!(error.contains(word), "{error}");
    }
    let given = ReadOptions {
        frame_rate: Some(FrameRate::new(25.0).unwrap()),
        ..ReadOptions::default()
    };
    assert_eq!(
        read(&bytes, &given)
            .unwrap()
            .motion
            .frame_rate()
            .per_second(),
        25.0
    );
    // What is given goes before what the file says.
    assert_eq!(
        read(SMPLH, &given)
            .unwrap()
            .motion
            .frame_rate()
            .per_second(),
        25.0
    );
}

#[test]
fn broken_files_say_where() {
    let rate = Some(("mocap_frame_rate", 30.0));
    let message = |bytes: &[u8]| {
        read(bytes, &ReadOptions::default())
            .unwrap_err()
            .to_string()
    };

    let no_poses = message(&file(&[("trans", &[1, 3])], rate));
    assert!(
        no_poses.contains("`poses`") && no_poses.contains("`trans`"),
        "{no_poses}"
    );
    let no_trans = message(&file(&[("poses", &[1, 66])], rate));
    assert!(no_trans.contains("`trans`"), "{no_trans}");
    let short = message(&file(&[("poses", &[3, 66]), ("trans", &[2, 3])], rate));
    assert!(
        short.contains("3 frames") && short.contains("2 frames"),
        "{short}"
    );
    for bad in [0.0, -30.0, f64::NAN] {
        let file = file(
            &[("poses", &[1, 66]), ("trans", &[1, 3])],
            Some(("mocap_framerate", bad)),
        );
        assert!(message(&file).contains("`mocap_framerate`"), "{bad}");
    }

    let mut writer = ArchiveWriter::new();
    let mut poses = vec![0.0; 3 * 66];
    poses[66 + 7] = f64::NAN;
    writer.f64("poses", &[3, 66], &poses).unwrap();
    writer.f64("trans", &[3, 3], &[0.0; 9]).unwrap();
    writer.f64("mocap_framerate", &[], &[30.0]).unwrap();
    let nan = message(&writer.finish().unwrap());
    assert!(
        nan.contains("`poses`, frame 1, column 7") && nan.contains("NaN"),
        "{nan}"
    );
}

#[test]
fn more_frames_than_the_limit() {
    let options = ReadOptions {
        limits: Limits {
            frames: 3,
            ..Limits::default()
        },
        ..ReadOptions::default()
    };
    assert!(matches!(
        read(SMPLH, &options),
        Err(Error::Limit {
            found: 4,
            limit: 3,
            ..
        })
    ));
}

#[test]
fn every_truncation_is_an_error() {
    for bytes in [SMPLH, SMPLX] {
        for length in (0..bytes.len()).step_by(7) {
            assert!(
                read(&bytes[..length], &ReadOptions::default()).is_err(),
                "{length}"
            );
        }
    }
}

#[test]
fn betas_of_the_open_body_are_not_passed_off_as_smpl() {
    let shape = MotionShape {
        space: ShapeSpace::Open,
        gender: None,
        betas: vec![1.0; 10],
    };
    let rate = FrameRate::new(30.0).unwrap();
    let motion = Motion::new(
        rate,
        Some(shape),
        vec![Vec3::ZERO],
        vec![Quat::IDENTITY; 22],
    )
    .unwrap();
    let written = amass::to_npz(&motion, None).unwrap();
    assert!(written.notes[0].contains("open body"));
    let betas = open(&written.bytes)
        .array("betas")
        .unwrap()
        .to_f64()
        .unwrap();
    assert_eq!(betas, [0.0; 16]);
}

fn quaternion() -> impl Strategy<Value = Quat> {
    let component = -1.0_f32..1.0;
    (
        component.clone(),
        component.clone(),
        component.clone(),
        component,
    )
        .prop_filter("a rotation of some length", |(x, y, z, w)| {
            x * x + y * y + z * z + w * w > 0.01
        })
        .prop_map(|(x, y, z, w)| Quat::from_xyzw(x, y, z, w).normalize())
}

proptest! {
    #[test]
    fn round_trip_in_microns_and_microradians(
        rotations in prop::collection::vec(quaternion(), 3 * 22),
        translations in prop::collection::vec(prop::array::uniform3(-10.0_f32..10.0), 3),
        betas in prop::collection::vec(-3.0_f32..3.0, 1..17),
        rate in 1.0_f64..240.0,
        pelvis in prop::array::uniform3(-1.0_f32..1.0),
        space in prop::sample::select(vec![ShapeSpace::Smpl, ShapeSpace::SmplX]),
    ) {
        let shape = MotionShape { space, gender: Some("male".into()), betas };
        let translations = translations.into_iter().map(Vec3::from_array).collect();
        let motion = Motion::new(FrameRate::new(rate).unwrap(), Some(shape), translations, rotations).unwrap();
        let pelvis = Vec3::from_array(pelvis);
        let written = amass::to_npz(&motion, Some(pelvis)).unwrap();
        let options = ReadOptions { rest_pelvis: Some(pelvis), ..ReadOptions::default() };
        let back = read(&written.bytes, &options).unwrap().motion;

        prop_assert_eq!(back.frame_rate(), motion.frame_rate());
        prop_assert_eq!(back.shape(), motion.shape());
        for (found, expected) in back.root_translation().iter().zip(motion.root_translation()) {
            prop_assert!(found.distance(*expected) < 1e-6, "{found} {expected}");
        }
        for (found, expected) in back.rotations().iter().zip(motion.rotations()) {
            // sin(angle / 2) of the rotation between them: twice that is radians.
            let between = (found.inverse() * *expected).xyz().length() * 2.0;
            prop_assert!(between < 1e-6, "{between} rad between {found} and {expected}");
        }
    }
}
