//! Data and plans to learn from, small enough for tests.

use std::path::Path;

/// A network and a run that take a second.
pub const PLAN: &str = r#"
[network]
width = 16
layers = 1
heads = 2
feed_forward = 32
mask_frames = true
frames_per_token = 2
[training]
batch = 2
diffusion_steps = 10
[run]
steps = 4
save_every = 2
log_every = 1
average = 0.9
[windows]
longest_seconds = 2.0
"#;

/// The folder of the embedded clips.
pub const CLIPS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../physique-motion/assets");

/// A small CLIP with made-up weights, in the layout of Hugging Face.
pub const CLIP: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../physique-text/tests/fixtures/clip"
);

/// A recipe for the embedded clips: a share of them to test with, and words for more of them.
pub fn recipe(test: f64, words: &str) -> String {
    format!(
        r#"
name = "embedded"
licence = "zlib"
attribution = "DeepMimic"
mirror = true
[windows]
shortest = 1.0
longest = 9.8
[split]
test = {test:?}
validation = 0.0
[[source]]
files = "{{move}}.motion.npz"
[words.move.walk]
does = ["walks"]
[words.move.jump]
does = ["jumps", "leaps"]
held_out.does = ["hops"]
[words.move.dance]
does = ["dances"]
{words}
[[caption]]
text = "a person {{move.does}}"
"#
    )
}

pub fn path(path: &Path) -> &str {
    path.to_str().unwrap()
}
