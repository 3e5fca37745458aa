//! A motion through every writer and back, one by one and one after the other.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use glam::Vec3;
use physique_body::{Body, Joint, open_body_low};
use physique_motion::bvh::{self, BvhWriteOptions};
use physique_motion::features::{FeatureSkeleton, JointPositions};
use physique_motion::glb::{self, SkinnedMesh};
use physique_motion::mapping::{BodyRest, MappingOptions, map_to_body};
use physique_motion::{
    Motion, ReadOptions, Recording, SkeletonClip, SourceMotion, amass, csv, embedded, native,
    read_motion,
};

/// The body whose motion it is.
struct Person {
    body: Body,
    rest: BodyRest,
}

impl Person {
    fn new() -> Self {
        let body = Body::new(open_body_low().unwrap(), &[]).unwrap();
        let rest = BodyRest::from(&body);
        Self { body, rest }
    }

    fn pelvis(&self) -> Vec3 {
        self.rest.joint(Joint::Pelvis)
    }

    /// A file's motion on this body.
    fn read(&self, path: &Path) -> Motion {
        let options = ReadOptions {
            // Only AMASS needs to be told: its files do not say whose pelvis the path starts from.
            rest_pelvis: Some(self.pelvis()),
            ..ReadOptions::default()
        };
        match read_motion(path, &options).unwrap() {
            SourceMotion::Skeleton(clip) => {
                let options = MappingOptions {
                    share_wrist_twist: false,
                    ..MappingOptions::default()
                };
                map_to_body(&clip, &self.rest, &options).unwrap().motion
            }
            SourceMotion::Body(recording) => self.adopt(&recording),
            SourceMotion::Positions(_) => panic!("rotations were written"),
        }
    }

    /// A recording of another body, its pelvis where it was.
    fn adopt(&self, recording: &Recording) -> Motion {
        let (motion, shift) = (&recording.motion, recording.rest_pelvis - self.pelvis());
        let path = motion.root_translation().iter().map(|&place| place + shift);
        let rotations = motion.rotations().to_vec();
        Motion::new(motion.frame_rate(), None, path.collect(), rotations).unwrap()
    }

    fn write(&self, format: &str, motion: &Motion, folder: &Path) -> std::path::PathBuf {
        let path = folder.join(format!("motion.{format}"));
        match format {
            "bvh" => {
                bvh::write_motion(&path, motion, &self.rest, &BvhWriteOptions::default()).unwrap();
            }
            "glb" => glb::write(&path, &SkinnedMesh::of(&self.body), motion).unwrap(),
            "amass.npz" => {
                amass::write(&path, motion, Some(self.pelvis())).unwrap();
            }
            "motion.npz" => {
                let recording = Recording {
                    motion: motion.clone(),
                    name: "round trip".into(),
                    rest_pelvis: self.pelvis(),
                    source: None,
                    licence: None,
                    notes: Vec::new(),
                };
                native::write(&path, &recording).unwrap();
            }
            _ => std::fs::write(&path, csv::format_rotations(motion, self.pelvis())).unwrap(),
        }
        path
    }

    fn joints(&self, motion: &Motion) -> Vec<Vec3> {
        let clip = SkeletonClip::from_motion(motion, &self.rest).unwrap();
        let frames = 0..clip.frame_count();
        frames
            .flat_map(|frame| clip.pose(frame).positions)
            .collect()
    }

    /// Largest distance of a joint between two motions, in millimetres.
    fn difference(&self, a: &Motion, b: &Motion) -> f32 {
        let (rate, other) = (a.frame_rate().per_second(), b.frame_rate().per_second());
        assert!((rate / other - 1.0).abs() < 1e-4, "{rate} {other}");
        let (a, b) = (self.joints(a), self.joints(b));
        assert_eq!(a.len(), b.len());
        let distances = a.iter().zip(&b).map(|(a, b)| a.distance(*b));
        1000.0 * distances.fold(0.0, f32::max)
    }
}

const FORMATS: [&str; 5] = ["motion.npz", "amass.npz", "csv", "bvh", "glb"];

#[test]
fn every_format_gives_back_what_it_was_given() {
    let person = Person::new();
    let folder = tempfile::tempdir().unwrap();
    for format in FORMATS {
        let mut worst = 0.0f32;
        for clip in embedded::clips() {
            let motion = person.adopt(&clip.load().unwrap());
            let again = person.read(&person.write(format, &motion, folder.path()));
            worst = worst.max(person.difference(&motion, &again));
        }
        println!("{format}: {worst:.4} mm");
        assert!(worst < 0.01, "{format}: {worst} mm");
    }
}

#[test]
fn through_all_formats_one_after_the_other() {
    let person = Person::new();
    let folder = tempfile::tempdir().unwrap();
    for clip in embedded::clips() {
        let motion = person.adopt(&clip.load().unwrap());
        let mut at = motion.clone();
        for format in FORMATS.iter().chain(FORMATS.iter().rev()) {
            at = person.read(&person.write(format, &at, folder.path()));
        }
        let worst = person.difference(&motion, &at);
        println!("{} through ten files: {worst:.4} mm", clip.name);
        assert!(worst < 0.02, "{}: {worst} mm", clip.name);
    }
}

#[test]
fn positions_as_a_table_keep_their_places() {
    let person = Person::new();
    for clip in embedded::clips() {
        let motion = person.adopt(&clip.load().unwrap());
        let joints = person.joints(&motion);
        let skeleton = FeatureSkeleton::HumanMl3d;
        let positions = JointPositions::new(motion.frame_rate(), skeleton, joints.clone()).unwrap();
        let text = csv::format_positions(&positions).unwrap();
        let path = Path::new("positions.csv");
        let again = csv::parse_positions(text.as_bytes(), path, &ReadOptions::default()).unwrap();
        let again: Vec<Vec3> = again.frames().flatten().copied().collect();
        assert_eq!(again.len(), joints.len());
        let distances = again.iter().zip(&joints).map(|(a, b)| a.distance(*b));
        assert!(distances.fold(0.0, f32::max) < 2e-6);
    }
}
