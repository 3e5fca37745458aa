//! Measures inverse kinematics on motions whose rotations are known:
//! `cargo run --release -p physique-motion --example solve_positions -- BVH...`.
//!
//! Each file is mapped to the open body, its joints' positions alone are solved for again, and
//! rotations and positions are compared. A row a joint: mean, 95th percentile and largest angle
//! between the world orientations, in degrees; then positions in millimetres and frames a second.

use std::{error::Error, time::Instant};

use glam::{Quat, Vec3};
use physique_body::{Body, Joint, open_body};
use physique_motion::{
    Motion, bvh,
    features::{FeatureSkeleton, JointPositions},
    inverse_kinematics::{IkOptions, solve},
    mapping::{BodyRest, MappingOptions, map_to_body},
};

fn main() -> Result<(), Box<dyn Error>> {
    let body = BodyRest::from(&Body::new(open_body()?, &[])?);
    let options = IkOptions {
        soles_on_ground: false,
        ..IkOptions::for_joints_of(&body)
    };
    let mut angles: [Vec<f32>; Joint::COUNT] = Default::default();
    let mut distances = Vec::new();
    let (mut frames, mut seconds) = (0, 0.0);
    for path in std::env::args().skip(1) {
        let clip = bvh::read(&path, &bvh::BvhOptions::default())?;
        let truth = map_to_body(&clip, &body, &MappingOptions::default())?.motion;
        let posed = (0..truth.frame_count()).map(|frame| world(&truth, &body, frame));
        let joints = posed.flat_map(|(_, positions)| positions).collect();
        let joints = JointPositions::new(truth.frame_rate(), FeatureSkeleton::HumanMl3d, joints)?;
        let start = Instant::now();
        let solution = solve(&joints, &body, &options)?;
        seconds += start.elapsed().as_secs_f64();
        frames += truth.frame_count();
        for frame in 0..truth.frame_count() {
            let (true_world, true_positions) = world(&truth, &body, frame);
            let (our_world, our_positions) = world(&solution.motion, &body, frame);
            for joint in 0..Joint::COUNT {
                angles[joint].push(
                    true_world[joint]
                        .angle_between(our_world[joint])
                        .to_degrees(),
                );
                distances.push(1000.0 * true_positions[joint].distance(our_positions[joint]));
            }
        }
    }
    for joint in Joint::ALL {
        println!(
            "{:15} {}",
            joint.name(),
            summary(&mut angles[joint.index()])
        );
    }
    println!("positions, mm   {}", summary(&mut distances));
    println!(
        "{frames} frames, {:.0} frames a second",
        frames as f64 / seconds
    );
    Ok(())
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
