//! One motion in the files of many programs comes back as one motion.

#![allow(clippy::unwrap_used)]

use std::path::PathBuf;

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};
use physique_body::Joint;
use physique_files::read_file;
use physique_motion::npz::{Archive, ArchiveWriter, ArrayLimits};
use physique_motion::{
    Error, FrameRate, NamedMotion, ReadOptions, Recording, ShapeSpace, SourceMotion, UpAxis,
    parse_motions, read_motion, read_motions,
};

fn fixture(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures/arrays")
        .join(name)
}

/// `[frames][22]` rotations and `[frames]` places of the pelvis, Y up.
fn truth() -> (Vec<Quat>, Vec<Vec3>) {
    let bytes = read_file(&fixture("truth.npz"), 1 << 20).unwrap();
    let mut archive = Archive::open(bytes, ArrayLimits::default()).unwrap();
    let mut numbers = |key: &str| archive.array(key).unwrap().to_f64().unwrap();
    let rotations = numbers("rotations");
    let rotations = rotations.as_chunks::<9>().0.iter();
    let rotations = rotations.map(|rows| DMat3::from_cols_array(rows).transpose());
    let places = numbers("pelvis");
    let places = places.as_chunks::<3>().0.iter();
    (
        rotations
            .map(|turn| DQuat::from_mat3(&turn).as_quat())
            .collect(),
        places
            .map(|&place| DVec3::from_array(place).as_vec3())
            .collect(),
    )
}

fn body(motion: SourceMotion) -> Recording {
    match motion {
        SourceMotion::Body(recording) => recording,
        other => panic!("a motion of the body was expected, found {other:?}"),
    }
}

/// Largest angle in radians and largest distance in metres from the truth.
fn errors(recording: &Recording) -> (f32, f32) {
    let (rotations, places) = truth();
    let motion = &recording.motion;
    assert_eq!(motion.frame_count(), places.len());
    let angles = motion.rotations().iter().zip(&rotations);
    let angle = angles.map(|(a, b)| a.angle_between(*b)).fold(0.0, f32::max);
    let pelvis = motion
        .root_translation()
        .iter()
        .map(|step| *step + recording.rest_pelvis);
    let distances = pelvis.zip(&places).map(|(a, b)| a.distance(*b));
    (angle, distances.fold(0.0, f32::max))
}

#[test]
fn every_program_tells_the_same_motion() {
    for (name, format, rate, space) in [
        ("gvhmr.pt", "GVHMR results", 30.0, ShapeSpace::SmplX),
        ("wham.pkl#0", "WHAM results", 30.0, ShapeSpace::Smpl),
        ("wham.pkl#3", "WHAM results", 30.0, ShapeSpace::Smpl),
        ("wham_zlib.pkl#3", "WHAM results", 30.0, ShapeSpace::Smpl),
        ("aist.pkl", "AIST++", 60.0, ShapeSpace::Smpl),
        ("edge.pkl", "EDGE results", 30.0, ShapeSpace::Smpl),
        ("tram.npy", "TRAM results", 30.0, ShapeSpace::Smpl),
        ("parameters.npz", "SMPL parameters", 25.0, ShapeSpace::Smpl),
        ("phalp.pkl#7", "PHALP tracks", 30.0, ShapeSpace::Smpl),
        ("kimodo.npz", "Kimodo", 30.0, ShapeSpace::SmplX),
        ("motion_x.npy", "Motion-X", 30.0, ShapeSpace::SmplX),
        (
            "motion_streamer.npy",
            "MotionStreamer features",
            30.0,
            ShapeSpace::Smpl,
        ),
        (
            "hy_motion.npy",
            "HY-Motion features",
            30.0,
            ShapeSpace::Smpl,
        ),
        (
            "six_numbers.npy",
            "SMPL rotations in six numbers",
            30.0,
            ShapeSpace::Smpl,
        ),
        (
            "mdm_smpl_params.npy",
            "MDM rotations",
            20.0,
            ShapeSpace::Smpl,
        ),
    ] {
        let motions = read_motions(fixture(name), &ReadOptions::default());
        let mut motions = motions.unwrap_or_else(|error| panic!("{name}: {error}"));
        let NamedMotion {
            name: called,
            format: found,
            motion,
            ..
        } = motions.remove(0);
        assert!(motions.is_empty(), "{name}");
        assert_eq!((called.as_str(), found), (name, format));
        let recording = body(motion);
        let (angle, distance) = errors(&recording);
        println!("{name:22} {angle:.2e} rad, {:.4} mm", 1000.0 * distance);
        assert!(
            angle < 2e-3 && distance < 1e-6,
            "{name}: {angle} rad, {distance} m"
        );
        assert_eq!(recording.motion.frame_rate().per_second(), rate, "{name}");
        assert_eq!(recording.motion.shape().unwrap().space, space, "{name}");
    }
}

