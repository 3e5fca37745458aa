//! What must hold for any motion: invariances, masks, frame rates, damages.

use std::sync::LazyLock;

use glam::{DVec3, Quat, Vec3};
use physique_body::{Body, Joint, Sex, open_body};
use physique_motion::{FrameRate, Motion, embedded};
use physique_physics::{
    Centroid, Error, Physics, PhysicsMeasures, PhysicsOptions, Protocol, Support, protocol,
};
use proptest::prelude::*;

static PHYSICS: LazyLock<Physics> = LazyLock::new(|| {
    let body = Body::mean(open_body().unwrap(), Sex::Neutral).unwrap();
    Physics::new(&body).unwrap()
});

fn measure(motion: &Motion) -> PhysicsMeasures {
    PHYSICS.measure(motion, &PhysicsOptions::default()).unwrap()
}

fn walk() -> Motion {
    embedded::clip("walk").unwrap().load().unwrap().motion
}

/// The same motion with every frame changed.
fn changed(motion: &Motion, change: impl Fn(usize, &mut Vec3, &mut [Quat])) -> Motion {
    let mut roots = motion.root_translation().to_vec();
    let mut rotations = motion.rotations().to_vec();
    for (frame, root) in roots.iter_mut().enumerate() {
        let joints = &mut rotations[frame * Joint::COUNT..(frame + 1) * Joint::COUNT];
        change(frame, root, joints);
    }
    Motion::new(motion.frame_rate(), None, roots, rotations).unwrap()
}

/// A motion in the rest pose, with the soles at this height over time.
fn rigid(fps: f64, frames: usize, height: impl Fn(f64) -> f64) -> Motion {
    let ground = f64::from(PHYSICS.body().rest_ground());
    let root = |frame: usize| Vec3::Y * (height(frame as f64 / fps) - ground) as f32;
    Motion::new(
        FrameRate::new(fps).unwrap(),
        None,
        (0..frames).map(root).collect(),
        vec![Quat::IDENTITY; frames * Joint::COUNT],
    )
    .unwrap()
}

#[test]
fn standing_still_is_stable_with_the_zero_moment_point_under_the_centre() {
    let found = measure(&rigid(30.0, 60, |_| 0.0));
    let balance = found.balance.measured.unwrap();
    assert_eq!(balance.stable_percent, 100.0);
    assert!(balance.margin_worst_m > 0.02, "{balance:?}");
    assert_eq!(found.feet.slide_mean_m_s, 0.0);
    assert!(found.ground.penetration_mean_m < 1e-6 && found.ground.floating_mean_m < 1e-6);
    for frame in &found.frames {
        assert_eq!(frame.support, Support::Ground);
        if let Some(point) = frame.zero_moment_point {
            let centre = frame.centre_of_mass;
            assert!((point.x - centre.x).abs() < 1e-6 && (point.y - centre.z).abs() < 1e-6);
        }
    }
    let smooth = found.smoothness.unwrap();
    assert!(smooth.jerk_mean_m_s3 < 1e-3 && smooth.jitter_mean_m < 1e-9);
}

#[test]
fn free_fall_is_counted_and_never_judged() {
    let found = measure(&rigid(30.0, 40, |t| 0.3 + 6.0 * t - 4.905 * t * t));
    assert!(
        found
            .frames
            .iter()
            .all(|frame| frame.support == Support::Flight)
    );
    assert_eq!(found.balance.measured, None);
    assert_eq!(found.balance.measured_frames, 0);
    assert_eq!(
        found.balance.flight_frames + found.balance.border_frames,
        40
    );
    assert_eq!(found.ground.floating_mean_m, 0.0);
    assert_eq!(found.ground.flight_frames_percent, 100.0);
    let loads = found.frames.iter().filter_map(|frame| frame.centroid);
    assert!(
        loads
            .map(|centroid| centroid.load())
            .all(|load| load.abs() < 1e-3)
    );
}

#[test]
fn hovering_is_floating_and_never_judged() {
    let found = measure(&rigid(30.0, 40, |_| 0.2));
    assert!(
        found
            .frames
            .iter()
            .all(|frame| frame.support == Support::Nothing)
    );
    assert_eq!(found.balance.measured, None);
    assert!((found.ground.floating_mean_m - 0.2).abs() < 1e-5);
}

#[test]
fn what_lands_bears_the_body_at_once_and_until_it_leaves() {
    for fps in [20.0, 30.0, 60.0, 120.0] {
        let (lands, leaves) = ((1.0 * fps) as usize, (2.0 * fps) as usize);
        let step = 1.5 / fps as f32;
        let motion = changed(
            &rigid(fps, (3.0 * fps) as usize, |_| 0.0),
            |frame, root, _| {
                root.z += step * (frame.min(lands) + frame.saturating_sub(leaves)) as f32;
            },
        );
        let found = measure(&motion);
        for (frame, physics) in found.frames.iter().enumerate() {
            let bears = physics.base_of_support.is_some();
            let near = (0.02 * fps) as usize;
            if (lands..=leaves).contains(&frame) {
                assert!(bears, "{fps} fps: frame {frame} rests");
            } else if !(lands - near..=leaves + near).contains(&frame) {
                assert!(!bears, "{fps} fps: frame {frame} moves");
            }
        }
    }
}

