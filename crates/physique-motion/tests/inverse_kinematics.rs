//! Positions to rotations: real clips whose rotations are known, invariants, and bad input.

#![allow(clippy::unwrap_used)]

use glam::{Quat, Vec3};
use physique_body::{Body, Joint, open_body};
use physique_motion::features::{FeatureSkeleton, JointPositions, extract};
use physique_motion::inverse_kinematics::{IkOptions, IkSolution, solve};
use physique_motion::mapping::BodyRest;
use physique_motion::{Error, FrameRate, Motion, embedded};
use proptest::prelude::*;

mod support;

fn positions_of(motion: &Motion, body: &BodyRest) -> JointPositions {
    let frames = 0..motion.frame_count();
    let joints = frames
        .flat_map(|frame| support::pose(motion, body, frame).1)
        .collect();
    JointPositions::new(motion.frame_rate(), FeatureSkeleton::HumanMl3d, joints).unwrap()
}

fn where_it_was(body: &BodyRest) -> IkOptions {
    IkOptions {
        soles_on_ground: false,
        ..IkOptions::for_joints_of(body)
    }
}

/// Mean and largest angle between world orientations of a joint, in degrees.
fn angles(joint: Joint, ours: &Motion, truth: &Motion, body: &BodyRest) -> (f32, f32) {
    let frames = (0..truth.frame_count()).map(|frame| {
        let world = |motion| support::pose(motion, body, frame).0[joint.index()];
        let (ours, truth): (Quat, Quat) = (world(ours), world(truth));
        ours.angle_between(truth).to_degrees()
    });
    let (sum, largest) = frames.fold((0.0, 0.0_f32), |(sum, most), next| {
        (sum + next, most.max(next))
    });
    (sum / truth.frame_count() as f32, largest)
}

#[test]
fn real_clips_come_back_from_their_joint_positions() {
    let body = BodyRest::from(&Body::new(open_body().unwrap(), &[]).unwrap());
    for clip in embedded::clips() {
        let recording = clip.load().unwrap();
        let truth = recording.motion;
        let solution = solve(&positions_of(&truth, &body), &body, &where_it_was(&body)).unwrap();
        let ours = &solution.motion;
        let (metres, joint) = support::largest_distance(ours, &truth, &body);
        println!(
            "{}: positions within {:.4} mm ({joint})",
            recording.name,
            1000.0 * metres
        );
        assert!(metres < 1e-5, "{}: {metres} m at {joint}", recording.name);
        assert!((solution.scale - 1.0).abs() < 1e-5);
        // What three bones fix comes back, tilt and all; what one bone leaves open comes near.
        for joint in Joint::ALL {
            let (mean, largest) = angles(joint, ours, &truth, &body);
            println!("    {joint}: mean {mean:.2} degrees, largest {largest:.2}");
            let allowed = match joint {
                Joint::Pelvis | Joint::Spine3 => 0.2,
                Joint::Spine1 | Joint::Spine2 => 0.5,
                Joint::LeftHip | Joint::RightHip | Joint::LeftKnee | Joint::RightKnee => 10.0,
                Joint::LeftShoulder | Joint::RightShoulder => 10.0,
                Joint::LeftElbow | Joint::RightElbow => 10.0,
                _ => continue,
            };
            assert!(
                mean < allowed,
                "{}, {joint}: {mean} degrees",
                recording.name
            );
        }
    }
}

