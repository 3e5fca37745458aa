//! Scores mean what they say: on poses whose answer is known, and under changes that must not matter.

use glam::{Quat, Vec3};
use physique::body::{Body, Joint, Sex, open_body, open_body_low};
use physique::load::load_recording;
use physique::motion::{FrameRate, Motion, embedded};
use physique::{Error, MotionScore, Protocol, ScoreOptions, Scorer};

fn scorer(protocol: Protocol) -> Scorer {
    let body = Body::mean(open_body_low().unwrap(), Sex::Neutral).unwrap();
    let options = ScoreOptions {
        protocols: vec![protocol],
        ..ScoreOptions::default()
    };
    Scorer::new(body, options).unwrap()
}

fn motion_of(frames: &[&[(Joint, Quat)]]) -> Motion {
    let rotations = frames.iter().flat_map(|turned| {
        let mut rotations = [Quat::IDENTITY; Joint::COUNT];
        for &(joint, rotation) in *turned {
            rotations[joint.index()] = rotation;
        }
        rotations
    });
    let rate = FrameRate::new(30.0).unwrap();
    Motion::new(
        rate,
        None,
        vec![Vec3::ZERO; frames.len()],
        rotations.collect(),
    )
    .unwrap()
}

/// The left upper arm hangs, the forearm is turned inwards through the belly.
fn forearm_in_the_belly() -> [(Joint, Quat); 2] {
    [
        (Joint::LeftShoulder, Quat::from_rotation_z(-1.3)),
        (Joint::LeftElbow, Quat::from_rotation_z(-1.7)),
    ]
}

/// The dance, which has arms around the trunk.
fn dance(scorer: &Scorer) -> Motion {
    let clips = embedded::clips();
    let clip = clips.iter().find(|clip| clip.name == "dance").unwrap();
    let recording = clip.load().unwrap();
    load_recording(recording, scorer.body()).unwrap().motion
}

fn mean(score: &MotionScore) -> f64 {
    score.self_intersection.as_ref().unwrap().mean_cm3
}

#[test]
fn the_rest_pose_of_the_open_body_is_free() {
    for model in [open_body().unwrap(), open_body_low().unwrap()] {
        for sex in [Sex::Female, Sex::Neutral, Sex::Male] {
            let body = Body::mean(model.clone(), sex).unwrap();
            let score = physique::score(&motion_of(&[&[]]), &body).unwrap();
            let found = score.self_intersection.unwrap();
            assert_eq!(found.mean_cm3, 0.0, "{sex:?}: {found:?}");
            assert!(found.crease_mean_cm3 < 1.0, "{sex:?}: {found:?}");
        }
    }
}

#[test]
fn a_forearm_in_the_belly_is_found_by_name_and_time() {
    let scorer = scorer(Protocol::Native);
    let bent = forearm_in_the_belly();
    let score = scorer.score(&motion_of(&[&[], &bent, &bent, &[]])).unwrap();
    let found = score.self_intersection.unwrap();
    assert!(found.worst_cm3 > 100.0, "{found:?}");
    assert!((found.mean_cm3 / found.worst_cm3 - 0.5).abs() < 1e-9);
    assert_eq!(found.worst_frame, 1);
    assert_eq!(found.frames_above_50_cm3_percent, 50.0);
    let worst = &found.pairs[0];
    assert!(
        worst.parts.iter().any(|part| part == "left forearm"),
        "{worst:?}"
    );
    assert!(worst.parts.iter().all(|part| !part.starts_with("right")));
    assert_eq!(worst.intervals_s.len(), 1);
    assert!((worst.intervals_s[0][0] - 1.0 / 30.0).abs() < 1e-9);
    assert!((worst.intervals_s[0][1] - 3.0 / 30.0).abs() < 1e-9);
}

#[test]
fn a_bent_knee_is_a_crease_and_no_intersection() {
    let scorer = scorer(Protocol::Native);
    let bent = [(Joint::LeftKnee, Quat::from_rotation_x(2.3))];
    let score = scorer.score(&motion_of(&[&bent])).unwrap();
    let found = score.self_intersection.unwrap();
    assert!(found.crease_mean_cm3 > 50.0, "{found:?}");
    assert_eq!(found.mean_cm3, 0.0, "{found:?}");
}

#[test]
fn pairs_add_up_to_the_whole() {
    let scorer = scorer(Protocol::Native);
    let frames = scorer.self_intersections(&dance(&scorer), |_| ()).unwrap();
    for frame in frames {
        let sum = |crease| {
            let pairs = frame.pairs.iter().filter(|pair| pair.crease == crease);
            pairs.map(|pair| pair.cm3).sum::<f64>()
        };
        assert!((sum(false) - frame.intersection_cm3).abs() < 1e-9);
        assert!((sum(true) - frame.crease_cm3).abs() < 1e-9);
    }
}

