//! What BVH files say, what they leave open, and what hostile ones do.

mod support;

use glam::Vec3;
use physique_body::Joint;
use physique_motion::{
    Error, FrameRate, Limits, SkeletonClip, UpAxis,
    bvh::{self, BvhOptions, BvhWriteOptions, LengthUnit, PositionChannels},
    mapping::{MappingOptions, map_to_body},
};
use proptest::prelude::*;
use support::{Rig, figure, largest_distance, largest_turn, walk};

const SMALL: &str = "HIERARCHY
ROOT Hips
{
    OFFSET 0 100 0
    CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
    JOINT Spine
    {
        OFFSET 0 50 0
        CHANNELS 3 Zrotation Xrotation Yrotation
        End Site
        {
            OFFSET 0 80 0
        }
    }
    JOINT Leg
    {
        OFFSET 10 -90 0
        CHANNELS 0
        End Site
        {
            OFFSET 0 0 12
        }
    }
}
MOTION
Frames: 2
Frame Time: 0.0333333
0 1 0 0 0 0 0 0 0
5 2 0 90 0 0 0 0 90
";

fn parse(text: &str) -> Result<SkeletonClip, Error> {
    bvh::parse(text.as_bytes(), "test.bvh", &BvhOptions::default())
}

#[test]
fn a_small_file_is_read_to_the_letter() {
    let clip = parse(SMALL).unwrap();
    assert_eq!(clip.frame_count(), 2);
    assert_eq!(clip.frame_rate().per_second(), 30.0);
    assert_eq!(clip.conversion().metres_per_unit, 0.01);
    let pose = clip.pose(1);
    // Z by 90 degrees first, so the spine lies along -X; the leg's channels are none.
    let near = |at: Vec3, x: f32, y: f32, z: f32| at.distance(Vec3::new(x, y, z)) < 1e-5;
    assert!(
        near(pose.positions[0], 0.05, 1.02, 0.0),
        "{}",
        pose.positions[0]
    );
    assert!(
        near(pose.positions[1], -0.45, 1.02, 0.0),
        "{}",
        pose.positions[1]
    );
    assert!(
        near(pose.positions[2], 0.95, 1.12, 0.0),
        "{}",
        pose.positions[2]
    );
    let turned = pose.rotations[1] * Vec3::Z;
    assert!(turned.distance(Vec3::Y) < 1e-5, "{turned}");
}

#[test]
fn habits_of_exporters_change_nothing() {
    let plain = parse(SMALL).unwrap();
    for (what, text) in [
        ("carriage returns", SMALL.replace('\n', "\r\n")),
        ("tabs", SMALL.replace("    ", "\t")),
        (
            "lower case",
            SMALL
                .replace("ROOT", "root")
                .replace("OFFSET", "offset")
                .replace("Xposition", "XPOSITION")
                .replace("Frames:", "frames:"),
        ),
        (
            "comments",
            SMALL.replace("MOTION", "# a comment\nMOTION // here"),
        ),
        (
            "exponents",
            SMALL.replace("5 2 0 90", "5e0 +2.0 -0e-9 9.0E1"),
        ),
        ("no last line end", SMALL.trim_end().to_owned()),
        (
            "blank lines",
            SMALL.replace("5 2 0", "\n  \n5 2 0") + "\n\n",
        ),
        ("a byte order mark", format!("\u{feff}{SMALL}")),
        (
            "a brace on the line",
            SMALL.replace("ROOT Hips\n{", "ROOT Hips {"),
        ),
    ] {
        assert_eq!(parse(&text).unwrap(), plain, "{what}");
    }
}

#[test]
fn names_may_hold_spaces_and_a_file_several_roots() {
    let text = SMALL.replace("JOINT Leg", "JOINT Bip01 L Leg");
    assert!(
        parse(&text)
            .unwrap()
            .skeleton()
            .find("Bip01 L Leg")
            .is_some()
    );
    let second = "ROOT Prop\n{\nOFFSET 1 2 3\nCHANNELS 1 Xposition\n}\nMOTION";
    let text = SMALL
        .replace("MOTION", second)
        .replace("0 0 0\n5", "0 0 0 7\n5")
        .replace("0 90\n", "0 90 7\n");
    let clip = parse(&text).unwrap();
    assert_eq!(clip.skeleton().joints()[3].parent, None);
}

