//! Bodies against the ground, things and each other: analytic cases, slow references and finite
//! differences.

use glam::{DMat3, DVec3, Vec3};
use physique_body::Joint;
use physique_proxy::scene::{
    Actor, ActorGradient, Capsule, HeightField, Obstacle, Plane, SceneOptions, body_loss,
    obstacle_loss,
};
use physique_proxy::{Error, Penalty, PoseMatrices, SphereBody, pose_matrices, reference};

use crate::support::Random;

/// One sphere on the pelvis.
fn ball(radius: f32) -> SphereBody {
    SphereBody {
        rest_joints: [Vec3::ZERO; 22],
        centres: vec![Vec3::ZERO],
        radii: vec![radius],
        blend_weights: vec![[(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]],
    }
}

fn hills() -> HeightField {
    let mut random = Random(53);
    let heights = (0..9 * 7).map(|_| 0.2 * f64::from(random.next())).collect();
    HeightField::new([-1.3, -0.9], 0.35, 9, heights).expect("sound")
}

#[test]
fn a_ball_sinks_as_deep_as_it_should() {
    let body = ball(0.5);
    let poses = [pose_matrices(&[]); 3];
    let translations = [0.6, 0.5, 0.2].map(|height| Vec3::Y * height);
    let actor = Actor {
        body: &body,
        poses: &poses,
        translations: &translations,
    };
    let flat = HeightField::new([-1.0, -1.0], 1.0, 3, vec![0.0; 9]).expect("sound");
    let ground = Plane::default();
    let post = Capsule {
        start: DVec3::NEG_Y,
        end: DVec3::NEG_Y * 0.1,
        radius: 0.1,
    };
    let obstacles: [&dyn Obstacle; 3] = [&ground, &flat, &post];
    for obstacle in obstacles {
        let mut losses = [f32::NAN; 3];
        let (mut by_poses, mut by_translations) = ([[[0.0; 9]; 22]; 3], [Vec3::NAN; 3]);
        let gradient = ActorGradient {
            by_poses: &mut by_poses,
            by_translations: &mut by_translations,
        };
        let options = SceneOptions {
            penalty: Penalty::Squared,
            tolerance: 0.1,
        };
        let weights = [1.0, 1.0, 2.0];
        obstacle_loss(
            &actor,
            &[obstacle],
            &options,
            &weights,
            &mut losses,
            Some(gradient),
        )
        .expect("finite");
        assert_eq!(losses[..2], [0.0; 2]);
        assert!((losses[2] - 0.04).abs() < 1e-6, "{}", losses[2]);
        assert!(
            by_translations[2].distance(Vec3::NEG_Y * 0.8) < 1e-5,
            "{}",
            by_translations[2]
        );
    }
}

/// Signed distances have the gradients that they say.
#[test]
fn distances_equal_finite_differences() {
    let mut random = Random(59);
    let tilted = Plane {
        normal: DVec3::new(0.2, 0.9, -0.1).normalize(),
        offset: 0.3,
    };
    let capsule = Capsule {
        start: DVec3::new(-0.3, 0.1, 0.2),
        end: DVec3::new(0.4, 0.6, -0.1),
        radius: 0.2,
    };
    let (ball, hills) = (Capsule::sphere(DVec3::splat(0.2), 0.3), hills());
    let obstacles: [&dyn Obstacle; 4] = [&tilted, &capsule, &ball, &hills];
    for obstacle in obstacles {
        for _ in 0..200 {
            let point = 1.5 * random.vector().as_dvec3();
            let (_, gradient) = obstacle.distance(point);
            let along = random.vector().as_dvec3();
            let step = 1e-7;
            let at = |step: f64| obstacle.distance(point + along * step).0;
            let difference = (at(step) - at(-step)) / (2.0 * step);
            let expected = gradient.dot(along);
            assert!(
                (difference - expected).abs() < 1e-5,
                "{point}: {difference} {expected}"
            );
        }
    }
}

/// Two spheres as capsules without length, and a capsule's ends.
#[test]
fn capsules_are_as_far_as_their_nearest_point() {
    let capsule = Capsule {
        start: DVec3::ZERO,
        end: DVec3::X,
        radius: 0.25,
    };
    let cases = [
        (DVec3::new(0.5, 1.0, 0.0), 0.75),
        (DVec3::new(-3.0, 4.0, 0.0), 4.75),
        (DVec3::new(2.0, 0.0, 0.0), 0.75),
        (DVec3::new(0.3, 0.0, 0.1), -0.15),
    ];
    for (point, expected) in cases {
        assert!((capsule.distance(point).0 - expected).abs() < 1e-12);
    }
}

struct Case {
    body: SphereBody,
    poses: Vec<PoseMatrices>,
    translations: Vec<Vec3>,
}

impl Case {
    fn new(random: &mut Random, frames: usize) -> Self {
        Self {
            body: random.body(24),
            poses: (0..frames).map(|_| random.pose(0.8)).collect(),
            translations: (0..frames).map(|_| 0.3 * random.vector()).collect(),
        }
    }

    fn actor(&self) -> Actor<'_> {
        Actor {
            body: &self.body,
            poses: &self.poses,
            translations: &self.translations,
        }
    }

    /// Posed centres with one number of the pose moved.
    fn centres(&self, frame: usize, moved: impl Fn(&mut [DMat3; 22], &mut DVec3)) -> Vec<DVec3> {
        let mut rotations = reference::rotations(&self.poses[frame]);
        let mut translation = self.translations[frame].as_dvec3();
        moved(&mut rotations, &mut translation);
        reference::pose(&self.body, &rotations, translation).centres
    }

    fn outputs(&self) -> (Vec<PoseMatrices>, Vec<Vec3>) {
        let frames = self.poses.len();
        (vec![[[0.0; 9]; 22]; frames], vec![Vec3::ZERO; frames])
    }
}