#[test]
fn a_walk_with_hinges_for_knees_and_elbows_comes_back() {
    let (truth, body) = (support::walk(80), support::figure());
    let solution = solve(&positions_of(&truth, &body), &body, &where_it_was(&body)).unwrap();
    let (metres, joint) = support::largest_distance(&solution.motion, &truth, &body);
    assert!(metres < 1e-5, "{metres} m at {joint}");
    assert!(solution.fit.all.max_cm < 0.01, "{:?}", solution.fit.all);
    // Elbows that are nearly straight now and then leave the upper arms' twist open there.
    for (joint, allowed) in [
        (Joint::Pelvis, 0.1),
        (Joint::Spine3, 0.1),
        (Joint::LeftHip, 5.0),
        (Joint::RightHip, 5.0),
        (Joint::LeftShoulder, 10.0),
        (Joint::RightShoulder, 10.0),
        (Joint::LeftElbow, 10.0),
    ] {
        let (mean, _) = angles(joint, &solution.motion, &truth, &body);
        assert!(mean < allowed, "{joint}: {mean} degrees");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// A body turned as a whole, upside down if need be, gives the same local rotations and turns
    /// at the pelvis only.
    #[test]
    fn the_root_takes_all_of_the_tilt(
        axis in prop::array::uniform3(-3.0..3.0_f32), shift in prop::array::uniform3(-5.0..5.0_f32),
    ) {
        let body = support::figure();
        let upright = positions_of(&support::walk(6), &body);
        let turn = Quat::from_scaled_axis(Vec3::from_array(axis));
        let turned = upright.positions().iter().map(|&p| turn * p + Vec3::from_array(shift)).collect();
        let turned = JointPositions::new(upright.frame_rate(), upright.skeleton(), turned).unwrap();
        let options = where_it_was(&body);
        let (a, b) = (solve(&upright, &body, &options).unwrap(), solve(&turned, &body, &options).unwrap());
        for frame in 0..6 {
            let (a, b) = (a.motion.frame_rotations(frame), b.motion.frame_rotations(frame));
            prop_assert!((turn * a[0]).angle_between(b[0]) < 3e-3);
            for joint in 1..22 {
                prop_assert!(a[joint].angle_between(b[joint]) < 3e-3, "joint {joint}");
            }
        }
    }

    /// Generated motions stretch and shake. The skeleton stays whole, the error is about the noise.
    #[test]
    fn noise_is_met_and_told(noise in prop::collection::vec(-0.02..0.02_f32, 66 * 8)) {
        let body = support::figure();
        let clean = positions_of(&support::walk(8), &body);
        let noise = noise.as_chunks().0.iter().copied().map(Vec3::from_array);
        let shaken = clean.positions().iter().zip(noise).map(|(&p, noise)| p + noise).collect();
        let shaken = JointPositions::new(clean.frame_rate(), clean.skeleton(), shaken).unwrap();
        let solution = solve(&shaken, &body, &where_it_was(&body)).unwrap();
        prop_assert!(solution.fit.all.max_cm > 0.05 && solution.fit.all.max_cm < 12.0, "{:?}", solution.fit.all);
        prop_assert!(solution.fit.all.mean_cm < 3.0, "{:?}", solution.fit.all);
        prop_assert!(solution.motion.rotations().iter().all(|rotation| rotation.is_normalized()));
    }
}

fn on_ground(positions: &JointPositions, body: &BodyRest) -> IkSolution {
    solve(positions, body, &IkOptions::for_joints_of(body)).unwrap()
}

#[test]
fn any_unit_gives_the_same_motion_with_its_soles_on_the_ground() {
    let body = support::figure();
    let metres = positions_of(&support::walk(10), &body);
    let changed = metres
        .positions()
        .iter()
        .map(|p| (*p + Vec3::Y) * 600.0)
        .collect();
    let units = JointPositions::new(metres.frame_rate(), metres.skeleton(), changed).unwrap();
    let (a, b) = (on_ground(&metres, &body), on_ground(&units, &body));
    assert!((b.scale * 600.0 - 1.0).abs() < 1e-5);
    assert!(support::largest_distance(&a.motion, &b.motion, &body).0 < 1e-4);
    assert!(b.fit.all.max_cm < 0.05);
    let lowest = (0..10).flat_map(|frame| {
        let positions = support::pose(&b.motion, &body, frame).1;
        Joint::FEET.map(|joint| positions[joint.index()].y - body.height(joint))
    });
    assert!(lowest.fold(f32::INFINITY, f32::min).abs() < 1e-4);
}

#[test]
fn kits_joints_are_unmirrored_and_solved_in_metres() {
    let body = support::figure();
    let smpl = positions_of(&support::walk(5), &body);
    // KIT's joints where SMPL's are, mirrored and in its unit; heels under the ankles.
    let from_smpl = [
        0, 3, 9, 12, 15, 16, 18, 20, 17, 19, 21, 1, 4, 7, 7, 10, 2, 5, 8, 8, 11,
    ];
    let joints = smpl
        .frames()
        .flat_map(|p| from_smpl.map(|joint| p[joint] * Vec3::new(-600.0, 600.0, 600.0)));
    let rate = FrameRate::new(12.5).unwrap();
    let kit = JointPositions::new(rate, FeatureSkeleton::Kit, joints.collect()).unwrap();
    let solution = solve(&kit, &body, &IkOptions::default()).unwrap();
    assert!(
        (solution.scale * 600.0 - 1.0).abs() < 0.02,
        "{}",
        solution.scale
    );
    let (world, positions) = support::pose(&solution.motion, &body, 2);
    // The walk goes towards +X and its left is at -Z; so is the result's.
    assert!((world[0] * Vec3::Z).dot(Vec3::X) > 0.9);
    assert!(positions[Joint::LeftHip.index()].z < positions[Joint::RightHip.index()].z);
    assert!(solution.fit.all.mean_cm < 6.0, "{:?}", solution.fit.all);
}

#[test]
fn bodies_without_bones_are_refused_and_collapsed_frames_survive() {
    let body = support::figure();
    let rate = FrameRate::new(20.0).unwrap();
    let nowhere = vec![Vec3::ONE; 22 * 3];
    let nowhere = JointPositions::new(rate, FeatureSkeleton::HumanMl3d, nowhere).unwrap();
    // Numbers so large that their squares overflow are an error or a motion, never a panic.
    let huge = positions_of(&support::walk(3), &body);
    let huge = huge.positions().iter().map(|&p| p * 1e30).collect();
    let huge = JointPositions::new(rate, FeatureSkeleton::HumanMl3d, huge).unwrap();
    assert!(matches!(
        solve(&huge, &body, &IkOptions::default()),
        Err(Error::NotFinite { .. })
    ));
    assert!(extract(&huge).is_err());

    assert!(matches!(
        solve(&nowhere, &body, &IkOptions::default()),
        Err(Error::NoBone { .. })
    ));

    let mut joints = positions_of(&support::walk(5), &body).positions().to_vec();
    joints[22 * 2..22 * 3].fill(Vec3::Y);
    let joints = JointPositions::new(rate, FeatureSkeleton::HumanMl3d, joints).unwrap();
    let solution = solve(&joints, &body, &IkOptions::default()).unwrap();
    assert!(
        solution
            .motion
            .rotations()
            .iter()
            .all(|rotation| rotation.is_normalized())
    );
}
