//! A real recording twice: CMU's 02_01 as recorded (ASF/AMC, 120 fps) and as it was converted to
//! iClone's skeleton (BVH, 60 fps), both mapped to the body.
//!
//! The data lie unpacked under `PHYSIQUE_DATA`, or beside the checkout; without them this says so and
//! passes.

use std::env;
use std::path::PathBuf;

use glam::Quat;
use physique_body::{Body, Joint, open_body_low};
use physique_motion::mapping::{BodyRest, MappingOptions, map_to_body};
use physique_motion::{Motion, ReadOptions, SourceMotion, read_motion};

const RECORDED: &str = "cmu/cmu_cyun9601/data/CMU/asfamc/subjects/02/02_01.amc";
const CONVERTED: &str = "cmu/cmu_iclone/All_BVH/subjects/002/002_01.bvh";

fn data(file: &str) -> Option<PathBuf> {
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let path = env::var_os("PHYSIQUE_DATA").map_or_else(beside, PathBuf::from);
    let path = path.join(file);
    if path.is_file() {
        return Some(path);
    }
    eprintln!("skipped: {} is not here", path.display());
    None
}

fn mapped(path: PathBuf, body: &BodyRest) -> Motion {
    match read_motion(path, &ReadOptions::default()).unwrap() {
        SourceMotion::Skeleton(clip) => {
            let mapped = map_to_body(&clip, body, &MappingOptions::default());
            mapped.unwrap().motion
        }
        other => panic!("a skeleton was expected, found {other:?}"),
    }
}

/// Orientation of a joint as seen from another above it.
fn seen_from(motion: &Motion, frame: usize, above: Joint, joint: Joint) -> Quat {
    let (mut turn, mut at) = (Quat::IDENTITY, joint);
    while at != above {
        turn = motion.frame_rotations(frame)[at.index()] * turn;
        at = at.parent().unwrap();
    }
    turn
}

#[test]
fn an_iclone_conversion_maps_as_the_recording_does() {
    let (Some(recorded), Some(converted)) = (data(RECORDED), data(CONVERTED)) else {
        return;
    };
    let body = BodyRest::from(&Body::new(open_body_low().unwrap(), &[]).unwrap());
    let [recorded, converted] = [recorded, converted].map(|path| mapped(path, &body));
    let rates = [&recorded, &converted].map(|motion| motion.frame_rate().per_second().round());
    assert_eq!(rates, [120.0, 60.0]);
    let frames = converted.frame_count().min(recorded.frame_count() / 2);
    assert!(frames > 150, "{frames}");
    // Mean angles in degrees, a little above what they are.
    for (joint, above, most) in [
        (Joint::Spine3, Joint::Pelvis, 0.3),
        (Joint::Head, Joint::Spine3, 0.1),
        (Joint::LeftCollar, Joint::Spine3, 0.1),
        (Joint::RightCollar, Joint::Spine3, 0.1),
        (Joint::LeftShoulder, Joint::Spine3, 1.0),
        (Joint::RightShoulder, Joint::Spine3, 1.0),
        (Joint::LeftElbow, Joint::LeftShoulder, 3.5),
        (Joint::RightElbow, Joint::RightShoulder, 3.5),
        (Joint::LeftHip, Joint::Pelvis, 2.5),
        (Joint::RightHip, Joint::Pelvis, 2.5),
        (Joint::LeftKnee, Joint::LeftHip, 4.5),
        (Joint::RightKnee, Joint::RightHip, 4.5),
    ] {
        // Whichever frame of the recording a conversion began with, it keeps every other one.
        let angle = |first: usize| {
            let angles = (0..frames - 1).map(|frame| {
                let theirs = seen_from(&recorded, first + 2 * frame, above, joint);
                let ours = seen_from(&converted, frame, above, joint);
                ours.angle_between(theirs).to_degrees()
            });
            angles.sum::<f32>() / (frames - 1) as f32
        };
        let mean = angle(0).min(angle(1));
        println!("{joint} against {above}: {mean:.2} degrees");
        assert!(mean < most, "{joint} against {above}: {mean} degrees");
    }
    // The pelvis goes the same way: from the first frame on, to some per cent of its length.
    let way = |motion: &Motion, frame: usize| {
        let path = motion.root_translation();
        (path[frame] - path[0]).length()
    };
    let last = frames - 1;
    let (ours, theirs) = (way(&converted, last), way(&recorded, 2 * last));
    println!("way of the pelvis: {ours:.3} and {theirs:.3} m");
    assert!((ours - theirs).abs() < 0.05 * theirs, "{ours}, {theirs} m");
}
