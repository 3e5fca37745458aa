//! One true motion, written by many kinds of rigs, comes back as the same motion of the body.

mod support;

use std::path::Path;

use glam::{EulerRot, Quat, Vec3};
use physique_body::Joint;
use physique_motion::{
    Error, Motion, SkeletonClip, bvh,
    mapping::{AlignedBy, FoundBy, Mapped, MappingOptions, NameTable, map_to_body},
};
use support::{Rig, figure, largest_distance, largest_turn, pose, walk};

fn read(text: &str) -> SkeletonClip {
    bvh::parse(text.as_bytes(), "rig.bvh", &bvh::BvhOptions::default()).unwrap()
}

/// Rotations and places only: twist stays where the rig has it.
fn plain() -> MappingOptions {
    MappingOptions {
        share_wrist_twist: false,
        ..MappingOptions::default()
    }
}

fn map(rig: &Rig, motion: &Motion) -> Mapped {
    map_to_body(&read(&rig.bvh(motion)), &figure(), &plain()).unwrap()
}

/// Maps a rig's recording of the walk and compares it with the walk.
fn assert_walks(rig: &Rig, aligned_by: AlignedBy, degrees: f32, metres: f32) -> Mapped {
    let truth = walk(90);
    let mapped = map(rig, &truth);
    assert_eq!(mapped.report.aligned_by, aligned_by, "{}", mapped.report);
    let (turn, joint) = largest_turn(&mapped.motion, &truth, &figure());
    assert!(
        turn < degrees,
        "{joint} is off by {turn} degrees\n{}",
        mapped.report
    );
    let (distance, joint) = largest_distance(&mapped.motion, &truth, &figure());
    assert!(
        distance < metres,
        "{joint} is off by {distance} m\n{}",
        mapped.report
    );
    mapped
}

#[test]
fn a_t_pose_rig_of_the_same_body_comes_back_exactly() {
    let mapped = assert_walks(&Rig::t_pose(), AlignedBy::RestPose, 0.2, 0.002);
    assert!((mapped.report.scale - 1.0).abs() < 1e-4);
    assert!(
        mapped.report.fit_error.all.max_cm < 0.2,
        "{}",
        mapped.report
    );
    assert_eq!(
        mapped.report.found_by,
        FoundBy::Names {
            family: "SMPL".into()
        }
    );
}

#[test]
fn arms_at_rest_may_hang_down_in_any_angle() {
    for degrees in [20.0_f32, 45.0, 70.0] {
        // The figure's arms point a little backwards, out of the plane in which the rig lets them
        // down; the shortest swing then differs from the rig's by this twist.
        let arm = figure().offset(Joint::LeftElbow).normalize();
        let twist = 2.0 * (arm.z.abs() * (degrees.to_radians() / 2.0).tan()).atan();
        let bound = twist.to_degrees() + 0.2;
        assert_walks(&Rig::arms_down(degrees), AlignedBy::RestPose, bound, 0.002);
    }
}

#[test]
fn bones_along_one_axis_are_understood_by_hinges_and_soles() {
    for rig in [
        Rig::bones_along(Vec3::X, Vec3::Z, true),
        Rig::bones_along(Vec3::X, Vec3::Y, false),
        Rig::bones_along(Vec3::Y, Vec3::X, false),
        Rig::bones_along(Vec3::NEG_Z, Vec3::X, true),
    ] {
        assert_walks(&rig, AlignedBy::Anatomy, 10.0, 0.06);
    }
}

#[test]
fn the_order_of_channels_does_not_matter() {
    for order in [
        ("XYZ", EulerRot::XYZ),
        ("YXZ", EulerRot::YXZ),
        ("ZYX", EulerRot::ZYX),
        ("YZX", EulerRot::YZX),
    ] {
        let rig = Rig {
            order,
            ..Rig::t_pose()
        };
        assert_walks(&rig, AlignedBy::RestPose, 0.2, 0.002);
    }
}

