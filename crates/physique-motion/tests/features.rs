//! Behaviour of the features: what they do not see, what they bring back, statistics and files.

#![allow(clippy::unwrap_used)]

use glam::{Mat3, Quat, Vec3};
use physique_motion::features::{
    BoneRotations, FeatureLayout, FeatureSkeleton, FeatureStatistics, Heading, JointFile,
    JointPositions, MotionFeatures, Rotation6d, StatisticsGatherer, between, canonicalise, extract,
    matrix, multiply, parse, read, recover_from_positions, recover_from_rotations, rotate,
    write_features, write_positions,
};
use physique_motion::npz::npy_f32;
use physique_motion::{Error, FrameRate, Limits, ReadOptions};
use proptest::prelude::*;

mod support;

fn rate() -> FrameRate {
    FrameRate::new(20.0).unwrap()
}

/// A walk, as positions.
fn walk(frames: usize) -> JointPositions {
    let (motion, figure) = (support::walk(frames), support::figure());
    let positions = (0..frames).flat_map(|frame| support::pose(&motion, &figure, frame).1);
    JointPositions::new(rate(), FeatureSkeleton::HumanMl3d, positions.collect()).unwrap()
}

/// A motion of KIT's joints: its skeleton with smoothly turning bones.
fn kit(frames: usize) -> JointPositions {
    let skeleton = FeatureSkeleton::Kit;
    let (offsets, parents) = (skeleton.offsets(), skeleton.parents());
    let mut positions = Vec::new();
    for frame in 0..frames {
        let mut joints = vec![Vec3::new(3.0 * frame as f32, 500.0, 0.5 * frame as f32); 21];
        for joint in [
            11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10,
        ] {
            let phase = 0.2 * frame as f32 + joint as f32;
            let turn = Quat::from_scaled_axis(0.3 * Vec3::new(phase.sin(), 0.2, phase.cos()));
            joints[joint] = joints[parents[joint].unwrap()] + turn * offsets[joint];
        }
        positions.extend(joints);
    }
    JointPositions::new(rate(), skeleton, positions).unwrap()
}

fn moved(motion: &JointPositions, change: impl Fn(Vec3) -> Vec3) -> JointPositions {
    let positions = motion.positions().iter().copied().map(change).collect();
    JointPositions::new(motion.frame_rate(), motion.skeleton(), positions).unwrap()
}

fn farthest(ours: &[Vec3], theirs: &[Vec3]) -> f32 {
    assert_eq!(ours.len(), theirs.len());
    ours.iter()
        .zip(theirs)
        .map(|(a, b)| a.distance(*b))
        .fold(0.0, f32::max)
}

fn largest_difference(ours: &[f32], theirs: &[f32]) -> f32 {
    assert_eq!(ours.len(), theirs.len());
    ours.iter()
        .zip(theirs)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f32::max)
}

#[test]
fn features_bring_the_positions_back_both_ways() {
    for (motion, tolerance) in [(walk(70), 1e-5), (kit(70), 2e-2)] {
        let features = extract(&motion).unwrap();
        assert_eq!(features.frame_count(), 69);
        let canonical = canonicalise(&motion).unwrap();
        let joints = motion.skeleton().joint_count();
        let expected = &canonical.positions()[..69 * joints];
        let from_positions = recover_from_positions(&features).unwrap();
        let offsets = motion.skeleton().offsets();
        let from_rotations = recover_from_rotations(&features, &offsets).unwrap();
        assert!(farthest(from_positions.positions(), expected) < tolerance);
        assert!(farthest(from_rotations.positions(), expected) < 3.0 * tolerance);
    }
}