#[test]
fn where_a_body_is_and_faces_does_not_change_its_self_intersection() {
    let scorer = scorer(Protocol::Native);
    let here = dance(&scorer);
    let turn = Quat::from_euler(glam::EulerRot::YXZ, 2.0, 0.3, -0.5);
    let mut rotations = here.rotations().to_vec();
    for root in rotations.iter_mut().step_by(Joint::COUNT) {
        *root = turn * *root;
    }
    let elsewhere = here
        .root_translation()
        .iter()
        .map(|t| *t + Vec3::new(40.0, -3.0, 7.0));
    let there = Motion::new(here.frame_rate(), None, elsewhere.collect(), rotations).unwrap();
    let self_intersection = |motion| scorer.score(motion).unwrap().self_intersection;
    assert_eq!(self_intersection(&here), self_intersection(&there));
}

#[test]
fn the_number_of_threads_changes_nothing() {
    for protocol in [Protocol::Native, Protocol::Sia] {
        let scorer = scorer(protocol);
        let motion = dance(&scorer);
        let scored = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build()
                .unwrap()
                .install(|| scorer.score(&motion).unwrap())
        };
        let one = scored(1);
        assert_eq!(one, scored(2));
        assert_eq!(one, scored(5));
    }
}

#[test]
fn a_mirrored_motion_has_mirrored_pairs() {
    let scorer = scorer(Protocol::Native);
    let left = forearm_in_the_belly();
    let right = left.map(|(joint, rotation)| {
        let [x, y, z, w] = rotation.to_array();
        (joint.mirrored(), Quat::from_xyzw(x, -y, -z, w))
    });
    let found = [&left, &right].map(|pose| {
        let score = scorer.score(&motion_of(&[pose])).unwrap();
        score.self_intersection.unwrap()
    });
    let names = |side: usize| found[side].pairs[0].parts.clone();
    assert_eq!(names(0).map(|name| name.replace("left", "right")), names(1));
    // The lines do not lie symmetrically: a few per cent at 1 cm.
    let ratio = found[0].mean_cm3 / found[1].mean_cm3;
    assert!((ratio - 1.0).abs() < 0.03, "{ratio}");
}

#[test]
fn finer_lines_agree_with_the_default() {
    let motion = motion_of(&[&forearm_in_the_belly()]);
    let body = Body::mean(open_body_low().unwrap(), Sex::Neutral).unwrap();
    let at = |spacing_m| {
        let options = ScoreOptions {
            spacing_m,
            ..ScoreOptions::default()
        };
        mean(
            &Scorer::new(body.clone(), options)
                .unwrap()
                .score(&motion)
                .unwrap(),
        )
    };
    let (coarse, fine) = (at(0.01), at(0.002));
    assert!(
        (coarse / fine - 1.0).abs() < 0.03,
        "{coarse} cm3 at 1 cm, {fine} at 2 mm"
    );
}

#[test]
fn the_published_metric_sees_a_large_intersection() {
    let scorer = scorer(Protocol::Sia);
    let free = scorer.score(&motion_of(&[&[]])).unwrap();
    assert!(free.self_intersection.is_none());
    let free = free.sia.unwrap();
    assert_eq!(free.self_intersection_cm3, 0.0);
    assert!(free.volume_cm3 > 0.0);
    // Both legs on one line: litres.
    let crossed = [
        (Joint::LeftHip, Quat::from_rotation_z(-0.25)),
        (Joint::RightHip, Quat::from_rotation_z(0.25)),
    ];
    let crossed = scorer.score(&motion_of(&[&crossed])).unwrap().sia.unwrap();
    assert!(crossed.self_intersection_cm3 > 432.0, "{crossed:?}");
}

#[test]
fn nothing_is_never_a_good_score() {
    for protocol in [Protocol::Native, Protocol::Sia] {
        let outcome = scorer(protocol).score(&motion_of(&[]));
        assert!(matches!(outcome, Err(Error::NoFrames)));
    }
}

#[test]
fn a_sunken_motion_scores_its_depth_and_loses_nothing_else() {
    let scorer = scorer(Protocol::Native);
    let here = dance(&scorer);
    let sunk = here.root_translation().iter().map(|t| *t - Vec3::Y * 0.5);
    let sunk = Motion::new(
        here.frame_rate(),
        None,
        sunk.collect(),
        here.rotations().to_vec(),
    )
    .unwrap();
    let depth = |score: &MotionScore| score.ground.as_ref().unwrap().penetration_mean_cm;
    let jerk = |score: &MotionScore| score.smoothness.as_ref().unwrap().jerk_mean_m_s3;
    let score = |motion| scorer.score(motion).unwrap();
    let (here, sunk) = (score(&here), score(&sunk));
    assert!(depth(&here) < 1.0);
    assert!(depth(&sunk) > 45.0);
    assert!((jerk(&here) - jerk(&sunk)).abs() < 1e-3 * jerk(&here));
}
