//! MDM's geometric losses of motions that are rotations: against equations in 64 bits.

use std::sync::LazyLock;

use burn::tensor::{Device, Tensor, TensorData};
use glam::{DMat3, DVec3, Mat3, Quat, Vec3};
use physique::body::{Body, Joint, open_body};
use physique_learn::Error;
use physique_learn::mdm::losses::FrameMask;
use physique_learn::mdm::rotation_losses::{
    foot_contact_error, joint_error, rotation_velocity_error,
};
use physique_learn::mdm::{ConditionKind, Mdm, MdmConfig, MdmTask, MdmTraining, RotationSkeleton};
use physique_learn::random::Random;
use physique_learn::trainer::{BatchCondition, MotionBatch, MotionSource, Task};
use physique_motion::features::Rotation6d;

const COLUMNS: usize = 150;
const FRAMES: usize = 5;
const LENGTHS: [usize; 2] = [5, 3];
const NUMBERS: usize = 2 * FRAMES * COLUMNS;
const PARENTS: [usize; 24] = [
    0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21,
];

static BODY: LazyLock<Body> =
    LazyLock::new(|| Body::new(open_body().expect("embedded"), &[]).expect("mean shape"));

fn skeleton() -> RotationSkeleton {
    RotationSkeleton::of_body(&BODY).expect("finite")
}

/// Made-up motions, whose feet move by some millimetres a frame: some of them stand.
fn motions(seed: u64) -> Vec<f32> {
    let mut random = Random::new(&[seed]);
    let mut number = |size: f64| (size * (2.0 * random.unit() - 1.0)) as f32;
    let start: Vec<f32> = (0..COLUMNS).map(|_| number(1.0)).collect();
    let moved = (0..NUMBERS).map(|index| start[index % COLUMNS] + number(0.01));
    moved.collect()
}

fn tensor(values: Vec<f32>, device: &Device) -> Tensor<3> {
    Tensor::from_data(TensorData::new(values, [2, FRAMES, COLUMNS]), device)
}

/// Positions of the joints of every frame of a motion, in 64 bits.
fn positions(motion: &[f64]) -> Vec<[DVec3; 24]> {
    let rest = |joint: usize| BODY.rest_joints()[joint].as_dvec3();
    let path = |frame: &[f64]| DVec3::from_slice(&frame[144..147]);
    let start = path(motion);
    let frames = motion.chunks_exact(COLUMNS).map(|frame| {
        let (mut at, mut world) = ([DVec3::ZERO; 24], [DMat3::IDENTITY; 24]);
        for joint in 0..24 {
            let rows = &frame[6 * joint..][..6];
            let first = DVec3::from_slice(&rows[..3]).normalize();
            let second = DVec3::from_slice(&rows[3..]);
            let second = (second - first * first.dot(second)).normalize();
            let local = DMat3::from_cols(first, second, first.cross(second)).transpose();
            let parent = PARENTS[joint];
            world[joint] = match joint {
                0 => local,
                _ => world[parent] * local,
            };
            let offset = match joint {
                0 => DVec3::ZERO,
                22 | 23 => 0.08 * (rest(joint - 2) - rest(joint - 4)).normalize(),
                _ => rest(joint) - rest(parent),
            };
            at[joint] = at[parent] + world[parent] * offset;
        }
        at.map(|joint| joint + path(frame) - start)
    });
    frames.collect()
}

/// The three losses of both motions, in 64 bits.
fn reference(predicted: &[f64], clean: &[f64]) -> [[f64; 2]; 3] {
    let of_motion = |motion: usize| {
        let range = motion * FRAMES * COLUMNS..(motion + 1) * FRAMES * COLUMNS;
        let (predicted, clean) = (&predicted[range.clone()], &clean[range]);
        let at = [predicted, clean].map(positions);
        let length = LENGTHS[motion];
        let mut sums = [0.0; 3];
        for frame in 0..length {
            let joints = at[0][frame].iter().zip(&at[1][frame]);
            sums[1] += joints.map(|(a, b)| a.distance_squared(*b)).sum::<f64>();
            if frame + 1 == length {
                break;
            }
            for column in 0..144 {
                let now = frame * COLUMNS + column;
                let step = |of: &[f64]| of[now + COLUMNS] - of[now];
                sums[0] += (step(predicted) - step(clean)).powi(2);
            }
            for joint in [7, 10, 8, 11] {
                let step = |of: usize| at[of][frame + 1][joint] - at[of][frame][joint];
                if step(1).length() <= 0.01 {
                    sums[2] += step(0).length_squared();
                }
            }
        }
        let (frames, steps) = (length as f64, length as f64 - 1.0);
        [
            sums[0] / (steps * 144.0),
            sums[1] / (frames * 72.0),
            sums[2] / (steps * 12.0),
        ]
    };
    let [first, second] = [0, 1].map(of_motion);
    [0, 1, 2].map(|loss| [first[loss], second[loss]])
}