#[test]
fn canonical_motions_stand_on_the_floor_at_the_origin_and_face_z_and_stay_so() {
    for (motion, tolerance) in [(walk(30), 1e-5), (kit(30), 2e-2)] {
        let once = canonicalise(&moved(&motion, |joint| joint * 1.3 + Vec3::splat(4.0))).unwrap();
        let lowest = once
            .positions()
            .iter()
            .fold(f32::INFINITY, |low, joint| low.min(joint.y));
        assert_eq!(lowest, 0.0);
        let root = once.frame(0)[0];
        assert!(root.x.abs() < tolerance && root.z.abs() < tolerance);
        let twice = canonicalise(&once).unwrap();
        assert!(farthest(once.positions(), twice.positions()) < tolerance);
    }
}

#[test]
fn half_the_turn_is_stored_and_the_step_is_seen_from_its_end() {
    // A rigid body that turns by 0.015 rad a frame and steps to where it then faces.
    let figure = canonicalise(&walk(1)).unwrap();
    let mut positions = Vec::new();
    let mut place = Vec3::ZERO;
    for frame in 0..200 {
        let heading = Quat::from_rotation_y(0.015 * frame as f32);
        positions.extend(figure.frame(0).iter().map(|&joint| heading * joint + place));
        place += Quat::from_rotation_y(0.015 * (frame + 1) as f32) * Vec3::Z * 0.02;
    }
    let motion = JointPositions::new(rate(), FeatureSkeleton::HumanMl3d, positions).unwrap();
    let features = extract(&motion).unwrap();
    // Beyond the reach of the filter from both ends, which keeps an even turn as it is; the hips
    // that count backwards put all headings of a rigid body off by one and the same angle.
    let rows: Vec<&[f32]> = features.rows().skip(85).take(30).collect();
    let off = (rows[0][1] / rows[0][2]).atan();
    for row in rows {
        assert!((row[0] + 0.0075).abs() < 1e-5, "{}", row[0]);
        let step = Vec3::new(row[1], 0.0, row[2]);
        assert!(
            (step.length() - 0.02).abs() < 1e-5 && ((step.x / step.z).atan() - off).abs() < 1e-3
        );
    }
    assert!(off.abs() < 0.2, "{off}");
}

