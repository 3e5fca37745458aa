//! Times the steps of a fit by the paper's recipe, wall and processor time, on Linux:
//! 64 bodies x 16,384 points x 192 spheres forward, back, and Adam.
//!
//! ```sh
//! RAYON_NUM_THREADS=2 cargo run --release --example fit_speed
//! ```

#[path = "support/clock.rs"]
mod clock;

use std::sync::Mutex;
use std::time::Instant;

use physique_body::open_body;
use physique_proxy::fit::{FitObserver, FitOptions, Stage, fit_regressors};

use clock::{median, processor_milliseconds};

/// Steps of the whole recipe: 13 batches of 800 bodies, 2,800 times, the last of a pass half full.
const RECIPE_STEPS: f64 = 12.5 * 2_800.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let threads = rayon::current_num_threads();
    for (spheres, step_points) in [(128, 16_384), (192, 4_096), (192, 16_384), (256, 16_384)] {
        let folder = tempfile::tempdir()?;
        let options = FitOptions {
            spheres,
            step_points,
            sphere_bodies: 64,
            // Enough for a few blocks: the store's size costs no time.
            ball_points: 8_000,
            surface_points: 48_000,
            sphere_epochs: 60,
            joint_bodies: 64,
            joint_epochs: 1,
            ..FitOptions::default()
        };
        let watch = Watch::default();
        fit_regressors(&open_body()?, &options, folder.path(), &watch)?;
        let mut steps = watch.steps.into_inner()?;
        let (mut wall, mut cpu): (Vec<f64>, Vec<f64>) = steps.drain(..).unzip();
        let (wall, cpu) = (median(&mut wall), median(&mut cpu));
        println!(
            "{spheres} spheres, 64 bodies x {step_points} points, {threads} threads: \
             wall {wall:.1} ms, CPU {cpu:.1} ms a step; {:.0} CPU minutes for the paper's schedule",
            cpu * RECIPE_STEPS / 60_000.0
        );
    }
    Ok(())
}

/// Times from step to step: with one batch, a pass is a step.
#[derive(Default)]
struct Watch {
    last: Mutex<Option<(Instant, f64)>>,
    steps: Mutex<Vec<(f64, f64)>>,
}

impl FitObserver for Watch {
    fn epoch(&self, stage: Stage, _done: usize, _loss: f64) {
        let (Stage::Spheres, Ok(cpu)) = (stage, processor_milliseconds()) else {
            return;
        };
        let now = (Instant::now(), cpu);
        let (Ok(mut last), Ok(mut steps)) = (self.last.lock(), self.steps.lock()) else {
            return;
        };
        if let Some(last) = last.replace(now) {
            let wall = 1e3 * now.0.duration_since(last.0).as_secs_f64();
            steps.push((wall, now.1 - last.1));
        }
    }
}