/// The same by the crate, on tensors.
fn found(predicted: &Tensor<3>, clean: &Tensor<3>) -> [Tensor<1>; 3] {
    let (skeleton, mask) = (skeleton(), FrameMask::new(&LENGTHS, FRAMES, clean));
    let at = [predicted, clean].map(|motions| skeleton.positions(motions.clone()));
    let [at_predicted, at_clean] = at;
    [
        rotation_velocity_error(&skeleton, predicted.clone(), clean.clone(), &mask),
        Ok(joint_error(at_predicted.clone(), at_clean.clone(), &mask)),
        foot_contact_error(at_predicted, at_clean, &mask),
    ]
    .map(|loss| loss.expect("frames enough"))
}

fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f64> {
    let numbers = tensor.into_data().try_into_vec::<f32>().expect("floats");
    numbers.into_iter().map(f64::from).collect()
}

fn wide(numbers: &[f32]) -> Vec<f64> {
    numbers.iter().map(|&number| f64::from(number)).collect()
}

#[test]
fn rows_of_rotations_pose_the_body() {
    let mut random = Random::new(&[8]);
    let mut angle = || random.unit() as f32 * 2.0 - 1.0;
    let rotations: Vec<Quat> = (0..Joint::COUNT)
        .map(|_| Quat::from_scaled_axis(Vec3::new(angle(), angle(), angle())))
        .collect();
    let mut frame = vec![0.0_f32; COLUMNS];
    for joint in 0..24 {
        let rotation = rotations.get(joint).copied().unwrap_or(Quat::IDENTITY);
        let rows = Rotation6d::rows_of(&Mat3::from_quat(rotation));
        frame[6 * joint..][..6].copy_from_slice(&rows);
    }
    let motions = TensorData::new(frame, [1, 1, COLUMNS]);
    let found = skeleton().positions(Tensor::from_data(motions, &Device::flex()));
    let found = numbers(found);
    let mut world = [Quat::IDENTITY; Joint::COUNT];
    let mut expected = [Vec3::ZERO; Joint::COUNT];
    for joint in 0..Joint::COUNT {
        let parent = PARENTS[joint];
        let bone = BODY.rest_joints()[joint] - BODY.rest_joints()[parent];
        expected[joint] = expected[parent] + world[parent] * bone;
        let above = if joint == 0 {
            Quat::IDENTITY
        } else {
            world[parent]
        };
        world[joint] = above * rotations[joint];
    }
    for (joint, expected) in expected.iter().enumerate() {
        for (axis, expected) in expected.to_array().into_iter().enumerate() {
            let error = (found[3 * joint + axis] - f64::from(expected)).abs();
            assert!(error < 1e-5, "{joint}: {error}");
        }
    }
}

#[test]
fn values_and_gradients_are_those_of_the_equations() {
    let device = Device::flex().autodiff();
    let (predicted, clean) = (motions(1), motions(2));
    let leaf = tensor(predicted.clone(), &device).require_grad();
    let target = tensor(clean.clone(), &device);
    let (predicted, clean) = (wide(&predicted), wide(&clean));
    let expected = reference(&predicted, &clean);
    // Each motion counts otherwise, to tell them apart.
    let shares = [0.7, -1.9];
    let weights = Tensor::<1>::from_data([0.7_f32, -1.9], &device);
    for index in 0..3 {
        let loss = found(&leaf, &target)[index].clone();
        for (found, expected) in numbers(loss.clone()).into_iter().zip(expected[index]) {
            assert!(expected > 1e-6, "{index}: nothing to see");
            let error = (found - expected).abs() / expected;
            assert!(error < 1e-3, "{index}: {expected}, {error}");
        }
        let gradients = (loss * weights.clone()).sum().backward();
        let gradient = numbers(leaf.grad(&gradients).expect("it depends on it"));
        let most = gradient.iter().fold(0.0_f64, |most, by| most.max(by.abs()));
        let mut moved = predicted.clone();
        for column in 0..NUMBERS {
            let step = 1e-6;
            let mut at = |by: f64| {
                moved[column] = predicted[column] + by;
                let [first, second] = reference(&moved, &clean)[index];
                shares[0] * first + shares[1] * second
            };
            let expected = (at(step) - at(-step)) / (2.0 * step);
            moved[column] = predicted[column];
            let error = (gradient[column] - expected).abs();
            assert!(
                error < 2e-3 * most,
                "{index}, {column}: {expected}, {error}"
            );
        }
    }
}