#[test]
fn units_are_inferred() {
    for (units, name) in [
        (1.0, "metres"),
        (1000.0, "millimetres"),
        (1.0 / 0.0254, "inches"),
    ] {
        let rig = Rig {
            units,
            ..Rig::t_pose()
        };
        let mapped = assert_walks(&rig, AlignedBy::RestPose, 0.2, 0.002);
        assert!(mapped.report.notes[0].contains(name), "{}", mapped.report);
    }
}

#[test]
fn a_z_up_file_is_turned_upright() {
    let rig = Rig {
        file_from_world: Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
        ..Rig::t_pose()
    };
    // Its zero pose lies on its back, which is as good a zero pose as any.
    let mapped = map(&rig, &walk(90));
    let (distance, joint) = largest_distance(&mapped.motion, &walk(90), &figure());
    assert!(
        distance < 0.06,
        "{joint} is off by {distance} m\n{}",
        mapped.report
    );
    assert!(
        mapped
            .report
            .notes
            .iter()
            .any(|note| note.starts_with("up axis: Z"))
    );
}

#[test]
fn nameless_joints_are_found_by_shape_and_the_left_is_left() {
    for rig in [Rig::t_pose(), Rig::bones_along(Vec3::X, Vec3::Z, true)] {
        let mapped = map(&rig.nameless(), &walk(90));
        assert_eq!(mapped.report.found_by, FoundBy::Shape);
        let (distance, joint) = largest_distance(&mapped.motion, &walk(90), &figure());
        assert!(
            distance < 0.06,
            "{joint} is off by {distance} m\n{}",
            mapped.report
        );
    }
}

#[test]
fn a_mapping_file_goes_before_names() {
    let mut rig = Rig::t_pose();
    rig.names[Joint::LeftKnee.index()] = "strange".into();
    rig.names[Joint::Spine2.index()] = "spiral".into();
    let clip = read(&rig.bvh(&walk(30)));
    let text = "left_knee = \"strange\"\nspine = [\"spine1\", \"spiral\", \"spine3\"]\n";
    let table = NameTable::parse(text, Path::new("map.toml")).unwrap();
    let options = MappingOptions {
        table: Some(table),
        ..plain()
    };
    let mapped = map_to_body(&clip, &figure(), &options).unwrap();
    let (turn, joint) = largest_turn(&mapped.motion, &walk(30), &figure());
    assert!(turn < 0.2, "{joint} {turn}\n{}", mapped.report);

    let table = NameTable::parse("left_knee = \"no such joint\"", Path::new("map.toml")).unwrap();
    let options = MappingOptions {
        table: Some(table),
        ..plain()
    };
    let error = map_to_body(&clip, &figure(), &options).unwrap_err();
    assert!(error.to_string().contains("no such joint"), "{error}");
}

#[test]
fn missing_joints_follow_their_parents() {
    let rig = Rig {
        without: vec![
            Joint::LeftFoot,
            Joint::RightFoot,
            Joint::LeftWrist,
            Joint::RightWrist,
            Joint::Head,
        ],
        ..Rig::t_pose()
    };
    let mapped = map(&rig, &walk(30));
    for frame in 0..mapped.motion.frame_count() {
        for joint in [Joint::LeftFoot, Joint::RightWrist, Joint::Head] {
            let local = mapped.motion.frame_rotations(frame)[joint.index()];
            assert!(local.angle_between(Quat::IDENTITY) < 1e-3, "{joint}");
        }
    }
    assert!(
        mapped.report.notes.iter().any(|note| note.contains("head")),
        "{}",
        mapped.report
    );
}

