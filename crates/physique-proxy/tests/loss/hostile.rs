//! Poses and features of numbers that are none.

use physique_motion::features::{FeatureSkeleton, GradientRule, RotationLayer};
use physique_proxy::{
    Backend, Error, FeatureBatch, FeatureLoss, Pairs, PoseMatrices, SelfIntersection,
    SelfIntersectionOptions, SphereBody,
};

use crate::real;
use crate::support::Random;

fn loss_of(body: &SphereBody, pairs: &Pairs, backend: Backend) -> SelfIntersection {
    let options = SelfIntersectionOptions {
        backend: Some(backend),
        ..SelfIntersectionOptions::default()
    };
    SelfIntersection::with_options(body, pairs, &options).expect("sound")
}

/// Not one sphere has a place. Lanes tell what touches by a sign bit, which such numbers may have:
/// padded places behind the last sphere then count as touching, too.
#[test]
fn poses_without_a_number_are_refused() {
    let (body, pairs) = real::body_and_pairs();
    for backend in Backend::available() {
        let loss = loss_of(&body, &pairs, backend);
        let features = FeatureLoss::new(
            loss_of(&body, &pairs, backend),
            &RotationLayer::published(FeatureSkeleton::HumanMl3d),
            GradientRule::Full,
        );
        for number in [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for frames in [1, 16, 33] {
                let poses: Vec<PoseMatrices> = vec![[[number; 9]; 22]; frames];
                let weights = vec![1.0; frames];
                let mut losses = vec![0.0; frames];
                let mut by_poses = poses.clone();
                let none = |error: Error| matches!(error, Error::NotFinite { frame: 0, .. });
                assert!(none(loss.losses(&poses, &mut losses).unwrap_err()));
                let found = loss.gradient(&poses, &weights, &mut losses, &mut by_poses);
                assert!(none(found.unwrap_err()));
                let found = loss.shape_gradient(&poses, &weights, &mut losses, &mut by_poses);
                assert!(none(found.unwrap_err()));

                let columns = FeatureSkeleton::HumanMl3d.feature_count();
                let found = features.batch(&FeatureBatch {
                    skeleton: FeatureSkeleton::HumanMl3d,
                    statistics: None,
                    features: &vec![number; frames * columns],
                    frames,
                    lengths: &[frames],
                    weights: &weights,
                });
                assert!(none(found.unwrap_err()));
            }
        }
    }
}

#[test]
fn numbers_that_are_none_are_named() {
    let mut random = Random(5);
    let body = random.body(40);
    let pairs = Pairs::all(40).expect("few");
    for backend in Backend::available() {
        let loss = loss_of(&body, &pairs, backend);
        for (frame, joint, number) in [
            (0, 0, f32::NAN),
            (17, 21, f32::INFINITY),
            (70, 10, f32::NAN),
        ] {
            let mut poses: Vec<_> = (0..75).map(|_| random.pose(1.0)).collect();
            poses[frame][joint][4] = number;
            poses[74][3][0] = f32::NAN;
            let error = loss.losses(&poses, &mut [0.0; 75]).expect_err("not finite");
            let Error::NotFinite {
                frame: found,
                joint: at,
            } = error
            else {
                panic!("{error}");
            };
            assert_eq!((found, at.index()), (frame, joint));
        }
        let mut poses = [random.pose(1.0); 3];
        poses[1] = poses[1].map(|matrix| matrix.map(|number| number * 1e15));
        let error = loss.losses(&poses, &mut [0.0; 3]).expect_err("too large");
        assert!(matches!(error, Error::Overflow { frame: 1 }), "{error}");
    }
}
