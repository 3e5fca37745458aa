//! What we write comes back.

use physique_body::{Body, Joint, open_body_low};
use physique_motion::glb::{SkinnedMesh, to_glb};
use physique_motion::mapping::{BodyRest, MappingOptions, map_to_body};
use physique_motion::{SkeletonClip, embedded};

use crate::file::parse;

#[test]
fn what_we_write_comes_back_to_a_tenth_of_a_millimetre() {
    let body = Body::new(open_body_low().unwrap(), &[0.8, -1.0]).unwrap();
    let mut worst = 0.0f32;
    for clip in embedded::clips() {
        let motion = clip.load().unwrap().motion;
        let file = to_glb(&SkinnedMesh::of(&body), &motion, clip.name).unwrap();
        let read = parse(&file).unwrap();
        let [(name, again)] = &read[..] else {
            panic!("one animation")
        };
        assert_eq!(name, clip.name);
        let (rate, known) = (
            again.frame_rate().per_second(),
            motion.frame_rate().per_second(),
        );
        assert!((rate / known - 1.0).abs() < 1e-4, "{rate} {known}");
        assert_eq!(again.frame_count(), motion.frame_count());
        let direct = SkeletonClip::from_motion(&motion, &BodyRest::from(&body)).unwrap();
        for frame in 0..motion.frame_count() {
            let (a, b) = (again.pose(frame), direct.pose(frame));
            for joint in Joint::ALL {
                let at = again.skeleton().find(joint.name()).unwrap();
                worst = worst.max(a.positions[at].distance(b.positions[joint.index()]));
                let turn = a.rotations[at].angle_between(b.rotations[joint.index()]);
                assert!(turn < 2e-3, "{turn}");
            }
        }
        // Mapped, it is the motion that was written.
        let options = MappingOptions {
            share_wrist_twist: false,
            ..MappingOptions::default()
        };
        let mapped = map_to_body(again, &BodyRest::from(&body), &options).unwrap();
        let error = mapped.report.fit_error.all;
        assert!(error.max_cm < 0.01, "{}: {error:?}", clip.name);
    }
    assert!(worst < 1e-4, "{worst} m");
    println!("largest difference of a joint: {:.5} mm", worst * 1000.0);
}
