//! The self-intersection loss of 192 spheres in the open body, forward and backward, on real motion.

#[path = "../tests/loss/real.rs"]
mod real;

use std::sync::LazyLock;

use divan::{Bencher, counter::ItemsCount};
use physique_proxy::{
    Backend, Pairs, PoseMatrices, SelfIntersection, SelfIntersectionOptions, SphereBody,
};

/// Body, pairs, and real poses.
static CASE: LazyLock<(SphereBody, Pairs, Vec<PoseMatrices>)> = LazyLock::new(|| {
    let (body, pairs) = real::body_and_pairs();
    (body, pairs, real::poses())
});

fn main() {
    LazyLock::force(&CASE);
    divan::main();
}

#[divan::bench(args = [64, 1024, 12_544])]
fn gradient(bencher: Bencher<'_, '_>, frames: usize) {
    run(bencher, frames, Backend::best());
}

#[divan::bench(args = Backend::available().collect::<Vec<_>>())]
fn backends_1024(bencher: Bencher<'_, '_>, backend: Backend) {
    run(bencher, 1024, backend);
}

fn run(bencher: Bencher<'_, '_>, frames: usize, backend: Backend) {
    let (body, pairs, clips) = &*CASE;
    let poses: Vec<_> = clips.iter().copied().cycle().take(frames).collect();
    let options = SelfIntersectionOptions {
        backend: Some(backend),
        ..Default::default()
    };
    let loss = SelfIntersection::with_options(body, pairs, &options).expect("sound");
    let weights = vec![1.0 / frames as f32; frames];
    let mut losses = vec![0.0; frames];
    let mut by_poses = vec![[[0.0; 9]; 22]; frames];
    bencher.counter(ItemsCount::new(frames)).bench_local(|| {
        loss.gradient(&poses, &weights, &mut losses, &mut by_poses)
            .expect("finite");
    });
}