#[test]
fn contacts_are_ones_where_nothing_moves_and_zeros_where_feet_swing() {
    let still = moved(&walk(1), |joint| joint);
    let twice = [still.positions(), still.positions()].concat();
    let still = JointPositions::new(rate(), FeatureSkeleton::HumanMl3d, twice).unwrap();
    assert_eq!(extract(&still).unwrap().values()[259..], [1.0; 4]);
    let jumping = still.frames().enumerate().flat_map(|(frame, joints)| {
        joints
            .iter()
            .map(move |&joint| joint + Vec3::Y * 0.06 * frame as f32)
            .collect::<Vec<_>>()
    });
    let jumping =
        JointPositions::new(rate(), FeatureSkeleton::HumanMl3d, jumping.collect()).unwrap();
    assert_eq!(extract(&jumping).unwrap().values()[259..], [0.0; 4]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn place_and_heading_of_the_whole_motion_do_not_matter(
        yaw in -3.0..3.0_f32, x in -2.0..2.0_f32, y in -2.0..2.0_f32, z in -2.0..2.0_f32,
    ) {
        let motion = walk(40);
        let turn = Quat::from_rotation_y(yaw);
        let elsewhere = moved(&motion, |joint| turn * joint + Vec3::new(x, y, z));
        let (here, there) = (extract(&motion).unwrap(), extract(&elsewhere).unwrap());
        let difference = largest_difference(here.values(), there.values());
        // Coordinates of some metres are rounded to a quarter of a micrometre, which turns bones of
        // some centimetres by 1e-5, those nearly opposite to their rest direction by more.
        prop_assert!(difference < 1e-4, "{difference}");
    }

    #[test]
    fn bones_keep_the_data_sets_lengths_at_any_scale(scale in 0.2..5.0_f32) {
        let small = canonicalise(&moved(&walk(10), |joint| joint * scale)).unwrap();
        let offsets = FeatureSkeleton::HumanMl3d.offsets();
        for joints in small.frames() {
            for (joint, parent) in FeatureSkeleton::HumanMl3d.parents().into_iter().enumerate().skip(1) {
                let length = joints[joint].distance(joints[parent.unwrap()]);
                prop_assert!((length - offsets[joint].length()).abs() < 2e-6);
            }
        }
    }

    #[test]
    fn the_shortest_rotation_takes_one_direction_to_the_other(
        a in prop::array::uniform3(-1.0..1.0_f32), b in prop::array::uniform3(-1.0..1.0_f32),
    ) {
        let (a, b) = (Vec3::from_array(a), Vec3::from_array(b));
        prop_assume!(a.length() > 0.01 && b.length() > 0.01 && a.angle_between(b) < 3.1);
        let q = between(a, b);
        prop_assert!(rotate(q, a.normalize()).distance(b.normalize()) < 2e-5);
        prop_assert!((matrix(q) * a).distance(rotate(q, a)) < 1e-5);
        prop_assert!((matrix(multiply(q, q)) - matrix(q) * matrix(q)).abs_diff_eq(Mat3::ZERO, 1e-5));
    }

    #[test]
    fn six_numbers_are_a_rotation_in_either_convention(axis in prop::array::uniform3(-3.0..3.0_f32)) {
        let rotation = Mat3::from_quat(Quat::from_scaled_axis(Vec3::from_array(axis)));
        let columns = Rotation6d::columns(Rotation6d::columns_of(&rotation)).to_matrix().unwrap();
        let rows = Rotation6d::rows(Rotation6d::rows_of(&rotation)).to_matrix().unwrap();
        prop_assert!(columns.abs_diff_eq(rotation, 1e-6) && rows.abs_diff_eq(rotation, 1e-6));
    }
}

#[test]
fn opposite_directions_and_none_make_rotations_all_the_same() {
    for direction in [Vec3::X, Vec3::NEG_Y, Vec3::new(0.3, -4.0, 2.0)] {
        let half_turn = between(direction, -direction);
        assert!(half_turn.is_normalized());
        assert!(rotate(half_turn, direction).distance(-direction) < 1e-5);
    }
    assert_eq!(between(Vec3::ZERO, Vec3::X), Quat::IDENTITY);
    assert_eq!(
        Rotation6d::columns([1.0, 0.0, 0.0, 2.0, 0.0, 0.0]).to_matrix(),
        None
    );
    assert_eq!(Rotation6d::rows([0.0; 6]).to_matrix(), None);
}

#[test]
fn six_numbers_keep_the_direction_of_the_first_and_the_plane_of_both() {
    let matrix = Rotation6d::columns([0.0, 3.0, 0.0, -2.0, 5.0, 0.0])
        .to_matrix()
        .unwrap();
    let expected = Mat3::from_cols(Vec3::Y, Vec3::NEG_X, Vec3::Z);
    assert!(matrix.abs_diff_eq(expected, 1e-6), "{matrix:?}");
}

#[test]
fn mirroring_twice_is_the_identity_and_features_follow_positions() {
    for motion in [walk(50), kit(50)] {
        assert_eq!(motion.mirrored().mirrored(), motion);
        assert_ne!(motion.mirrored(), motion);
        let features = extract(&motion).unwrap();
        assert_eq!(features.mirrored().mirrored(), features);
    }
    // KIT's skeleton is as good as symmetric, so its mirrored features are those of the mirror image.
    let motion = kit(50);
    let (image, mirrored) = (
        extract(&motion.mirrored()).unwrap(),
        extract(&motion).unwrap().mirrored(),
    );
    let difference = largest_difference(image.values(), mirrored.values());
    assert!(difference < 2e-2, "{difference}");
}

#[test]
fn statistics_are_population_deviations_averaged_by_block() {
    let skeleton = FeatureSkeleton::HumanMl3d;
    // Column c alternates between c + spread and c - spread.
    let spread = |column: usize| if column.is_multiple_of(2) { 1.0 } else { 3.0 };
    let rows = |sign: f32| (0..263).map(move |column| column as f32 + sign * spread(column));
    let mut gatherer = StatisticsGatherer::new(skeleton);
    for sign in [1.0, -1.0, -1.0, 1.0] {
        let features = MotionFeatures::new(rate(), skeleton, rows(sign).collect()).unwrap();
        gatherer.add(&features).unwrap();
    }
    let statistics = gatherer.finish().unwrap();
    let means: Vec<f32> = (0..263).map(|column| column as f32).collect();
    assert_eq!(statistics.mean(), means);
    let deviation = statistics.deviation();
    assert_eq!(deviation[..4], [1.0, 2.0, 2.0, 3.0]);
    // 63 columns from 4 on: 32 of spread 1 and 31 of spread 3.
    assert!((deviation[4] - (32.0 + 31.0 * 3.0) / 63.0).abs() < 1e-6);
    assert!(deviation[4..67].iter().all(|&value| value == deviation[4]));
    assert_eq!(deviation[259..], [2.0; 4]);

    // The published evaluators' root and contact deviations are 1/25 of the data set's.
    let biased = statistics
        .with_feature_bias(FeatureStatistics::EFFECTIVE_FEATURE_BIAS)
        .unwrap();
    assert_eq!(
        biased.deviation()[..4],
        [1.0 / 25.0, 2.0 / 25.0, 2.0 / 25.0, 3.0 / 25.0]
    );
    assert_eq!(biased.deviation()[4..259], deviation[4..259]);
    assert_eq!(biased.deviation()[259..], [2.0 / 25.0; 4]);

    let mut row: Vec<f32> = rows(1.0).collect();
    statistics.normalise(&mut row);
    assert_eq!((row[0], row[1], row[3]), (1.0, 1.5, 1.0));
    statistics.denormalise(&mut row);
    assert!(largest_difference(&row, &rows(1.0).collect::<Vec<_>>()) < 1e-4);
}

#[test]
fn statistics_that_cannot_normalise_are_refused() {
    let skeleton = FeatureSkeleton::Kit;
    let gatherer = StatisticsGatherer::new(skeleton);
    assert!(matches!(gatherer.finish(), Err(Error::NoFrames)));
    let mut deviation = vec![1.0; 251];
    deviation[7] = 0.0;
    let error = FeatureStatistics::new(skeleton, vec![0.0; 251], deviation).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("Column 7 of the standard deviation"),
        "{error}"
    );
    let error = FeatureStatistics::new(skeleton, vec![0.0; 263], vec![1.0; 263]).unwrap_err();
    assert!(error.to_string().contains("251"), "{error}");
    let mut gatherer = StatisticsGatherer::new(skeleton);
    assert!(gatherer.add(&extract(&walk(5)).unwrap()).is_err());
}