#[test]
fn frames_are_counted_once() {
    for clip in embedded::clips() {
        let motion = clip.load().unwrap().motion;
        let balance = measure(&motion).balance;
        let counted = balance.measured_frames
            + balance.border_frames
            + balance.flight_frames
            + balance.unsupported_frames
            + balance.unloaded_frames;
        assert_eq!(counted, motion.frame_count(), "{}", clip.name);
    }
}

proptest! {
    #[test]
    fn mass_does_not_move_the_zero_moment_point(
        scale in 0.1..10.0_f64,
        acceleration in prop::array::uniform3(-3.0..3.0_f64),
        turn in prop::array::uniform3(-30.0..30.0_f64),
    ) {
        let centroid = Centroid {
            mass: 70.0,
            centre: DVec3::new(0.1, 0.9, -0.2),
            acceleration: acceleration.into(),
            angular_momentum_rate: turn.into(),
            ..Centroid::default()
        };
        let heavy = Centroid {
            mass: 70.0 * scale,
            angular_momentum_rate: centroid.angular_momentum_rate * scale,
            ..centroid
        };
        let (a, b) = (centroid.zero_moment_point(0.0), heavy.zero_moment_point(0.0));
        prop_assert!(a.unwrap().distance(b.unwrap()) < 1e-12);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn turning_and_moving_changes_nothing(
        yaw in -3.0..3.0_f32, x in -20.0..20.0_f32, z in -20.0..20.0_f32,
    ) {
        let turn = Quat::from_rotation_y(yaw);
        let pelvis = PHYSICS.body().rest_joint(Joint::Pelvis);
        let motion = walk();
        let moved = changed(&motion, |_, root, rotations| {
            *root = turn * (pelvis + *root) - pelvis + Vec3::new(x, 0.0, z);
            rotations[0] = turn * rotations[0];
        });
        same(&measure(&motion), &measure(&moved), 2e-3);
    }
}

#[test]
fn a_mirror_changes_nothing() {
    let motion = walk();
    let mirrored = changed(&motion, |_, root, rotations| {
        root.x = -root.x;
        let before = rotations.to_vec();
        for joint in Joint::ALL {
            let other = before[joint.mirrored().index()];
            rotations[joint.index()] = Quat::from_xyzw(other.x, -other.y, -other.z, other.w);
        }
    });
    // The open body is symmetric to a millimetre or so, and a vertex decides about contact.
    same(&measure(&motion), &measure(&mirrored), 0.03);
}

/// Measures agree: absolutely in metres and seconds, per cents to 100 times as much.
fn same(a: &PhysicsMeasures, b: &PhysicsMeasures, tolerance: f64) {
    let close = |a: f64, b: f64, scale: f64| {
        assert!((a - b).abs() <= tolerance * scale, "{a} {b}");
    };
    close(
        a.ground.penetration_mean_m,
        b.ground.penetration_mean_m,
        0.1,
    );
    close(a.ground.floating_mean_m, b.ground.floating_mean_m, 0.1);
    close(a.feet.slide_mean_m_s, b.feet.slide_mean_m_s, 1.0);
    let (balance, other) = (a.balance.measured.unwrap(), b.balance.measured.unwrap());
    close(balance.outside_mean_m, other.outside_mean_m, 1.0);
    close(balance.margin_mean_m, other.margin_mean_m, 1.0);
    let (smooth, other) = (a.smoothness.unwrap(), b.smoothness.unwrap());
    close(
        smooth.acceleration_mean_m_s2,
        other.acceleration_mean_m_s2,
        1.0,
    );
    close(smooth.jitter_mean_m, other.jitter_mean_m, 0.1);
}

/// Weight shifted from foot to foot, arms swinging, at up to 1.5 Hz.
fn swaying(fps: f64) -> Motion {
    let frames = (6.0 * fps) as usize + 1;
    let standing = rigid(fps, frames, |_| 0.0);
    changed(&standing, |frame, root, rotations| {
        let t = frame as f32 / fps as f32;
        let wave = |hertz: f32, phase: f32| (std::f32::consts::TAU * hertz * t + phase).sin();
        *root += Vec3::new(
            0.05 * wave(0.5, 0.0),
            0.004 * wave(1.5, 1.0),
            0.02 * wave(0.7, 2.0),
        );
        rotations[Joint::LeftShoulder.index()] = Quat::from_rotation_x(0.5 * wave(1.0, 0.0));
        rotations[Joint::RightShoulder.index()] = Quat::from_rotation_x(-0.5 * wave(1.0, 0.4));
        rotations[Joint::Spine1.index()] = Quat::from_rotation_z(0.1 * wave(1.2, 0.0));
    })
}

#[test]
fn sampling_at_20_to_120_fps_agrees() {
    let fine = measure(&swaying(120.0));
    let (balance, smooth) = (fine.balance.measured.unwrap(), fine.smoothness.unwrap());
    for fps in [20.0, 30.0, 60.0] {
        let found = measure(&swaying(fps));
        let within = |a: f64, b: f64, part: f64| {
            assert!((a - b).abs() <= part * b.abs(), "{fps} fps: {a} {b}");
        };
        let (other, joints) = (found.balance.measured.unwrap(), found.smoothness.unwrap());
        within(other.stable_percent, balance.stable_percent, 0.03);
        within(
            other.signed_distance_mean_m,
            balance.signed_distance_mean_m,
            0.03,
        );
        within(other.margin_mean_m, balance.margin_mean_m, 0.03);
        within(found.feet.slide_mean_m_s, fine.feet.slide_mean_m_s, 0.05);
        within(
            joints.acceleration_mean_m_s2,
            smooth.acceleration_mean_m_s2,
            0.02,
        );
        within(joints.jerk_mean_m_s3, smooth.jerk_mean_m_s3, 0.03);
        // The same moment of both, away from the ends.
        for second in 1..5 {
            let at = |measures: &PhysicsMeasures, fps: f64| {
                measures.frames[(f64::from(second) * fps) as usize]
                    .zero_moment_point
                    .unwrap()
            };
            assert!(at(&found, fps).distance(at(&fine, 120.0)) < 2e-3);
        }
    }
}

#[test]
fn each_damage_is_seen_by_its_measure() {
    let motion = walk();
    let whole = measure(&motion);
    let lift = |height: f32| measure(&changed(&motion, |_, root, _| root.y += height));
    let sunk = lift(-0.03);
    let deeper = sunk.ground.penetration_mean_m - whole.ground.penetration_mean_m;
    assert!((0.02..=0.03001).contains(&deeper), "{deeper}");
    let lifted = lift(0.06);
    assert!(lifted.ground.floating_mean_m > whole.ground.floating_mean_m + 0.03);
    assert!(lifted.ground.unsupported_frames_percent > 50.0);
    for other in [&sunk, &lifted] {
        let (a, b) = (other.smoothness.unwrap(), whole.smoothness.unwrap());
        assert!((a.jerk_mean_m_s3 - b.jerk_mean_m_s3).abs() < 1e-3 * b.jerk_mean_m_s3);
    }
    let step = 0.1 * motion.frame_rate().frame_seconds() as f32;
    let slid = measure(&changed(&motion, |frame, root, _| {
        root.x += step * frame as f32
    }));
    assert!(slid.feet.slide_mean_m_s > whole.feet.slide_mean_m_s + 0.02);
    assert!((slid.ground.penetration_mean_m - whole.ground.penetration_mean_m).abs() < 1e-6);
    let shaken = measure(&changed(&motion, |frame, root, _| {
        root.z += if frame % 2 == 0 { 0.005 } else { -0.005 };
    }));
    let (shaken, calm) = (shaken.smoothness.unwrap(), whole.smoothness.unwrap());
    assert!(shaken.jitter_mean_m > calm.jitter_mean_m + 0.003);
}

#[test]
fn threads_do_not_matter() {
    let motion = embedded::clip("dance").unwrap().load().unwrap().motion;
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| measure(&motion))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn short_far_and_odd_motions_are_measured_or_refused() {
    let options = PhysicsOptions::default();
    let none = Motion::new(FrameRate::new(30.0).unwrap(), None, vec![], vec![]).unwrap();
    assert!(matches!(
        PHYSICS.measure(&none, &options),
        Err(Error::NoFrames)
    ));
    for frames in 1..4 {
        let found = measure(&rigid(30.0, frames, |_| 0.0));
        assert_eq!((found.frames.len(), found.balance.measured), (frames, None));
        assert_eq!(found.smoothness, None);
    }
    assert!(measure(&rigid(0.01, 9, |_| 0.0)).balance.measured.is_some());
    let too_fast = PHYSICS.measure(&rigid(FrameRate::FASTEST, 5, |_| 0.0), &options);
    assert!(matches!(too_fast, Err(Error::Option { .. })));
    measure(&rigid(30.0, 20, |_| 1e30));
    let bad = PhysicsOptions {
        balance_cutoff_hz: f64::NAN,
        ..options
    };
    let refused = PHYSICS.measure(&walk(), &bad);
    assert!(matches!(refused, Err(Error::Option { .. })));
}

#[test]
fn every_protocol_measures_every_clip() {
    for clip in embedded::clips() {
        let motion = clip.load().unwrap().motion;
        for name in Protocol::ALL.map(Protocol::name) {
            let protocol: Protocol = name.parse().unwrap();
            let floor = protocol::Floor::default();
            let measures = protocol::measure(&PHYSICS, &motion, protocol, floor).unwrap();
            for measure in measures {
                assert!(
                    measure.value.is_none_or(f64::is_finite),
                    "{name} {measure:?}"
                );
            }
        }
    }
    assert!("humos".parse::<Protocol>().is_err());
}
