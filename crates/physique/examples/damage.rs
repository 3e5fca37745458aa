//! What every measure makes of damaged motions, in medians over files:
//! `cargo run --release --example damage -- walk.bvh ...` prints a table in Markdown.
//!
//! The damages do one thing each: the soles sink, rise or slide, the body is smaller than the
//! motion's, time runs faster, joints tremble. A good measure sees its own and hardly any other.

use std::path::Path;

use glam::{Quat, Vec3};
use physique::body::{Attributes, Body, Joint, Sex, open_body};
use physique::load::{LoadOptions, load};
use physique::motion::{FrameRate, Motion};
use physique::physics::{Physics, PhysicsOptions};

use support::{MEASURES, measured, median};

mod support;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let body = Body::mean(open_body()?, Sex::Neutral)?;
    let smaller = Attributes {
        stature: Some(0.9 * body.stature()),
        ..Attributes::default()
    };
    let smaller = Body::from_attributes(open_body()?, &smaller)?;
    let (physics, on_smaller) = (Physics::new(&body)?, Physics::new(&smaller)?);
    let legs = body.rest_joint(Joint::Pelvis) - smaller.rest_joint(Joint::Pelvis);

    let names = [
        "as it is",
        "sunk by 3 cm",
        "lifted by 3 cm",
        "slid by 10 cm/s",
        "body shrunk to 0.9",
        "1.5 times as fast",
        "trembling by 1°",
    ];
    let mut values = vec![[const { Vec::new() }; MEASURES.len()]; names.len()];
    for file in std::env::args().skip(1) {
        let motion = load(Path::new(&file), &body, &LoadOptions::default())?.motion;
        let damaged = [
            (&physics, motion.clone()),
            (&physics, moved(&motion, |_| Vec3::NEG_Y * 0.03)?),
            (&physics, moved(&motion, |_| Vec3::Y * 0.03)?),
            (&physics, moved(&motion, |seconds| Vec3::X * 0.1 * seconds)?),
            (&on_smaller, moved(&motion, |_| legs)?),
            (&physics, faster(&motion, 1.5)?),
            (&physics, trembling(&motion, 1.0_f32.to_radians())?),
        ];
        for ((physics, motion), row) in damaged.iter().zip(&mut values) {
            let found = physics.measure(motion, &PhysicsOptions::default())?;
            for (column, value) in row.iter_mut().zip(measured(&found)) {
                column.extend(value);
            }
        }
    }
    println!("| | {} |", MEASURES.join(" | "));
    println!("|---{}|", "|--:".repeat(MEASURES.len()));
    for (name, row) in names.iter().zip(values) {
        let cells = row.map(|column| format!("{:.1}", median(column)));
        println!("| {name} | {} |", cells.join(" | "));
    }
    Ok(())
}

/// The whole body somewhere else, by the time in seconds.
fn moved(motion: &Motion, way: impl Fn(f32) -> Vec3) -> Result<Motion, Failure> {
    let frame_s = motion.frame_rate().frame_seconds() as f32;
    let roots = motion.root_translation().iter().enumerate();
    let roots = roots.map(|(frame, root)| *root + way(frame as f32 * frame_s));
    let rotations = motion.rotations().to_vec();
    Ok(Motion::new(
        motion.frame_rate(),
        None,
        roots.collect(),
        rotations,
    )?)
}

/// The same frames in less time.
fn faster(motion: &Motion, times: f64) -> Result<Motion, Failure> {
    let rate = FrameRate::new(motion.frame_rate().per_second() * times)?;
    let roots = motion.root_translation().to_vec();
    Ok(Motion::new(rate, None, roots, motion.rotations().to_vec())?)
}

/// Every joint but the pelvis turned by a small angle about a random axis in every frame.
fn trembling(motion: &Motion, angle: f32) -> Result<Motion, Failure> {
    let mut state = 1_u64;
    let mut random = || {
        // Knuth's linear congruential generator; its upper bits are good enough to tremble.
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1_u64 << 23) as f32 - 1.0
    };
    let rotations = motion
        .rotations()
        .iter()
        .enumerate()
        .map(|(index, rotation)| {
            let axis = Vec3::new(random(), random(), random()).normalize_or(Vec3::X);
            match index % Joint::COUNT {
                0 => *rotation,
                _ => *rotation * Quat::from_axis_angle(axis, angle),
            }
        });
    let rotations = rotations.collect();
    let roots = motion.root_translation().to_vec();
    Ok(Motion::new(motion.frame_rate(), None, roots, rotations)?)
}