#[test]
fn files_come_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("clip.npy");
    let options = ReadOptions {
        frame_rate: Some(rate()),
        ..ReadOptions::default()
    };
    for motion in [walk(7), kit(7)] {
        write_positions(&path, &motion).unwrap();
        assert_eq!(
            read(&path, &options).unwrap(),
            JointFile::Positions(motion.clone())
        );
        let features = extract(&motion).unwrap();
        write_features(&path, &features).unwrap();
        let back = read(&path, &options).unwrap();
        assert_eq!(back, JointFile::Features(features.clone()));
        let positions = back.into_positions().unwrap();
        assert_eq!(positions, recover_from_positions(&features).unwrap());
    }
    // Silent files have their data set's rate.
    write_positions(&path, &kit(2)).unwrap();
    let positions = read(&path, &ReadOptions::default())
        .unwrap()
        .into_positions()
        .unwrap();
    assert_eq!(positions.frame_rate().per_second(), 12.5);
}

#[test]
fn arrays_that_are_no_motion_are_refused_with_the_reason() {
    let options = ReadOptions::default();
    let refused = |shape: &[usize], values: &[f32]| {
        let bytes = npy_f32(shape, values).unwrap();
        parse(bytes, "clip.npy", &options).unwrap_err().to_string()
    };
    let message = refused(&[2, 5], &[0.0; 10]);
    assert!(
        message.contains("clip.npy, the shape: expected [frames][263]"),
        "{message}"
    );
    let mut values = [0.0; 2 * 66];
    values[66 + 3] = f32::NAN;
    let message = refused(&[2, 22, 3], &values);
    assert!(message.contains("Frame 1, joint left_hip"), "{message}");
    let mut values = [0.0; 263];
    values[200] = f32::INFINITY;
    let message = refused(&[1, 263], &values);
    assert!(message.contains("Frame 0, column 200"), "{message}");
    let message = refused(&[0, 263], &[]);
    assert!(
        message.contains("expected at least one frame, found [0, 263]"),
        "{message}"
    );

    let tight = ReadOptions {
        limits: Limits {
            frames: 1,
            ..Limits::default()
        },
        ..options.clone()
    };
    let bytes = npy_f32(&[2, 22, 3], &[0.0; 132]).unwrap();
    assert!(matches!(
        parse(bytes, "clip.npy", &tight),
        Err(Error::Limit { .. })
    ));

    // Cut anywhere, the file is refused and nothing panics.
    let whole = npy_f32(&[1, 22, 3], &[0.5; 66]).unwrap();
    for length in 0..whole.len() {
        assert!(parse(whole[..length].to_vec(), "clip.npy", &options).is_err());
    }
}

