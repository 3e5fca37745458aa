//! Scoring real motion at 1 cm on the open body, all threads.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use physique::body::{Body, Sex, open_body};
use physique::load::load_recording;
use physique::motion::{FrameRate, Motion, embedded};
use physique::{Protocol, ScoreOptions, Scorer};

/// An hour at 30 frames a second.
const HOUR: usize = 108_000;

fn main() {
    divan::main();
}

fn scorer(protocol: Protocol) -> Scorer {
    let body = Body::mean(open_body().unwrap(), Sex::Neutral).unwrap();
    let options = ScoreOptions {
        protocol,
        ..ScoreOptions::default()
    };
    Scorer::new(body, options).unwrap()
}

/// The embedded clips one after the other, again and again, for a number of frames.
fn motion(scorer: &Scorer, frames: usize) -> Motion {
    let (mut root_translation, mut rotations) = (Vec::new(), Vec::new());
    for clip in embedded::clips().iter().cycle() {
        let loaded = load_recording(clip.load().unwrap(), scorer.body()).unwrap();
        root_translation.extend_from_slice(loaded.motion.root_translation());
        rotations.extend_from_slice(loaded.motion.rotations());
        if root_translation.len() >= frames {
            break;
        }
    }
    root_translation.truncate(frames);
    rotations.truncate(frames * physique::body::Joint::COUNT);
    Motion::new(
        FrameRate::new(30.0).unwrap(),
        None,
        root_translation,
        rotations,
    )
    .unwrap()
}

fn score(bencher: Bencher<'_, '_>, protocol: Protocol, frames: usize) {
    let scorer = scorer(protocol);
    let motion = motion(&scorer, frames);
    bencher
        .counter(ItemsCount::new(frames))
        .bench_local(|| scorer.score(black_box(&motion)).unwrap());
}

#[divan::bench(sample_count = 20)]
fn native_20_seconds(bencher: Bencher<'_, '_>) {
    score(bencher, Protocol::Native, 600);
}

#[divan::bench(sample_count = 20)]
fn sia_20_seconds(bencher: Bencher<'_, '_>) {
    score(bencher, Protocol::Sia, 600);
}

#[divan::bench(sample_count = 1, sample_size = 1)]
fn native_hour(bencher: Bencher<'_, '_>) {
    score(bencher, Protocol::Native, HOUR);
}
