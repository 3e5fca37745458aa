//! Posing the open body: microseconds a frame and bytes moved.
//!
//! `benches/peers/skinning.py` at the top of the repository times the usual dense formulation in
//! PyTorch on the same machine.

use divan::counter::{BytesCount, ItemsCount};
use divan::{Bencher, black_box};
use glam::{Quat, Vec3};
use physique_body::{Body, Joint, Pose, open_body};
use rayon::prelude::*;

const FRAMES: usize = 64;

fn main() {
    divan::main();
}

fn body() -> Body {
    Body::new(open_body().unwrap(), &[0.5, -0.5, 1.0]).unwrap()
}

fn rotations(frame: usize) -> Vec<Quat> {
    (0..Joint::COUNT)
        .map(|joint| Quat::from_rotation_x(0.3 * (frame as f32 + joint as f32).sin()))
        .collect()
}

/// Rest positions and weights are read, positions written, once a frame.
fn bytes_a_frame(body: &Body) -> usize {
    let weights = body.model().blend_weights();
    let row = weights.influences() * (size_of::<u8>() + size_of::<f32>());
    body.rest_vertices().len() * (2 * size_of::<Vec3>() + row)
}

#[divan::bench]
fn one_frame_one_thread(bencher: Bencher<'_, '_>) {
    let body = body();
    let rotations = rotations(1);
    let mut posed = body.posed();
    bencher
        .counter(ItemsCount::new(1_usize))
        .counter(BytesCount::new(bytes_a_frame(&body)))
        .bench_local(|| {
            let pose = Pose {
                root_translation: Vec3::Y,
                rotations: black_box(&rotations),
            };
            body.pose(&pose, &mut posed).unwrap();
            black_box(posed.vertices()[0])
        });
}

#[divan::bench]
fn batch_of_64_frames_all_threads(bencher: Bencher<'_, '_>) {
    let body = body();
    let frames: Vec<_> = (0..FRAMES).map(rotations).collect();
    let mut posed: Vec<_> = (0..FRAMES).map(|_| body.posed()).collect();
    bencher
        .counter(ItemsCount::new(FRAMES))
        .counter(BytesCount::new(FRAMES * bytes_a_frame(&body)))
        .bench_local(|| {
            posed
                .par_iter_mut()
                .zip(&frames)
                .for_each(|(posed, rotations)| {
                    let pose = Pose {
                        root_translation: Vec3::Y,
                        rotations: black_box(rotations),
                    };
                    body.pose(&pose, posed).unwrap();
                });
            black_box(posed[0].vertices()[0])
        });
}
