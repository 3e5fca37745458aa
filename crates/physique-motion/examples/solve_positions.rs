//! How well rotations are found from positions alone, on clips whose rotations are known:
//! `cargo run --release -p physique-motion --example solve_positions -- BVH...`.
//!
//! Each file is mapped to the open body and thinned to about 20 frames a second, the rate of
//! HumanML3D; its joints' positions alone are solved for again, and rotations and positions are
//! compared. A row a joint: mean, 95th percentile and largest angle between the world orientations,
//! in degrees, and flips: frames in which the joint turns by 45 degrees more than it really does.
//! Then positions in millimetres and frames a second. `LAYER=1` asks the papers' layer instead.

use std::{error::Error, time::Instant};

use glam::{Quat, Vec3};
use physique_body::{Body, Joint, open_body};
use physique_motion::{
    FrameRate, Motion, bvh,
    features::{FeatureSkeleton, JointPositions},
    inverse_kinematics::{IkOptions, solve, solve_by_paper_layer},
    mapping::{BodyRest, MappingOptions, map_to_body},
};

fn main() -> Result<(), Box<dyn Error>> {
    let body = BodyRest::from(&Body::new(open_body()?, &[])?);
    let by_layer = std::env::var_os("LAYER").is_some();
    let options = IkOptions {
        soles_on_ground: false,
        ..IkOptions::for_joints_of(&body)
    };
    let mut angles: [Vec<f32>; Joint::COUNT] = Default::default();
    let mut flips = [0_usize; Joint::COUNT];
    let mut distances = Vec::new();
    let (mut clips, mut frames, mut seconds) = (0, 0, 0.0);
    for path in std::env::args().skip(1) {
        let clip = bvh::read(&path, &bvh::BvhOptions::default())?;
        let truth = thinned(&map_to_body(&clip, &body, &MappingOptions::default())?.motion)?;
        let posed: Vec<_> = (0..truth.frame_count())
            .map(|frame| world(&truth, &body, frame))
            .collect();
        let joints = posed.iter().flat_map(|(_, positions)| *positions).collect();
        let joints = JointPositions::new(truth.frame_rate(), FeatureSkeleton::HumanMl3d, joints)?;
        let start = Instant::now();
        let solution = if by_layer {
            solve_by_paper_layer(&joints, &body, false)?
        } else {
            solve(&joints, &body, &options)?
        };
        seconds += start.elapsed().as_secs_f64();
        clips += 1;
        frames += truth.frame_count();
        let mut worst = (0.0, Joint::Pelvis, 0);
        let mut before: Option<[Quat; 22]> = None;
        for (frame, (true_world, true_positions)) in posed.iter().enumerate() {
            let (our_world, our_positions) = world(&solution.motion, &body, frame);
            for joint in Joint::ALL {
                let index = joint.index();
                let angle = true_world[index]
                    .angle_between(our_world[index])
                    .to_degrees();
                angles[index].push(angle);
                if angle > worst.0 {
                    worst = (angle, joint, frame);
                }
                distances.push(1000.0 * true_positions[index].distance(our_positions[index]));
                if let Some(before) = &before {
                    let ours = before[index].angle_between(our_world[index]);
                    let really = posed[frame - 1].0[index].angle_between(true_world[index]);
                    flips[index] += usize::from((ours - really).to_degrees() > 45.0);
                }
            }
            before = Some(our_world);
        }
        if std::env::var_os("WORST").is_some() {
            println!("{path}: {:.1} at {} {}", worst.0, worst.1, worst.2);
        }
    }
    for joint in Joint::ALL {
        let index = joint.index();
        let angles = summary(&mut angles[index]);
        println!("{:15} {angles}  flips {}", joint.name(), flips[index]);
    }
    println!("positions, mm   {}", summary(&mut distances));
    println!(
        "{clips} clips, {frames} frames, {:.0} frames a second",
        frames as f64 / seconds
    );
    Ok(())
}

/// The motion at about 20 frames a second.
fn thinned(motion: &Motion) -> Result<Motion, physique_motion::Error> {
    let rate = motion.frame_rate().per_second();
    let step = ((rate / 20.0).round() as usize).max(1);
    let frames = (0..motion.frame_count()).step_by(step);
    Motion::new(
        FrameRate::new(rate / step as f64)?,
        None,
        frames
            .clone()
            .map(|frame| motion.root_translation()[frame])
            .collect(),
        frames
            .flat_map(|frame| motion.frame_rotations(frame).to_vec())
            .collect(),
    )
}

fn summary(values: &mut [f32]) -> String {
    values.sort_by(f32::total_cmp);
    let Some(&largest) = values.last() else {
        return "nothing".into();
    };
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    let percentile = values[(values.len() - 1) * 95 / 100];
    format!("mean {mean:7.3}  p95 {percentile:7.3}  max {largest:7.3}")
}

/// World orientations and positions of a frame.
fn world(motion: &Motion, body: &BodyRest, frame: usize) -> ([Quat; 22], [Vec3; 22]) {
    let local = motion.frame_rotations(frame);
    let mut world = [local[0]; 22];
    let mut positions = [body.joint(Joint::Pelvis) + motion.root_translation()[frame]; 22];
    for joint in Joint::ALL {
        if let Some(parent) = joint.parent() {
            let (joint_index, parent) = (joint.index(), parent.index());
            world[joint_index] = world[parent] * local[joint_index];
            positions[joint_index] = positions[parent] + world[parent] * body.offset(joint);
        }
    }
    (world, positions)
}