#[test]
fn position_channels_add_or_replace() {
    // The root's feet reach the ground only when the channels add to its offset of 100.
    let clip = parse(SMALL).unwrap();
    assert!((clip.translation(0, 0).y - 1.01).abs() < 1e-5);
    assert!(
        clip.conversion()
            .notes
            .iter()
            .any(|note| note.contains("add"))
    );
    let absolute = SMALL
        .replace("0 1 0 0", "0 101 0 0")
        .replace("5 2 0 90", "5 102 0 90");
    let clip = parse(&absolute).unwrap();
    assert!((clip.translation(0, 0).y - 1.01).abs() < 1e-5);
    assert!(
        clip.conversion()
            .notes
            .iter()
            .any(|note| note.contains("replace"))
    );

    let options = BvhOptions {
        position_channels: Some(PositionChannels::Replace),
        ..BvhOptions::default()
    };
    let clip = bvh::parse(SMALL.as_bytes(), "test.bvh", &options).unwrap();
    assert!((clip.translation(0, 0).y - 0.01).abs() < 1e-5);

    // Joints below the root that repeat their offset replace it, whatever the root looks like.
    let spine = "OFFSET 0 50 0\n        CHANNELS 6 Xposition Yposition Zposition";
    let text = SMALL
        .replace("OFFSET 0 50 0\n        CHANNELS 3", spine)
        .replace("OFFSET 0 100 0", "OFFSET 1 94 -452")
        .replace("0 1 0 0 0 0 0", "0 94 -9 0 0 0 0 50 0 0")
        .replace("5 2 0 90 0 0 0", "5 94 -9 90 0 0 0 50 0 0");
    let clip = parse(&text).unwrap();
    assert!(clip.translation(0, 0).distance(Vec3::new(0.0, 0.94, -0.09)) < 1e-5);
    assert!((clip.translation(1, 1).y - 0.5).abs() < 1e-5);
}

#[test]
fn options_override_what_is_inferred() {
    let options = BvhOptions {
        unit: Some(LengthUnit::Inch),
        up_axis: Some(UpAxis::Z),
        frame_rate: Some(FrameRate::new(60.0).unwrap()),
        ..BvhOptions::default()
    };
    let clip = bvh::parse(SMALL.as_bytes(), "test.bvh", &options).unwrap();
    assert_eq!(clip.frame_rate().per_second(), 60.0);
    assert_eq!(clip.conversion().up_axis, UpAxis::Z);
    let spine = clip.pose(0).positions[1] - clip.pose(0).positions[0];
    assert!(spine.distance(Vec3::NEG_Z * 1.27) < 1e-5, "{spine}");
}