#[test]
fn what_was_guessed_is_noted() {
    let notes = |name: &str| {
        let read = read_motion(fixture(name), &ReadOptions::default()).unwrap();
        body(read).notes.join(" ")
    };
    for (name, word) in [
        ("gvhmr.pt", "30 frames a second were taken"),
        ("gvhmr.pt", "Of 4 rows of `betas`"),
        ("parameters.npz", "most upright with Z up"),
        ("six_numbers.npy", "behind the rotations"),
        ("six_numbers.npy", "one row of a matrix after the other"),
        ("six_numbers.npy", "SMPL's `trans`"),
        ("hy_motion.npy", "before the rotations"),
        ("hy_motion.npy", "pelvis's place"),
        ("motion_x.npy", "hands and jaw were left out"),
        ("phalp.pkl#7", "A camera sees the path"),
    ] {
        assert!(notes(name).contains(word), "{name}: {}", notes(name));
    }
    assert!(!notes("parameters.npz").contains("frames a second"));
}

#[test]
fn what_is_given_goes_before_what_is_guessed() {
    let options = ReadOptions {
        frame_rate: Some(FrameRate::new(50.0).unwrap()),
        up_axis: Some(UpAxis::Y),
        ..ReadOptions::default()
    };
    let recording = body(read_motion(fixture("parameters.npz"), &options).unwrap());
    assert_eq!(recording.motion.frame_rate().per_second(), 50.0);
    // The file is Z up: taken for Y up, the body lies.
    assert!((recording.motion.rotations()[0] * Vec3::Y).z > 0.8);
}

#[test]
fn several_people_are_several_motions() {
    let motions = read_motions(fixture("wham.pkl"), &ReadOptions::default()).unwrap();
    let names: Vec<_> = motions.iter().map(|motion| motion.name.as_str()).collect();
    assert_eq!(names, ["wham.pkl#0", "wham.pkl#3"]);
    let error = read_motion(fixture("wham.pkl"), &ReadOptions::default()).unwrap_err();
    assert!(
        matches!(error, Error::ManyMotions { found: 2, .. }),
        "{error}"
    );
    let motions = read_motions(fixture("phalp.pkl"), &ReadOptions::default()).unwrap();
    let names: Vec<_> = motions.iter().map(|motion| motion.name.as_str()).collect();
    assert_eq!(names, ["phalp.pkl#7", "phalp.pkl#9"]);
    // Seen in frames 1 and 3: what lies between is half of the way.
    let late = body(motions.into_iter().nth(1).unwrap().motion);
    let (rotations, places) = truth();
    let (turns, path) = (late.motion.rotations(), late.motion.root_translation());
    assert_eq!(path.len(), 3);
    let knee = Joint::LeftKnee.index();
    let half = rotations[22 + knee].slerp(rotations[3 * 22 + knee], 0.5);
    assert!(turns[22 + knee].angle_between(half) < 2e-3);
    let middle = path[1] + late.rest_pelvis;
    assert!(
        middle.distance(places[1].midpoint(places[3])) < 1e-5,
        "{middle}"
    );
    assert!(
        late.notes
            .iter()
            .any(|note| note.contains("1 frames in which"))
    );
    let text = read_motions(fixture("mdm_smpl_params.npy"), &ReadOptions::default()).unwrap();
    assert_eq!(text[0].text.as_deref(), Some("a person turns"));
}

#[test]
fn what_is_no_human_motion_is_named() {
    for (name, word) in [
        ("robot.pkl", "joint angles of a robot"),
        (
            "truth.npz",
            "a dictionary of `rotations`: an array [4][22][3][3]",
        ),
    ] {
        let error = read_motions(fixture(name), &ReadOptions::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains(name) && error.contains(word), "{error}");
    }
    for (joints, whose) in [(77, "SOMA"), (34, "Unitree G1")] {
        let mut archive = ArchiveWriter::new();
        let turns = vec![0.0; 2 * joints * 9];
        archive
            .f32("local_rot_mats", &[2, joints, 3, 3], &turns)
            .unwrap();
        archive.f32("root_positions", &[2, 3], &[0.0; 6]).unwrap();
        let error = parse_motions(archive.finish().unwrap(), "a.npz", &ReadOptions::default());
        let error = error.unwrap_err().to_string();
        assert!(
            error.contains(whose) && error.contains("SMPL-X model"),
            "{error}"
        );
    }
}