/// Brute force, straight from the equation.
fn body_reference(bodies: [&SphereBody; 2], centres: [&[DVec3]; 2], options: &SceneOptions) -> f64 {
    let mut loss = 0.0;
    for (a, &at) in centres[0].iter().enumerate() {
        for (b, &other) in centres[1].iter().enumerate() {
            let touching = f64::from(bodies[0].radii[a]) + f64::from(bodies[1].radii[b]);
            let depth = touching - at.distance(other) - options.tolerance;
            if depth > 0.0 {
                loss += options.penalty.of(depth).0;
            }
        }
    }
    loss
}

fn obstacle_reference(
    body: &SphereBody,
    centres: &[DVec3],
    obstacles: &[&dyn Obstacle],
    options: &SceneOptions,
) -> f64 {
    let mut loss = 0.0;
    for (&centre, &radius) in centres.iter().zip(&body.radii) {
        for obstacle in obstacles {
            let depth = f64::from(radius) - obstacle.distance(centre).0 - options.tolerance;
            if depth > 0.0 {
                loss += options.penalty.of(depth).0;
            }
        }
    }
    loss
}

/// Compares a gradient with central differences of `loss(moved)`, by some numbers of each pose.
fn compare(
    case: &Case,
    frame: usize,
    weight: f64,
    gradient: (&PoseMatrices, Vec3),
    loss: impl Fn(&[DVec3]) -> f64,
) {
    let step = 1e-6;
    let difference = |moved: &dyn Fn(f64, &mut [DMat3; 22], &mut DVec3)| {
        let at = |step: f64| loss(&case.centres(frame, |r, t| moved(step, r, t)));
        weight * (at(step) - at(-step)) / (2.0 * step)
    };
    for axis in 0..3 {
        let found = f64::from(gradient.1[axis]);
        let expected = difference(&|step, _, translation| translation[axis] += step);
        assert!(
            (found - expected).abs() < 2e-5 * (1.0 + expected.abs()),
            "{found} {expected}"
        );
    }
    for joint in (0..Joint::COUNT).step_by(3) {
        for entry in 0..9 {
            let found = f64::from(gradient.0[joint][entry]);
            let expected = difference(&|step, rotations, _| {
                rotations[joint].col_mut(entry % 3)[entry / 3] += step;
            });
            assert!(
                (found - expected).abs() < 2e-5 * (1.0 + expected.abs()),
                "{found} {expected}"
            );
        }
    }
}

#[test]
fn obstacles_equal_reference_and_finite_differences() {
    let mut random = Random(61);
    let case = Case::new(&mut random, 5);
    let (ground, hills) = (
        Plane {
            offset: -0.4,
            ..Default::default()
        },
        hills(),
    );
    let post = Capsule {
        start: DVec3::ZERO,
        end: DVec3::X,
        radius: 0.15,
    };
    let obstacles: [&dyn Obstacle; 3] = [&ground, &hills, &post];
    for (penalty, tolerance) in [(Penalty::Squared, 0.0), (Penalty::Linear, 0.02)] {
        let options = SceneOptions { penalty, tolerance };
        let weights = [1.0, 0.5, 2.0, 0.0, 1.0];
        let mut losses = [0.0; 5];
        let (mut by_poses, mut by_translations) = case.outputs();
        let gradient = ActorGradient {
            by_poses: &mut by_poses,
            by_translations: &mut by_translations,
        };
        obstacle_loss(
            &case.actor(),
            &obstacles,
            &options,
            &weights,
            &mut losses,
            Some(gradient),
        )
        .expect("finite");
        let mut only_losses = [0.0; 5];
        obstacle_loss(
            &case.actor(),
            &obstacles,
            &options,
            &weights,
            &mut only_losses,
            None,
        )
        .expect("finite");
        assert_eq!(losses, only_losses);
        assert!(losses.iter().sum::<f32>() > 0.1);
        for frame in 0..5 {
            let loss =
                |centres: &[DVec3]| obstacle_reference(&case.body, centres, &obstacles, &options);
            let expected = loss(&case.centres(frame, |_, _| {}));
            assert!((f64::from(losses[frame]) - expected).abs() < 1e-6 * (1.0 + expected));
            let gradient = (&by_poses[frame], by_translations[frame]);
            compare(&case, frame, f64::from(weights[frame]), gradient, loss);
        }
    }
}

