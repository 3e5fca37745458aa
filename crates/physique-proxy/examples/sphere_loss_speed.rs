//! Times the self-intersection loss and its gradient, wall and processor time, on Linux; the other
//! half of `benches/peers/sphere_loss.py`.
//!
//! ```sh
//! RAYON_NUM_THREADS=2 cargo run --release --example sphere_loss_speed -- 64 1024 12544
//! ```

#[path = "support/clock.rs"]
mod clock;
#[path = "../tests/loss/real.rs"]
mod real;

use std::fs;
use std::time::Instant;

use physique_proxy::{Backend, SelfIntersection, SelfIntersectionOptions};

use clock::{median, processor_milliseconds};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let sizes: Vec<usize> = std::env::args()
        .skip(1)
        .map(|size| size.parse())
        .collect::<Result<_, _>>()?;
    let (body, pairs) = real::body_and_pairs();
    let clips = real::poses();
    let threads = rayon::current_num_threads();
    println!(
        "{} spheres, {} pairs, real motion, {threads} threads",
        body.sphere_count(),
        pairs.len()
    );
    for frames in sizes {
        let poses: Vec<_> = clips.iter().copied().cycle().take(frames).collect();
        let weights = vec![1.0 / frames as f32; frames];
        let (mut losses, mut by_poses) = (vec![0.0; frames], vec![[[0.0; 9]; 22]; frames]);
        for backend in Backend::available() {
            let options = SelfIntersectionOptions {
                backend: Some(backend),
                ..Default::default()
            };
            let before = resident()?;
            let loss = SelfIntersection::with_options(&body, &pairs, &options)?;
            let mut run = || loss.gradient(&poses, &weights, &mut losses, &mut by_poses);
            (0..3).try_for_each(|_| run())?;
            // Many calls a sample, so that clocks are fine enough.
            let calls = (40_000 / frames).max(1);
            let (mut wall, mut cpu) = (Vec::new(), Vec::new());
            for _ in 0..25 {
                let start = (Instant::now(), processor_milliseconds()?);
                (0..calls).try_for_each(|_| run())?;
                wall.push(1e3 * start.0.elapsed().as_secs_f64() / calls as f64);
                cpu.push((processor_milliseconds()? - start.1) / calls as f64);
            }
            let grown = resident()?.saturating_sub(before);
            println!(
                "frames {frames}, {backend}: wall {:.4} ms, CPU {:.4} ms, {grown} kB beyond inputs and outputs",
                median(&mut wall),
                median(&mut cpu),
            );
        }
    }
    Ok(())
}

/// Memory of this process, in kB.
fn resident() -> Result<u64, Box<dyn std::error::Error>> {
    let status = fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    Ok(line
        .unwrap_or_default()
        .trim()
        .trim_end_matches(" kB")
        .trim()
        .parse()?)
}