#[test]
fn mistakes_are_named_with_their_place() {
    for (text, words) in [
        (
            SMALL.replace("5 2 0 90", "5 nan 0 90"),
            vec!["frame 1", "Hips", "Yposition", "nan"],
        ),
        (
            SMALL.replace("0 0 90\n", "0 0 inf\n"),
            vec!["frame 1", "Spine", "inf"],
        ),
        (
            SMALL.replace("0 0 90\n", "0 0 1e999\n"),
            vec!["frame 1", "Spine"],
        ),
        (
            SMALL.replace("0 0 90\n", "0 0\n"),
            vec!["frame 1", "9 numbers", "8"],
        ),
        (
            SMALL.replace("0 0 90\n", "0 0 90 4\n"),
            vec!["frame 1", "9 numbers", "4"],
        ),
        (
            SMALL.replace("Frames: 2", "Frames: 3"),
            vec!["3 frames", "2"],
        ),
        (
            SMALL.replace("Frames: 2", "Frames: 1"),
            vec!["line 29", "after 1 frames"],
        ),
        (
            SMALL.replace("Frames: 2", "Frames: -2"),
            vec!["number of frames", "-2"],
        ),
        (SMALL.replace("0.0333333", "0"), vec!["frame time from"]),
        (SMALL.replace("0.0333333", "-1"), vec!["frame time from"]),
        (
            SMALL.replace("Zrotation", "Wrotation"),
            vec!["line 5", "Wrotation"],
        ),
        (
            SMALL.replace("CHANNELS 3", "CHANNELS 4"),
            vec!["line 10", "channel"],
        ),
        (
            SMALL.replace("CHANNELS 3", "CHANNELS 99999999999"),
            vec!["line 9", "12 channels"],
        ),
        (
            SMALL.replace("OFFSET 0 50 0", "OFFSET 0 50"),
            vec!["line 9", "three finite numbers"],
        ),
        (
            SMALL.replace("OFFSET 0 50 0", "OFFSET 0 1e300 0"),
            vec!["line 8", "1e30"],
        ),
        (SMALL.replace("ROOT Hips", "ROOT"), vec!["name"]),
        ("<html>".to_owned(), vec!["line 1", "HIERARCHY", "<html>"]),
        (String::new(), vec!["HIERARCHY", "end of the file"]),
    ] {
        let message = parse(&text).unwrap_err().to_string();
        for word in words {
            assert!(message.contains(word), "\"{word}\" is not in: {message}");
        }
    }
}

#[test]
fn limits_hold_before_memory_is_taken() {
    let limited = |text: &str, limits: Limits| {
        let options = BvhOptions {
            limits,
            ..BvhOptions::default()
        };
        match bvh::parse(text.as_bytes(), "test.bvh", &options) {
            Err(Error::Limit { what, .. }) => what,
            other => panic!("{other:?}"),
        }
    };
    let usual = Limits::default;
    let huge = SMALL.replace("Frames: 2", "Frames: 18446744073709551615");
    assert!(limited(&huge, usual()).contains("frames"));
    assert!(
        limited(
            SMALL,
            Limits {
                joints: 2,
                ..usual()
            }
        )
        .contains("joints")
    );
    assert!(
        limited(
            SMALL,
            Limits {
                depth: 1,
                ..usual()
            }
        )
        .contains("depth")
    );
    assert!(
        limited(
            SMALL,
            Limits {
                bytes: 50,
                ..usual()
            }
        )
        .contains("rotations")
    );
    // Many frames of joints without channels cost no byte of the file.
    let mut idle = String::from("HIERARCHY\n");
    for joint in 0..1000 {
        idle += &format!("ROOT r{joint}\n{{\nOFFSET 0 0 0\n}}\n");
    }
    idle += "MOTION\nFrames: 2000000\nFrame Time: 0.01\n";
    assert!(limited(&idle, usual()).contains("rotations"));
    // Nesting is no recursion.
    let deep = format!("HIERARCHY\n{}", "ROOT a\n{\nJOINT b\n{\n".repeat(500_000));
    assert!(parse(&deep).is_err());
    let deep = format!("HIERARCHY\nROOT a\n{{\n{}", "JOINT b\n{\n".repeat(500_000));
    assert!(
        limited(
            &deep,
            Limits {
                joints: usize::MAX,
                ..usual()
            }
        )
        .contains("depth")
    );
}

#[test]
fn a_truncated_file_never_panics() {
    let text = Rig::t_pose().bvh(&walk(3));
    for end in (0..text.len()).step_by(7) {
        // A file cut inside its last number may still hold as many numbers as it should.
        let _ = parse(&text[..end]);
    }
    for end in (0..SMALL.len() - 3).step_by(3) {
        assert!(parse(&SMALL[..end]).is_err(), "{end}");
    }
}

proptest! {
    #[test]
    fn damaged_bytes_never_panic(at in 0..SMALL.len(), byte in any::<u8>()) {
        let mut bytes = SMALL.as_bytes().to_vec();
        bytes[at] = byte;
        if let Ok(clip) = bvh::parse(&bytes, "test.bvh", &BvhOptions::default()) {
            // What is accepted is whole.
            for frame in 0..clip.frame_count() {
                prop_assert!(clip.pose(frame).positions.iter().all(|at| at.is_finite()));
            }
        }
    }
}

