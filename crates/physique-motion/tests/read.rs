//! One door: formats are known by their content.

#![allow(clippy::unwrap_used)]

use physique_motion::npz::ArchiveWriter;
use physique_motion::{
    Error, FrameRate, Limits, ReadOptions, Recording, SkeletonClip, SourceMotion, embedded, native,
    parse_motion, read_motion,
};

const BVH: &str = "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 0 0\n\tCHANNELS 6 Xposition Yposition Zposition \
    Zrotation Xrotation Yrotation\n\tJOINT Leg\n\t{\n\t\tOFFSET 0 -80 0\n\t\tCHANNELS 3 Zrotation Xrotation \
    Yrotation\n\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 -80 0\n\t\t}\n\t}\n}\nMOTION\nFrames: 1\nFrame Time: 0.05\n\
    0 160 0 0 0 0 0 0 0\n";

fn parse(bytes: impl Into<Vec<u8>>) -> Result<SourceMotion, Error> {
    parse_motion(bytes.into(), "some.file", &ReadOptions::default())
}

fn skeleton(source: SourceMotion) -> SkeletonClip {
    match source {
        SourceMotion::Skeleton(clip) => clip,
        other => panic!("a skeleton was expected, found {other:?}"),
    }
}

fn body(source: SourceMotion) -> Recording {
    match source {
        SourceMotion::Body(recording) => recording,
        other => panic!("a motion of the body was expected, found {other:?}"),
    }
}

fn deep_mimic() -> String {
    let mut row = [0.0; 44];
    row[0] = 0.1;
    for at in [4, 8, 12, 16, 21, 25, 30, 35, 39] {
        row[at] = 1.0;
    }
    format!("{{\"Loop\": \"none\", \"Frames\": [{row:?}, {row:?}]}}")
}

#[test]
fn every_format_is_known_by_its_content() {
    assert_eq!(skeleton(parse(BVH).unwrap()).skeleton().joint_count(), 2);
    let commented = format!(
        "\u{feff}\n# exported\r\n// by hand\n{}",
        BVH.replacen("HIERARCHY", "Hierarchy", 1)
    );
    assert_eq!(
        skeleton(parse(commented).unwrap()).skeleton().joint_count(),
        2
    );
    assert_eq!(
        skeleton(parse(deep_mimic()).unwrap())
            .skeleton()
            .joint_count(),
        15
    );
    for bytes in [
        include_bytes!("fixtures/amass_smplh.npz").as_slice(),
        include_bytes!("fixtures/amass_smplx.npz"),
    ] {
        let recording = body(parse(bytes).unwrap());
        assert_eq!(
            (recording.name.as_str(), recording.motion.frame_count()),
            ("some", 4)
        );
    }
    let walk = embedded::clip("walk").unwrap().load().unwrap();
    assert_eq!(body(parse(native::to_npz(&walk).unwrap()).unwrap()), walk);
}

#[test]
fn a_file_of_no_known_format_is_told_what_it_looks_like() {
    let mut archive = ArchiveWriter::new();
    archive.f64("joints", &[1], &[0.0]).unwrap();
    for (bytes, expected) in [
        (Vec::new(), "an empty file"),
        (b"Kaydara FBX Binary".to_vec(), "FBX"),
        // A pickle of an empty list.
        (b"\x80\x02].".to_vec(), "a list of 0"),
        (b"{\"poses\": []}".to_vec(), "JSON, but neither glTF"),
        (b"hello, world".to_vec(), "begins with `hello, world`"),
        (
            format!("0.1,0.2,0.79,0,0,0.6,0.8{}\n", ",0.1".repeat(29)).into_bytes(),
            "29 joint angles",
        ),
        (b"1.5, 2, 3\n4, 5, 6\n".to_vec(), "lines of 3 numbers"),
        (b"# only a comment".to_vec(), "begins with ``"),
        (archive.finish().unwrap(), "`joints`: an array [1]"),
    ] {
        let error = parse(bytes).unwrap_err();
        assert!(matches!(error, Error::UnknownFormat { .. }), "{error}");
        let message = error.to_string();
        for word in ["some.file", expected, "BVH", "AMASS", "DeepMimic"] {
            assert!(message.contains(word), "{message}");
        }
    }
}

#[test]
fn a_given_frame_rate_goes_before_the_files() {
    let options = ReadOptions {
        frame_rate: Some(FrameRate::new(24.0).unwrap()),
        ..ReadOptions::default()
    };
    let walk = native::to_npz(&embedded::clip("walk").unwrap().load().unwrap()).unwrap();
    let amass = include_bytes!("fixtures/amass_smplh.npz").to_vec();
    for bytes in [BVH.into(), deep_mimic().into_bytes(), walk, amass] {
        let frame_rate = match parse_motion(bytes, "a", &options).unwrap() {
            SourceMotion::Skeleton(clip) => clip.frame_rate(),
            SourceMotion::Body(recording) => recording.motion.frame_rate(),
            SourceMotion::Positions(clip) => clip.positions.frame_rate(),
        };
        assert_eq!(frame_rate.per_second(), 24.0);
    }
}

#[test]
fn files_on_disk_keep_the_limit_on_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.bvh");
    std::fs::write(&path, BVH).unwrap();
    assert!(read_motion(&path, &ReadOptions::default()).is_ok());
    let options = ReadOptions {
        limits: Limits {
            bytes: BVH.len() as u64 - 1,
            ..Limits::default()
        },
        ..ReadOptions::default()
    };
    assert!(matches!(
        read_motion(&path, &options),
        Err(Error::Limit { .. })
    ));
    assert!(matches!(
        read_motion(folder.path().join("none"), &options),
        Err(Error::Io { .. })
    ));
}

#[test]
fn the_cause_of_an_error_is_told_once() {
    let missing = read_motion("no/such/file.bvh", &ReadOptions::default()).unwrap_err();
    assert!(missing.to_string().contains("os error"), "{missing}");
    // A report of the whole chain would say it again.
    assert!(std::error::Error::source(&missing).is_none());
    let broken = parse(b"PK\x03\x04 and no more".to_vec()).unwrap_err();
    assert!(std::error::Error::source(&broken).is_none(), "{broken}");
}
