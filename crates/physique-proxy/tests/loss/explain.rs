//! Words for what the loss saw.

use glam::{Quat, Vec3};
use physique_body::Joint;
use physique_proxy::{Pairs, SelfIntersection, explain, pose_matrices};

use crate::real;
use crate::support::Random;

#[test]
fn a_forearm_in_the_trunk_is_named() {
    let (body, pairs) = real::body_and_pairs();
    let mut folded = [Quat::IDENTITY; Joint::COUNT];
    folded[Joint::LeftShoulder.index()] = Quat::from_rotation_z(-1.2);
    folded[Joint::LeftElbow.index()] = Quat::from_rotation_z(-1.6);
    let found = explain(&body, &pairs, &pose_matrices(&folded));
    let deepest = found[0];
    let arm = [Joint::LeftElbow, Joint::LeftWrist, Joint::LeftShoulder];
    assert!(arm.contains(&deepest.parts[1]), "{deepest}");
    assert!(deepest.depth > 0.02 && deepest.depth < 0.2, "{deepest}");
    let sentence = deepest.to_string();
    assert!(
        sentence.contains("left") && sentence.ends_with(" cm deep"),
        "{sentence}"
    );
    assert!(found.is_sorted_by(|a, b| a.depth >= b.depth));
}

/// Explanations and loss see the same pairs: with the linear penalty, depths add up.
#[test]
fn explains_exactly_what_the_loss_counts() {
    let mut random = Random(31);
    let body = random.body(40);
    let pairs = Pairs::all(40).expect("few");
    let loss = SelfIntersection::new(&body, &pairs).expect("sound");
    for _ in 0..20 {
        let pose = random.pose(1.0);
        let mut losses = [0.0];
        loss.losses(&[pose], &mut losses).expect("finite");
        let found = explain(&body, &pairs, &pose);
        assert_eq!(found.is_empty(), losses[0] == 0.0);
        let deepest = found
            .iter()
            .map(|overlap| overlap.depth.powi(2))
            .sum::<f32>();
        assert!(deepest <= losses[0] * 1.0001);
        for overlap in &found {
            let parts = overlap.spheres.map(|sphere| body.dominant_joint(sphere));
            assert_eq!(parts, overlap.parts);
            let mut centres = Vec::new();
            body.pose(&pose, &mut centres);
            for sphere in overlap.spheres {
                let inside: Vec3 = overlap.middle - centres[sphere];
                assert!(inside.length() < body.radii[sphere] + 1e-5);
            }
        }
    }
}