#[test]
fn what_is_right_costs_nothing() {
    let device = Device::flex();
    let clean = tensor(motions(2), &device);
    let [velocities, joints, _] = found(&clean, &clean);
    for loss in [velocities, joints] {
        assert_eq!(numbers(loss), [0.0, 0.0]);
    }
    // A motion that stands keeps all feet where they are; a path elsewhere is no other motion.
    let standing = motions(1)[..COLUMNS].repeat(2 * FRAMES);
    let mut elsewhere = standing.clone();
    for frame in elsewhere.chunks_exact_mut(COLUMNS) {
        frame[144] += 3.0;
        // Behind the path there is nothing.
        frame[147] += 5.0;
    }
    let losses = found(&tensor(elsewhere, &device), &tensor(standing, &device));
    for loss in losses {
        let most = numbers(loss).into_iter().fold(0.0, f64::max);
        assert!(most < 1e-10, "{most}");
    }
}

#[test]
fn skeletons_that_cannot_be_are_refused() {
    let rest = vec![Vec3::Y; 24];
    let told = |parents: Vec<usize>, rest: &[Vec3]| {
        let skeleton = RotationSkeleton::new(parents, rest);
        skeleton.expect_err("impossible").to_string()
    };
    assert!(told(PARENTS[..23].to_vec(), &rest).contains("24 and 23 parents"));
    assert!(told(PARENTS[..11].to_vec(), &rest[..11]).contains("12 or more"));
    let mut parents = PARENTS.to_vec();
    parents[7] = 7;
    assert!(told(parents, &rest).contains("found 7 of joint 7"));
    let mut broken = rest;
    broken[3].x = f32::NAN;
    assert!(told(PARENTS.to_vec(), &broken).contains("of joint 3"));
}

/// Two motions of two actions.
#[derive(Debug)]
struct Actions;

impl MotionSource for Actions {
    fn columns(&self) -> usize {
        COLUMNS
    }

    fn batch(&self, size: usize, _: u64, _: u64) -> Result<MotionBatch, Error> {
        assert_eq!(size, 2);
        Ok(MotionBatch {
            frames: FRAMES,
            features: motions(3),
            lengths: LENGTHS.to_vec(),
            condition: BatchCondition::Actions(vec![0, 2]),
        })
    }
}

#[test]
fn a_model_of_actions_is_trained_by_all_of_them() {
    let published = MdmTraining {
        batch: 2,
        diffusion_steps: 10,
        unconditioned: 0.0,
        velocity_weight: 1.0,
        joint_weight: 1.0,
        foot_contact_weight: 1.0,
        ..MdmTraining::default()
    };
    let config = MdmConfig {
        columns: COLUMNS,
        width: 8,
        layers: 1,
        heads: 2,
        feed_forward: 8,
        condition: ConditionKind::Action { count: 3 },
        dropout: 0.0,
        ..MdmConfig::default()
    };
    let network = Mdm::new(&config, 1, &Device::flex().autodiff()).expect("possible");
    let task = MdmTask::of_rotations(Actions, skeleton(), published.clone()).expect("it fits");
    let loss = task.loss(&network, 1, 1).expect("numbers");
    let names: Vec<&str> = loss.parts.iter().map(|(name, _)| *name).collect();
    let expected = [
        "squared_error",
        "velocity_error",
        "joint_error",
        "foot_contact_error",
    ];
    assert_eq!(names, expected);
    let sum: f64 = loss
        .parts
        .iter()
        .map(|(_, part)| numbers(part.clone())[0])
        .sum();
    let total = numbers(loss.total)[0];
    assert!(
        total > 0.0 && (total - sum).abs() < 1e-5 * total,
        "{total}, {sum}"
    );

    // Losses of features are not for rotations, nor the other way round.
    for (setting, training) in [
        (
            "ground_weight",
            MdmTraining {
                ground_weight: 1.0,
                ..published.clone()
            },
        ),
        (
            "root_weight",
            MdmTraining {
                root_weight: 2.0,
                ..published.clone()
            },
        ),
    ] {
        let told = MdmTask::of_rotations(Actions, skeleton(), training).expect_err(setting);
        assert!(told.to_string().contains(setting), "{told}");
    }
}
