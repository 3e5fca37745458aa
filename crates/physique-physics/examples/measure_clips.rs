//! Physics of motion files, or of the embedded clips, on the mean body:
//! `cargo run --release -p physique-physics --example measure_clips -- walk.bvh ...`.
//!
//! `CUTOFF` (Hz), `HEIGHT` (m) and `SPEED` (m/s) in the environment change the options, `FPS`
//! resamples the motions first.

use std::time::Instant;

use physique_body::{Body, Sex, open_body};
use physique_motion::inverse_kinematics::{IkOptions, solve};
use physique_motion::mapping::{BodyRest, MappingOptions, map_to_body};
use physique_motion::{FrameRate, Motion, ReadOptions, SourceMotion, embedded, read_motion};
use physique_physics::protocol::resampled;
use physique_physics::{GroundChoice, Physics, PhysicsOptions};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let body = Body::mean(open_body()?, Sex::Neutral)?;
    let physics = Physics::new(&body)?;
    println!(
        "{:28}{:>6}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}",
        "clip",
        "s",
        "est cm",
        "pen cm",
        "flt cm",
        "uns %",
        "fly %",
        "slide",
        "in %",
        "out cm",
        "MoS cm",
        "acc",
        "jerk",
        "jit mm"
    );
    let files: Vec<_> = std::env::args().skip(1).collect();
    for clip in embedded::clips().iter().filter(|_| files.is_empty()) {
        print(&physics, clip.name, &clip.load()?.motion)?;
    }
    for file in &files {
        let source = read_motion(file, &ReadOptions::default())?;
        let name = file.rsplit('/').next().unwrap_or(file);
        let motion = match source {
            SourceMotion::Skeleton(clip) => {
                map_to_body(&clip, &BodyRest::from(&body), &MappingOptions::default())?.motion
            }
            SourceMotion::Body(recording) => recording.motion,
            SourceMotion::Positions(clip) => {
                let body = BodyRest::from(&body);
                solve(&clip.positions, &body, &IkOptions::default())?.motion
            }
        };
        print(&physics, name, &motion)?;
    }
    Ok(())
}

/// A number from the environment.
fn number(name: &str) -> Option<f64> {
    std::env::var(name).ok()?.parse().ok()
}

fn print(physics: &Physics, name: &str, motion: &Motion) -> Result<(), Failure> {
    let motion = &match number("FPS") {
        Some(fps) => resampled(motion, FrameRate::new(fps)?)?,
        None => motion.clone(),
    };
    let options = PhysicsOptions {
        balance_cutoff_hz: number("CUTOFF").unwrap_or(3.0),
        contact_height: number("HEIGHT").unwrap_or(0.03),
        contact_speed: number("SPEED").unwrap_or(0.4),
        ..PhysicsOptions::default()
    };
    let estimated = PhysicsOptions {
        ground: GroundChoice::Estimated,
        ..options
    };
    let start = Instant::now();
    let found = physics.measure(motion, &options)?;
    let took = start.elapsed().as_secs_f64() / motion.frame_count() as f64;
    print!(
        "{:28}{:6.1}{:7.1}{:7.2}{:7.2}{:7.1}{:7.1}{:7.3}",
        name.chars().take(27).collect::<String>(),
        motion.seconds(),
        100.0 * physics.ground_height(motion, &estimated),
        100.0 * found.ground.penetration_mean_m,
        100.0 * found.ground.floating_mean_m,
        found.ground.unsupported_frames_percent,
        found.ground.flight_frames_percent,
        found.feet.slide_mean_m_s,
    );
    match found.balance.measured {
        Some(balance) => print!(
            "{:7.1}{:7.2}{:7.2}",
            balance.stable_percent,
            100.0 * balance.outside_mean_m,
            100.0 * balance.margin_mean_m,
        ),
        None => print!("{:>7}{:>7}{:>7}", "-", "-", "-"),
    }
    if let Some(smooth) = found.smoothness {
        print!(
            "{:7.2}{:7.1}{:7.2}",
            smooth.acceleration_mean_m_s2,
            smooth.jerk_mean_m_s3,
            1000.0 * smooth.jitter_mean_m
        );
    }
    println!("  {:.0} us/frame", 1e6 * took);
    Ok(())
}
