//! Breaks files at random, from a seed.

use std::time::{Duration, Instant};
use std::{env, panic};

/// SplitMix64 (Steele, Lea and Flood, 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut value = self.0;
        value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        value ^ (value >> 31)
    }

    pub(crate) fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }
}

/// Up to seven changes; `words` are worth more than chance to the format.
pub(crate) fn mutate(random: &mut Random, bytes: &mut Vec<u8>, other: &[u8], words: &[&[u8]]) {
    for _ in 0..=random.below(6) {
        if bytes.is_empty() {
            return;
        }
        // Mostly where the structure is, not within numbers.
        let reach = if random.below(2) == 0 {
            bytes.len().min(600)
        } else {
            bytes.len()
        };
        let at = random.below(reach);
        let word = words[random.below(words.len())];
        match random.below(9) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => {
                let end = (at + word.len()).min(bytes.len());
                bytes.splice(at..end, word.iter().copied());
            }
            2 => {
                bytes.splice(at..at, word.iter().copied());
            }
            3 => {
                let end = (at + 1 + random.below(16)).min(bytes.len());
                bytes.drain(at..end);
            }
            4 => {
                let value = [0, 1, 0x7f, 0x80, 0xff][random.below(5)];
                let end = (at + 1 + random.below(8)).min(bytes.len());
                bytes[at..end].fill(value);
            }
            5 => {
                let end = (at + 1 + random.below(64)).min(bytes.len());
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, copy);
            }
            6 if !other.is_empty() => {
                let from = random.below(other.len());
                let end = (from + 1 + random.below(64)).min(other.len());
                bytes.splice(at..at, other[from..end].iter().copied());
            }
            7 => replace_number(random, bytes, at),
            _ => bytes.truncate(at),
        }
    }
}

/// Puts an extreme number in the place of the next one written in digits.
fn replace_number(random: &mut Random, bytes: &mut Vec<u8>, at: usize) {
    const EXTREMES: [&[u8]; 14] = [
        b"0",
        b"-1",
        b"1",
        b"nan",
        b"inf",
        b"1e308",
        b"-1e308",
        b"1e-308",
        b"1e38",
        b"3e9",
        b"4294967296",
        b"9223372036854775807",
        b"18446744073709551616",
        b"1e999",
    ];
    let is_digit = |byte: &u8| byte.is_ascii_digit();
    let Some(start) = bytes[at..]
        .iter()
        .position(is_digit)
        .map(|start| at + start)
    else {
        return;
    };
    let rest = &bytes[start..];
    let length = rest
        .iter()
        .position(|byte| !(byte.is_ascii_digit() || *byte == b'.'));
    let end = start + length.unwrap_or(rest.len());
    let extreme = EXTREMES[random.below(EXTREMES.len())];
    bytes.splice(start..end, extreme.iter().copied());
}

/// Feeds broken copies of `files` to `read`, which tells whether it could read them:
/// `PHYSIQUE_FUZZ_SECONDS` long, else a few thousand times.
pub(crate) fn fuzz(
    what: &str,
    files: &[(String, Vec<u8>)],
    words: &[&[u8]],
    read: impl Fn(&str, Vec<u8>) -> bool + panic::RefUnwindSafe,
) {
    const USUAL_RUNS: u64 = 3_000;
    const LONGEST: Duration = Duration::from_secs(20);
    let number = |name: &str| env::var(name).ok().and_then(|text| text.parse().ok());
    let seconds = number("PHYSIQUE_FUZZ_SECONDS");
    let mut random = Random(number("PHYSIQUE_FUZZ_SEED").unwrap_or(1));
    let start = Instant::now();
    let (mut runs, mut readable, mut slowest) = (0_u64, 0_u64, Duration::ZERO);
    loop {
        let done = match seconds {
            Some(seconds) => start.elapsed() >= Duration::from_secs(seconds),
            None => runs >= USUAL_RUNS,
        };
        if done {
            break;
        }
        let before = random.0;
        let (name, bytes) = &files[random.below(files.len())];
        let (_, other) = &files[random.below(files.len())];
        let mut bytes = bytes.clone();
        mutate(&mut random, &mut bytes, other, words);
        let begun = Instant::now();
        let outcome = panic::catch_unwind(|| read(name, bytes));
        let time = begun.elapsed();
        slowest = slowest.max(time);
        assert!(
            time < LONGEST,
            "{name} takes {time:?}: PHYSIQUE_FUZZ_SEED={before}"
        );
        match outcome {
            Ok(read) => readable += u64::from(read),
            Err(_) => panic!("a mutation of {name} panics: PHYSIQUE_FUZZ_SEED={before}"),
        }
        runs += 1;
    }
    println!(
        "{what}: {runs} files in {:.0} s, {readable} of them readable, the slowest took {slowest:.1?}",
        start.elapsed().as_secs_f64()
    );
    assert!(
        readable > 0 && readable < runs,
        "mutations neither all break nor all miss"
    );
}
