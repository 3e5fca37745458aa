//! Sphere loss against mesh loss: time and memory of value and gradient for 1 to 16 and all 196 frames of
//! each of 64 motions, as the self-intersection paper's figure 3.
//!
//! ```sh
//! RAYON_NUM_THREADS=2 cargo run --release --example sphere_against_mesh -- [figure.svg]
//! ```
//!
//! Times are those of the processor (Linux), the least of some runs; memory is what is allocated at most
//! beyond inputs and outputs, the prepared loss included.

#[path = "support/chart.rs"]
mod chart;
#[path = "../../physique-proxy/examples/support/clock.rs"]
mod clock;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use physique::body::{Body, Sex, open_body};
use physique::motion::embedded;
use physique::proxy::{
    MeshLoss, MeshLossOptions, PoseMatrices, SelfIntersection, open_proxy, pose_matrices,
};

use chart::{Axis, Picture};

type Failure = Box<dyn std::error::Error>;

const MOTIONS: usize = 64;
/// Frames of each motion that the loss looks at.
const FRAMES: [usize; 6] = [1, 2, 4, 8, 16, 196];

/// Counts what is allocated.
struct Counting;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: everything is handed to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let live = LIVE.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        MOST.fetch_max(live, Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// One loss on one number of frames.
#[derive(Clone, Copy)]
struct Cost {
    milliseconds: f64,
    mebibytes: f64,
}

fn main() -> Result<(), Failure> {
    let body = Body::mean(open_body()?, Sex::Neutral)?;
    let proxy = open_proxy()?;
    let (spheres, pairs) = (proxy.of_body(&body)?, proxy.pairs()?);
    let mut clips = Vec::new();
    for clip in embedded::clips() {
        let motion = clip.load()?.motion;
        clips.extend((0..motion.frame_count()).map(|f| pose_matrices(motion.frame_rotations(f))));
    }
    println!("{} threads", rayon::current_num_threads());
    println!(
        "| frames a motion | frames | spheres, ms | mesh, ms | time saved | spheres, MB | mesh, MB | memory saved |"
    );
    println!("|--:|--:|--:|--:|--:|--:|--:|--:|");
    let mut rows = Vec::new();
    for frames in FRAMES {
        let count = MOTIONS * frames;
        // Frames from all over the clips, whatever their number.
        let poses: Vec<PoseMatrices> = (0..count)
            .map(|frame| clips[frame * 997 % clips.len()])
            .collect();
        let sphere = cost(
            &poses,
            || Ok(SelfIntersection::new(&spheres, &pairs)?),
            |loss, poses, weights, losses, by| Ok(loss.gradient(poses, weights, losses, by)?),
        )?;
        let mesh = cost(
            &poses,
            || Ok(MeshLoss::new(&body, &MeshLossOptions::default())?),
            |loss, poses, weights, losses, by| Ok(loss.gradient(poses, weights, losses, by)?),
        )?;
        let saved = |of: fn(Cost) -> f64| 100.0 * (1.0 - of(sphere) / of(mesh));
        println!(
            "| {frames} | {count} | {:.3} | {:.1} | {:.2} % | {:.2} | {:.2} | {:.0} % |",
            sphere.milliseconds,
            mesh.milliseconds,
            saved(|cost| cost.milliseconds),
            sphere.mebibytes,
            mesh.mebibytes,
            saved(|cost| cost.mebibytes),
        );
        rows.push((frames as f64, sphere, mesh));
    }
    if let Some(path) = std::env::args().nth(1) {
        std::fs::write(path, figure(&rows))?;
    }
    Ok(())
}

/// Prepares a loss, and evaluates it with its gradient.
fn cost<L>(
    poses: &[PoseMatrices],
    new: impl Fn() -> Result<L, Failure>,
    gradient: impl Fn(
        &L,
        &[PoseMatrices],
        &[f32],
        &mut [f32],
        &mut [PoseMatrices],
    ) -> Result<(), Failure>,
) -> Result<Cost, Failure> {
    let weights = vec![1.0 / poses.len() as f32; poses.len()];
    let (mut losses, mut by_poses) = (vec![0.0; poses.len()], vec![[[0.0; 9]; 22]; poses.len()]);
    let before = LIVE.load(Ordering::Relaxed);
    MOST.store(before, Ordering::Relaxed);
    let loss = new()?;
    gradient(&loss, poses, &weights, &mut losses, &mut by_poses)?;
    let most = MOST.load(Ordering::Relaxed);

    let mut best = f64::INFINITY;
    let (mut runs, mut spent) = (0, 0.0);
    while runs < 3 || (runs < 200 && spent < 1_000.0) {
        // Small ones many times, so that the clock is fine enough.
        let calls = (2_048 / poses.len()).max(1);
        let start = clock::processor_milliseconds()?;
        for _ in 0..calls {
            gradient(&loss, poses, &weights, &mut losses, &mut by_poses)?;
        }
        let took = clock::processor_milliseconds()? - start;
        best = best.min(took / calls as f64);
        spent += took;
        runs += 1;
    }
    Ok(Cost {
        milliseconds: best,
        mebibytes: (most - before) as f64 / f64::from(1 << 20),
    })
}

fn figure(rows: &[(f64, Cost, Cost)]) -> String {
    let frames = || Axis {
        title: "frames of each of 64 motions",
        ticks: &[
            (1.0, "1"),
            (2.0, "2"),
            (4.0, "4"),
            (8.0, "8"),
            (16.0, "16"),
            (196.0, "196"),
        ],
        range: [0.8, 250.0],
        scale: f64::ln,
    };
    let mut picture = Picture::new();
    let time = Axis {
        title: "processor time, ms",
        ticks: &[
            (0.01, "0.01"),
            (0.1, "0.1"),
            (1.0, "1"),
            (10.0, "10"),
            (100.0, "100"),
            (1e3, "1,000"),
            (1e4, "10,000"),
            (1e5, "100,000"),
        ],
        range: [0.01, 1e5],
        scale: f64::ln,
    };
    let memory = Axis {
        title: "memory beyond inputs and outputs, MB",
        ticks: &[(0.1, "0.1"), (1.0, "1"), (10.0, "10"), (100.0, "100")],
        range: [0.1, 100.0],
        scale: f64::ln,
    };
    let lines = |of: fn(Cost) -> f64| -> [Vec<(f64, f64)>; 2] {
        [
            rows.iter().map(|row| (row.0, of(row.1))).collect(),
            rows.iter().map(|row| (row.0, of(row.2))).collect(),
        ]
    };
    for (title, axis, lines) in [
        ("Time", time, lines(|cost| cost.milliseconds)),
        ("Memory", memory, lines(|cost| cost.mebibytes)),
    ] {
        let mut chart = picture.chart(title, frames(), axis);
        chart.line("#1f5fa8", "sphere loss", &lines[0]);
        chart.line("#b3392f", "mesh loss", &lines[1]);
    }
    picture.finish()
}