fn written_in(unit: LengthUnit, up_axis: UpAxis) -> BvhWriteOptions {
    BvhWriteOptions { unit, up_axis }
}

#[test]
fn a_file_with_z_up_stands_along_z_and_comes_back() {
    let (motion, body) = (walk(40), figure());
    let clip = SkeletonClip::from_motion(&motion, &body).unwrap();
    let text = bvh::format_clip(&clip, &written_in(LengthUnit::Metre, UpAxis::Z));
    // The rest pose itself stands: the head is above the pelvis along Z.
    let neck = text.split("neck").nth(1).unwrap();
    let offset = neck.split("OFFSET ").nth(1).unwrap();
    let offset: Vec<f32> = offset
        .split_whitespace()
        .take(3)
        .map(|n| n.parse().unwrap())
        .collect();
    let bone = body.bone(Joint::Spine3, Joint::Neck);
    assert!(
        Vec3::new(offset[0], offset[1], offset[2]).distance(Vec3::new(bone.x, -bone.z, bone.y))
            < 1e-5
    );
    let again = parse(&text).unwrap();
    assert_eq!(again.conversion().up_axis, UpAxis::Z);
    for frame in 0..clip.frame_count() {
        let (ours, theirs) = (again.pose(frame), clip.pose(frame));
        for joint in Joint::ALL {
            let found = again.skeleton().find(joint.name()).unwrap();
            let distance = ours.positions[found].distance(theirs.positions[joint.index()]);
            assert!(distance < 1e-5, "frame {frame}, {joint}: {distance} m");
        }
    }
}

#[test]
fn writing_and_reading_gives_the_clip_back() {
    let clip = parse(&Rig::arms_down(30.0).bvh(&walk(20))).unwrap();
    for unit in [LengthUnit::Centimetre, LengthUnit::Metre] {
        let text = bvh::format_clip(&clip, &written_in(unit, UpAxis::Y));
        let again = parse(&text).unwrap();
        assert_eq!(again.conversion().metres_per_unit, unit.metres());
        assert_eq!(
            again.skeleton().joint_count(),
            clip.skeleton().joint_count()
        );
        assert_eq!(again.frame_rate(), clip.frame_rate());
        for frame in 0..clip.frame_count() {
            let (ours, theirs) = (again.pose(frame), clip.pose(frame));
            for name in clip.skeleton().joints().iter().map(|joint| &joint.name) {
                let a = again.skeleton().find(name).unwrap();
                let b = clip.skeleton().find(name).unwrap();
                assert!(
                    ours.positions[a].distance(theirs.positions[b]) < 1e-5,
                    "{name}"
                );
                assert!(
                    ours.rotations[a].angle_between(theirs.rotations[b]) < 2e-3,
                    "{name}"
                );
            }
        }
    }
}

#[test]
fn a_motion_survives_the_way_through_a_file() {
    let folder = std::env::temp_dir().join(format!("physique-bvh-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("walk.bvh");
    let motion = walk(40);
    bvh::write_motion(&path, &motion, &figure(), &BvhWriteOptions::default()).unwrap();
    let clip = bvh::read(&path, &BvhOptions::default()).unwrap();
    let options = MappingOptions {
        share_wrist_twist: false,
        ..MappingOptions::default()
    };
    let again = map_to_body(&clip, &figure(), &options).unwrap().motion;
    assert!(largest_turn(&again, &motion, &figure()).0 < 0.3);
    assert!(largest_distance(&again, &motion, &figure()).0 < 0.002);
    // Nothing is left beside the file, and a failed write leaves nothing.
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    let missing = folder.join("missing").join("walk.bvh");
    let failed = bvh::write_motion(&missing, &motion, &figure(), &BvhWriteOptions::default());
    assert!(matches!(failed, Err(Error::Io { .. })));
    std::fs::remove_dir_all(&folder).unwrap();
}
