//! Small folders of motions.

#![allow(dead_code, unreachable_pub)] // Every test file uses some of it.

use std::fs;
use std::path::{Path, PathBuf};

use glam::Vec3;
use physique::motion::embedded;
use physique::motion::features::{JointPositions, MotionFeatures, extract, write_features};
use physique::motion::mapping::BodyRest;
use physique::motion::{FrameRate, Motion, Recording};
use physique_data::{DataLimits, Dataset, Recipe, Source, build};

pub const RECIPE: &str = r#"
name = "small"
licence = "CC0"
attribution = "nobody"
mirror = true
[windows]
shortest = 1.0
longest = 2.0
[split]
validation = 0.0
test = 0.34
within = "content"
[[source]]
files = "**/{content}_{style}_{take}.npz"
[[leave_out]]
labels = { content = "dance" }
reason = "no dancing here"
[words.content.walk]
does = ["walks", "is walking"]
held_out.does = ["strolls"]
[words.content.turn-left]
mirrored = "turn-right"
does = ["turns left"]
[words.content.turn-right]
mirrored = "turn-left"
does = ["turns right"]
[words.style.sad]
kind = ["sad"]
[[caption]]
text = "a person {content.does}"
[[caption]]
text = "{a style.kind} person {content.does}"
"#;

pub fn body() -> physique::body::Body {
    let model = physique::body::open_body().unwrap();
    physique::body::Body::mean(model, physique::body::Sex::Neutral).unwrap()
}

/// Some frames of the embedded walk, shifted so that recordings differ.
pub fn walk(frames: usize, shift: f32) -> Motion {
    let walk = embedded::clip("walk").unwrap().load().unwrap().motion;
    let of = |frame: usize| frame % walk.frame_count();
    let root = (0..frames).map(|f| walk.root_translation()[of(f)] + Vec3::new(shift, 0.0, 0.0));
    let rotations = (0..frames).flat_map(|f| walk.frame_rotations(of(f)).to_vec());
    Motion::new(walk.frame_rate(), None, root.collect(), rotations.collect()).unwrap()
}

pub fn write_motion(folder: &Path, name: &str, motion: &Motion) {
    fs::create_dir_all(folder).unwrap();
    let recording = Recording {
        motion: motion.clone(),
        name: String::new(),
        rest_pelvis: body().rest_joint(physique::body::Joint::Pelvis),
        source: None,
        licence: None,
        notes: Vec::new(),
    };
    physique::motion::native::write(folder.join(name), &recording).unwrap();
}

/// Three walks, a left turn, one clip that is too short, one that is not wanted, one without words,
/// one that is broken, one that no pattern names.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().join("takes");
    for take in 0..3 {
        let motion = walk(100 + 10 * take, take as f32);
        write_motion(&at, &format!("walk_sad_{take}.npz"), &motion);
    }
    write_motion(&at, "turn-left_plain_0.npz", &walk(80, 0.5));
    write_motion(&at, "walk_short_0.npz", &walk(10, 0.0));
    write_motion(&at, "dance_sad_0.npz", &walk(90, 0.0));
    write_motion(&at, "hop_sad_0.npz", &walk(90, 0.0));
    fs::write(at.join("walk_broken_0.npz"), b"PK\x03\x04 and nothing more").unwrap();
    write_motion(&at, "other.npz", &walk(90, 0.0));
    fs::write(at.join("readme.txt"), b"not a motion").unwrap();
    folder
}

/// The folder as a data file.
pub fn built(recipe: &str, folder: &Path) -> (Dataset, PathBuf) {
    let recipe = Recipe::parse(recipe, "test").unwrap();
    let output = folder.join("out.pmd");
    let limits = DataLimits::default();
    build(
        &Source::Recipe(Box::new(recipe)),
        folder,
        &output,
        &limits,
        &(),
    )
    .unwrap();
    (Dataset::open(&output, &limits).unwrap(), output)
}

/// HumanML3D features of a walk.
pub fn features(frames: usize) -> MotionFeatures {
    let motion = walk(frames + 1, 0.0);
    let positions = JointPositions::from_motion(&motion, &BodyRest::from(&body())).unwrap();
    let features = extract(&positions).unwrap();
    let rate = FrameRate::new(20.0).unwrap();
    MotionFeatures::new(rate, features.skeleton(), features.values().to_vec()).unwrap()
}

/// A folder in the published layout.
pub fn published() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("new_joint_vecs")).unwrap();
    fs::create_dir(at("texts")).unwrap();
    let clip = |name: &str, frames: usize, text: &str| {
        let file = at("new_joint_vecs").join(format!("{name}.npy"));
        write_features(file, &features(frames)).unwrap();
        fs::write(at("texts").join(format!("{name}.txt")), text).unwrap();
    };
    let whole = "a man walks.#a/DET man/NOUN walk/VERB#0.0#0.0\n";
    clip("000001", 60, whole);
    clip(
        "M000001",
        60,
        "a man walks mirrored.#a/DET man/NOUN#0.0#0.0\n",
    );
    let parts = "he walks#he/PRON walk/VERB#0.0#0.0\nhe starts#he/PRON start/VERB#0.0#2.5\n\
                 too short#a/DET#1.0#1.5\n";
    clip("000002", 120, parts);
    clip("000003", 30, whole);
    clip("000004", 210, whole);
    clip("000005", 60, "no fields at all\n");
    clip("007975", 60, whole);
    // One number of a row becomes NaN, as in the published clip of this name.
    let file = at("new_joint_vecs").join("007975.npy");
    let mut bytes = fs::read(&file).unwrap();
    let place = bytes.len() - 4 * 263 * 3;
    bytes[place..place + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    fs::write(&file, bytes).unwrap();
    fs::write(
        at("train.txt"),
        "000001\nM000001\n000003\n000005\n007975\n000009\n",
    )
    .unwrap();
    fs::write(at("val.txt"), "000004\n").unwrap();
    fs::write(at("test.txt"), "000002\n000001\n").unwrap();
    folder
}