#[test]
fn other_proportions_keep_directions_of_bones_and_places_of_feet() {
    // Legs a third longer, arms a quarter shorter, wider hips.
    let mut rig = Rig::t_pose();
    for joint in Joint::ALL {
        let scale = match joint {
            Joint::LeftHip | Joint::RightHip => Vec3::new(1.4, 1.0, 1.0),
            Joint::LeftKnee | Joint::RightKnee | Joint::LeftAnkle | Joint::RightAnkle => {
                Vec3::splat(4.0 / 3.0)
            }
            Joint::LeftElbow | Joint::RightElbow | Joint::LeftWrist | Joint::RightWrist => {
                Vec3::splat(0.75)
            }
            _ => Vec3::ONE,
        };
        rig.body.joints[joint.index()] = match joint.parent() {
            None => Vec3::new(0.0, 1.2, 0.0),
            Some(parent) => rig.body.joint(parent) + figure().offset(joint) * scale,
        };
    }
    rig.body.ground = rig.body.joint(Joint::LeftAnkle).y - 0.07;
    let truth = walk(90);
    let mapped = map(&rig, &truth);
    assert!(
        (mapped.report.scale - 0.75).abs() < 0.01,
        "{}",
        mapped.report
    );
    for (joint, distances) in &mapped.report.fit_error.by_joint {
        if matches!(joint, Joint::LeftAnkle | Joint::RightAnkle) {
            assert!(distances.percentile_95_cm < 1.5, "{}", mapped.report);
        }
    }
    // Arms point as the source's; wider hips and planted feet turn the legs, and the report says so.
    let by_limb = &mapped.report.fit_error.by_limb;
    assert_eq!(by_limb.len(), 8);
    for (joint, angles) in by_limb {
        let is_arm = Joint::ARMS.iter().flatten().any(|arm| arm == joint);
        assert_eq!(angles.max_degrees < 0.2, is_arm, "{}", mapped.report);
        assert!(angles.mean_degrees < 5.0, "{}", mapped.report);
    }
    for frame in 0..90 {
        let (ours, theirs) = (
            pose(&mapped.motion, &figure(), frame).0,
            pose(&truth, &figure(), frame).0,
        );
        for joint in [
            Joint::LeftShoulder,
            Joint::RightElbow,
            Joint::Spine3,
            Joint::LeftAnkle,
        ] {
            let turn = ours[joint.index()].angle_between(theirs[joint.index()]);
            assert!(turn < 0.01, "{joint} {turn}");
        }
        // Some sole is on the ground in every frame, as in the truth.
        let positions = pose(&mapped.motion, &figure(), frame).1;
        let soles = Joint::FEET.map(|joint| positions[joint.index()].y - figure().height(joint));
        let lowest = soles.into_iter().fold(f32::INFINITY, f32::min);
        assert!(lowest.abs() < 0.02, "frame {frame}: {lowest}");
    }
}

/// The motion as seen after the world is turned about the vertical and moved over the ground.
fn moved(motion: &Motion, turn: Quat, shift: Vec3) -> Motion {
    let pelvis = figure().joint(Joint::Pelvis);
    let translations = motion.root_translation().iter();
    let translations = translations.map(|&at| turn * (pelvis + at) + shift - pelvis);
    let mut rotations = motion.rotations().to_vec();
    for rotation in rotations.iter_mut().step_by(Joint::COUNT) {
        *rotation = turn * *rotation;
    }
    Motion::new(motion.frame_rate(), None, translations.collect(), rotations).unwrap()
}

#[test]
fn turning_and_moving_the_world_commutes_with_mapping() {
    for rig in [
        Rig::arms_down(45.0),
        Rig::bones_along(Vec3::X, Vec3::Z, true),
    ] {
        let still = map(&rig, &walk(60)).motion;
        for (yaw, shift) in [
            (1.0, Vec3::new(3.0, 0.0, -2.0)),
            (-2.5, Vec3::new(-1.0, 0.0, 5.0)),
        ] {
            let turn = Quat::from_rotation_y(yaw);
            let there = map(&rig, &moved(&walk(60), turn, shift)).motion;
            let expected = moved(&still, turn, shift);
            let (distance, joint) = largest_distance(&there, &expected, &figure());
            assert!(distance < 2e-3, "{joint} {distance}");
            let (turn, joint) = largest_turn(&there, &expected, &figure());
            assert!(turn < 0.5, "{joint} {turn}");
        }
    }
}

