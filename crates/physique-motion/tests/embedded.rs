//! The embedded clips are what their card says.

#![allow(clippy::unwrap_used)]

use physique_body::{Body, Joint, Pose, open_body_low};
use physique_motion::embedded;
use sha2::{Digest, Sha256};

#[test]
fn every_clip_loads_with_its_name_its_source_and_its_licence() {
    let expected = [
        ("dance", 153, 60),
        ("get_up", 227, 60),
        ("jump", 107, 60),
        ("spin_kick", 78, 60),
        ("walk", 39, 30),
        ("run", 25, 30),
    ];
    assert_eq!(embedded::clips().len(), expected.len());
    for (clip, (name, frames, rate)) in embedded::clips().iter().zip(expected) {
        let recording = clip.load().unwrap();
        assert_eq!((clip.name, recording.name.as_str()), (name, name));
        assert_eq!(recording.motion.frame_count(), frames);
        assert_eq!(
            recording.motion.frame_rate().per_second().round() as i32,
            rate
        );
        assert!(recording.source.unwrap().contains("pybullet 3.2.7"));
        assert!(recording.licence.unwrap().contains("zlib"));
        assert!(embedded::clip(name).is_some());
    }
    assert!(embedded::clip("sleep").is_none());
}

#[test]
fn hashes_are_those_of_the_list() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/");
    let sums = std::fs::read_to_string(format!("{folder}sha256sums")).unwrap();
    assert_eq!(sums.lines().count(), embedded::clips().len());
    for line in sums.lines() {
        let (sum, file) = line.split_once("  ").unwrap();
        let digest = Sha256::digest(std::fs::read(format!("{folder}{file}")).unwrap());
        let found: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(found, sum, "{file}");
    }
}

#[test]
fn bodies_stand_on_the_floor_and_walking_goes_forward() {
    let body = Body::new(open_body_low().unwrap(), &[]).unwrap();
    let mut posed = body.posed();
    for clip in embedded::clips() {
        let motion = clip.load().unwrap().motion;
        let mut on_floor = 0;
        for frame in 0..motion.frame_count() {
            let pose = Pose {
                root_translation: motion.root_translation()[frame],
                rotations: motion.frame_rotations(frame),
            };
            body.pose(&pose, &mut posed).unwrap();
            let lowest = posed
                .vertices()
                .iter()
                .map(|vertex| vertex.y)
                .fold(f32::MAX, f32::min);
            // The card states the deepest: 5.8 cm, hands and back in `get_up`.
            assert!(lowest > -0.065, "{}, frame {frame}: {lowest} m", clip.name);
            on_floor += usize::from(lowest < 0.05);
        }
        assert!(on_floor * 5 > motion.frame_count(), "{} flies", clip.name);
    }
    for (name, metres_per_second) in [("walk", 0.8..1.4), ("run", 2.5..5.0)] {
        let motion = embedded::clip(name).unwrap().load().unwrap().motion;
        let [first, .., last] = motion.root_translation() else {
            panic!("{name} is too short")
        };
        let forward = f64::from((last - first).z) / motion.seconds();
        assert!(
            metres_per_second.contains(&forward),
            "{name}: {forward} m/s"
        );
    }
}

#[test]
fn arms_and_legs_of_a_walk_swing_in_turn() {
    let body = Body::new(open_body_low().unwrap(), &[]).unwrap();
    let motion = embedded::clip("walk").unwrap().load().unwrap().motion;
    let mut posed = body.posed();
    let product: f32 = (0..motion.frame_count())
        .map(|frame| {
            let pose = Pose {
                root_translation: motion.root_translation()[frame],
                rotations: motion.frame_rotations(frame),
            };
            body.pose(&pose, &mut posed).unwrap();
            let ahead = |left, right| posed.joint(left).z - posed.joint(right).z;
            ahead(Joint::LeftAnkle, Joint::RightAnkle) * ahead(Joint::LeftWrist, Joint::RightWrist)
        })
        .sum();
    assert!(product < 0.0, "the left arm swings with the right leg");
}
