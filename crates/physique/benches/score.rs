//! Scoring real motion at 1 cm on the open body, all threads.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use physique::body::{Body, Sex, open_body};
use physique::load::load_recording;
use physique::motion::{FrameRate, Motion, embedded};
use physique::{Group, Protocol, ScoreOptions, Scorer};

/// An hour at 30 frames a second.
const HOUR: usize = 108_000;

fn main() {
    divan::main();
}

fn by(protocol: Protocol) -> ScoreOptions {
    ScoreOptions {
        protocols: vec![protocol],
        ..ScoreOptions::default()
    }
}

/// Physique's own measures but self-intersection.
fn without_self() -> ScoreOptions {
    ScoreOptions {
        groups: Group::ALL[1..].to_vec(),
        ..ScoreOptions::default()
    }
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

fn score(bencher: Bencher<'_, '_>, options: ScoreOptions, frames: usize) {
    let body = Body::mean(open_body().unwrap(), Sex::Neutral).unwrap();
    let scorer = Scorer::new(body, options).unwrap();
    let motion = motion(&scorer, frames);
    bencher
        .counter(ItemsCount::new(frames))
        .bench_local(|| scorer.score(black_box(&motion)).unwrap());
}

#[divan::bench(sample_count = 20)]
fn native_20_seconds(bencher: Bencher<'_, '_>) {
    score(bencher, by(Protocol::Native), 600);
}

#[divan::bench(sample_count = 20)]
fn sia_20_seconds(bencher: Bencher<'_, '_>) {
    score(bencher, by(Protocol::Sia), 600);
}

#[divan::bench(sample_count = 1, sample_size = 1)]
fn native_hour(bencher: Bencher<'_, '_>) {
    score(bencher, by(Protocol::Native), HOUR);
}

#[divan::bench(sample_count = 1, sample_size = 1)]
fn native_hour_without_self_intersection(bencher: Bencher<'_, '_>) {
    score(bencher, without_self(), HOUR);
}

/// The ten published protocols, which resample to 20, 30 and 60 fps.
#[divan::bench(sample_count = 1, sample_size = 1)]
fn published_protocols_hour(bencher: Bencher<'_, '_>) {
    let options = ScoreOptions {
        protocols: Protocol::ALL[2..].to_vec(),
        ..ScoreOptions::default()
    };
    score(bencher, options, HOUR);
}