#[test]
fn bodies_equal_reference_and_finite_differences() {
    let mut random = Random(67);
    let mut cases = [Case::new(&mut random, 4), Case::new(&mut random, 4)];
    for case in &mut cases {
        case.body.radii.iter_mut().for_each(|radius| *radius *= 2.0);
    }
    let bodies = [&cases[0].body, &cases[1].body];
    let options = SceneOptions {
        penalty: Penalty::Squared,
        tolerance: 0.01,
    };
    let weights = [1.0, 0.25, 1.0, 3.0];
    let mut losses = [0.0; 4];
    let [mut first, mut second] = [cases[0].outputs(), cases[1].outputs()];
    let gradients = [&mut first, &mut second].map(|(by_poses, by_translations)| ActorGradient {
        by_poses,
        by_translations,
    });
    let actors = [&cases[0].actor(), &cases[1].actor()];
    body_loss(actors, &options, &weights, &mut losses, Some(gradients)).expect("finite");
    assert!(losses.iter().sum::<f32>() > 0.1);
    for frame in 0..4 {
        let rest = cases.each_ref().map(|case| case.centres(frame, |_, _| {}));
        let expected = body_reference(bodies, [&rest[0], &rest[1]], &options);
        assert!((f64::from(losses[frame]) - expected).abs() < 1e-6 * (1.0 + expected));
        let weight = f64::from(weights[frame]);
        compare(
            &cases[0],
            frame,
            weight,
            (&first.0[frame], first.1[frame]),
            |centres| body_reference(bodies, [centres, &rest[1]], &options),
        );
        compare(
            &cases[1],
            frame,
            weight,
            (&second.0[frame], second.1[frame]),
            |centres| body_reference(bodies, [&rest[0], centres], &options),
        );
    }
}

/// Who is pushed does not depend on who is named first; bodies apart cost nothing.
#[test]
fn bodies_are_equal_before_the_loss() {
    let mut random = Random(71);
    let mut cases = [Case::new(&mut random, 3), Case::new(&mut random, 3)];
    let loss = |cases: [&Case; 2]| {
        let mut losses = [0.0; 3];
        let options = SceneOptions::default();
        let actors = [&cases[0].actor(), &cases[1].actor()];
        body_loss(actors, &options, &[1.0; 3], &mut losses, None).expect("finite");
        losses
    };
    let (one, other) = (loss([&cases[0], &cases[1]]), loss([&cases[1], &cases[0]]));
    for (one, other) in one.iter().zip(other) {
        assert!((one - other).abs() < 1e-6 * (1.0 + one));
    }
    cases[1]
        .translations
        .iter_mut()
        .for_each(|at| *at += Vec3::X * 10.0);
    assert_eq!(loss([&cases[0], &cases[1]]), [0.0; 3]);
}

#[test]
fn what_cannot_be_is_refused() {
    let mut random = Random(73);
    let mut case = Case::new(&mut random, 2);
    let options = SceneOptions::default();
    let error = obstacle_loss(&case.actor(), &[], &options, &[1.0], &mut [0.0; 2], None);
    assert!(matches!(
        error,
        Err(Error::Length {
            what: "Weights",
            ..
        })
    ));
    case.poses[1][5][0] = f32::NAN;
    let error = obstacle_loss(&case.actor(), &[], &options, &[1.0; 2], &mut [0.0; 2], None);
    assert!(matches!(error, Err(Error::NotFinite { frame: 1, .. })));
    let mut far = Case::new(&mut random, 2);
    far.translations = vec![Vec3::X * 100.0; 2];
    let actors = [&far.actor(), &case.actor()];
    let error = body_loss(actors, &options, &[1.0; 2], &mut [0.0; 2], None);
    assert!(matches!(error, Err(Error::NotFinite { frame: 1, .. })));
    for (columns, heights) in [(1, vec![0.0; 4]), (3, vec![0.0; 5]), (2, vec![f64::NAN; 4])] {
        assert!(HeightField::new([0.0; 2], 1.0, columns, heights).is_err());
    }
    assert!(HeightField::new([0.0; 2], 0.0, 2, vec![0.0; 4]).is_err());
}