/// Left and right exchanged, as in a mirror at X = 0.
fn mirrored(motion: &Motion) -> Motion {
    let flip = Vec3::new(-1.0, 1.0, 1.0);
    let translations = motion
        .root_translation()
        .iter()
        .map(|&at| at * flip)
        .collect();
    let rotations = (0..motion.frame_count()).flat_map(|frame| {
        let local = motion.frame_rotations(frame);
        Joint::ALL.map(|joint| {
            let q = local[joint.mirrored().index()];
            Quat::from_xyzw(q.x, -q.y, -q.z, q.w)
        })
    });
    Motion::new(motion.frame_rate(), None, translations, rotations.collect()).unwrap()
}

#[test]
fn mirroring_commutes_with_mapping() {
    for rig in [Rig::t_pose(), Rig::bones_along(Vec3::X, Vec3::Z, true)] {
        let mapped = map(&rig, &mirrored(&walk(60))).motion;
        let expected = mirrored(&map(&rig, &walk(60)).motion);
        let (distance, joint) = largest_distance(&mapped, &expected, &figure());
        assert!(distance < 5e-3, "{joint} {distance}");
    }
}

#[test]
fn a_leading_t_pose_is_dropped_on_request_kept() {
    let walking = walk(60);
    let mut translations = walking.root_translation().to_vec();
    let mut rotations = walking.rotations().to_vec();
    translations.insert(0, Vec3::ZERO);
    rotations.splice(0..0, [Quat::IDENTITY; Joint::COUNT]);
    let led = Motion::new(walking.frame_rate(), None, translations, rotations).unwrap();
    let clip = read(&Rig::t_pose().bvh(&led));
    let mapped = map_to_body(&clip, &figure(), &plain()).unwrap();
    assert_eq!(mapped.report.dropped_frames, 1);
    let (distance, joint) = largest_distance(&mapped.motion, &walking, &figure());
    assert!(distance < 0.002, "{joint} {distance}");
    let keep = MappingOptions {
        keep_t_pose: true,
        ..plain()
    };
    let kept = map_to_body(&clip, &figure(), &keep).unwrap();
    assert_eq!(kept.motion.frame_count(), 61);
    // The same walk without it loses nothing.
    assert_eq!(map(&Rig::t_pose(), &walking).report.dropped_frames, 0);

    // A rig without a human zero pose learns its axes from the T-pose.
    let rig = Rig::bones_along(Vec3::Y, Vec3::X, false);
    let mapped = map(&rig, &led);
    assert_eq!(mapped.report.aligned_by, AlignedBy::FirstFrame);
    let (turn, joint) = largest_turn(&mapped.motion, &walking, &figure());
    assert!(turn < 0.5, "{joint} {turn}");
}

#[test]
fn shared_wrist_twist_keeps_hands_and_directions() {
    let clip = read(&Rig::t_pose().bvh(&walk(30)));
    let shared = map_to_body(&clip, &figure(), &MappingOptions::default())
        .unwrap()
        .motion;
    let plain = map_to_body(&clip, &figure(), &plain()).unwrap().motion;
    assert!(largest_distance(&shared, &plain, &figure()).0 < 1e-4);
    for frame in 0..30 {
        let (ours, theirs) = (
            pose(&shared, &figure(), frame).0,
            pose(&plain, &figure(), frame).0,
        );
        let wrist = Joint::LeftWrist.index();
        assert!(ours[wrist].angle_between(theirs[wrist]) < 2e-3);
    }
}

#[test]
fn what_is_no_body_is_refused() {
    let lamp = "HIERARCHY\nROOT lamp\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\n\
        JOINT arm\n{\nOFFSET 0 30 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nEnd Site\n{\n\
        OFFSET 0 9 0\n}\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0 0 0 0\n";
    let error = map_to_body(&read(lamp), &figure(), &plain()).unwrap_err();
    assert!(matches!(error, Error::NotHuman { .. }), "{error}");
    let none = Rig::t_pose().bvh(&walk(0));
    let error = map_to_body(&read(&none), &figure(), &plain()).unwrap_err();
    assert!(matches!(error, Error::NoFrames), "{error}");
}
