//! A motion survives the way out to a foreign skeleton and back.

use physique::body::{Body, Joint, Sex, open_body_low};
use physique::load::{LoadOptions, load_clip, load_recording};
use physique::motion::mapping::BodyRest;
use physique::motion::{Motion, SkeletonClip, embedded};

fn joints(body: &Body, motion: &Motion, frame: usize) -> Vec<glam::Vec3> {
    let mut world_from_joint = Vec::new();
    body.pose_joints(&motion.pose(frame), &mut world_from_joint)
        .unwrap();
    let positions = world_from_joint.iter().map(|at| at.translation.into());
    positions.take(Joint::COUNT).collect()
}

#[test]
fn every_embedded_clip_comes_back_from_its_own_skeleton() {
    let body = Body::mean(open_body_low().unwrap(), Sex::Male).unwrap();
    for clip in embedded::clips() {
        let motion = load_recording(clip.load().unwrap(), &body).unwrap().motion;
        let skeleton = SkeletonClip::from_motion(&motion, &BodyRest::from(&body)).unwrap();
        let back = load_clip(&skeleton, &body, &LoadOptions::default()).unwrap();
        assert_eq!(
            back.motion.frame_count(),
            motion.frame_count(),
            "{}",
            clip.name
        );
        let mapping = back.mapping_summary().unwrap();
        assert!(mapping.worst_error_cm < 1e-3, "{}: {mapping:?}", clip.name);
        for frame in 0..motion.frame_count() {
            let before = joints(&body, &motion, frame);
            let after = joints(&body, &back.motion, frame);
            for joint in Joint::ALL {
                let distance = before[joint.index()].distance(after[joint.index()]);
                assert!(
                    distance < 1e-5,
                    "{} frame {frame} {joint}: {distance} m",
                    clip.name
                );
            }
        }
    }
}