#[test]
fn motions_without_a_body_in_them_are_refused_with_frame_and_joint() {
    let skeleton = FeatureSkeleton::HumanMl3d;
    let mut positions = walk(3).positions().to_vec();
    positions[22 + 7] = positions[22 + 4];
    let motion = JointPositions::new(rate(), skeleton, positions).unwrap();
    let message = extract(&motion).unwrap_err().to_string();
    assert_eq!(
        message,
        "Frame 1: expected a bone from left_knee to left_ankle, found both in one place."
    );
    let flat = moved(&walk(3), |joint| Vec3::new(0.0, joint.y, 0.0));
    assert!(matches!(extract(&flat), Err(Error::NoHeading { frame: 0 })));
    assert!(matches!(extract(&walk(1)), Err(Error::NoFrames)));
    assert!(JointPositions::new(rate(), skeleton, vec![Vec3::ZERO; 23]).is_err());
    let features = extract(&walk(3)).unwrap();
    assert!(recover_from_rotations(&features, &[Vec3::Y; 21]).is_err());
    let mut values = features.values().to_vec();
    values[FeatureLayout::of(skeleton).rotations].fill(0.0);
    let broken = MotionFeatures::new(rate(), skeleton, values).unwrap();
    let message = recover_from_rotations(&broken, &skeleton.offsets())
        .unwrap_err()
        .to_string();
    assert!(message.starts_with("Frame 0, joint left_hip"), "{message}");
}

#[test]
fn chains_start_at_the_root_and_the_first_frame_is_taken_to_face_z() {
    let turned = moved(&walk(4), |joint| Quat::from_rotation_y(1.0) * joint);
    let bones = BoneRotations::from_positions(&turned, Heading::EachFrame).unwrap();
    let frames: Vec<&[Quat]> = bones.frames().collect();
    assert_eq!(frames[0][0], Quat::IDENTITY);
    assert!(frames[1][0].angle_between(Quat::IDENTITY) > 0.5);
    // The collar hangs at the chest, yet its rotation is relative to the root's.
    let joints = turned.frame(1);
    let collar = rotate(multiply(frames[1][0], frames[1][13]), Vec3::X);
    assert!(collar.distance((joints[13] - joints[9]).normalize()) < 1e-5);
}
