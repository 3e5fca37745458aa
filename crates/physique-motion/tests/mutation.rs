//! An in-process mutational fuzzer for every motion reader, and truncations of every seed.
//!
//! A short run with a fixed seed belongs to the tests. For a long one of one reader:
//! `PHYSIQUE_FUZZ_SECONDS=600 cargo test -p physique-motion --test mutation gltf -- --nocapture`

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::{fs, panic};

use glam::Vec3;
use physique_body::Joint;
use physique_motion::bvh::{self, BvhOptions, BvhWriteOptions};
use physique_motion::mapping::{BodyRest, MappingOptions, map_to_body};
use physique_motion::{
    Limits, ReadOptions, SkeletonClip, SourceMotion, acclaim, embedded, glb, parse_motions,
};

#[path = "../../../attacks/support/mutation.rs"]
mod mutation;
mod support;

use mutation::fuzz;

const ATTACKS: &str = "../../attacks/motion";

fn options() -> ReadOptions {
    ReadOptions {
        limits: Limits {
            bytes: 1 << 24,
            frames: 4096,
            joints: 128,
            depth: 64,
        },
        ..ReadOptions::default()
    }
}

/// Whatever is read can be posed and brought to the body, or is refused; nothing else.
fn use_clip(clip: &SkeletonClip, body: &BodyRest) {
    for frame in (0..clip.frame_count()).take(3) {
        let pose = clip.pose(frame);
        assert!(
            pose.positions.iter().all(|place| place.is_finite()),
            "a place is not finite"
        );
    }
    if clip.frame_count() <= 200 {
        let _ = map_to_body(clip, body, &MappingOptions::default());
    }
}

/// Files of these endings: hostile ones and fixtures.
fn corpus(endings: &[&str]) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for folder in [ATTACKS, "tests/fixtures", "tests/fixtures/arrays", "assets"] {
        for entry in fs::read_dir(Path::new(folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.display().to_string();
            if endings.iter().any(|end| name.ends_with(end)) {
                files.push((name, fs::read(path).unwrap()));
            }
        }
    }
    files.sort();
    files
}

/// Four frames of a walk as BVH.
fn bvh_seed() -> String {
    support::Rig::arms_down(40.0).bvh(&support::walk(4))
}

fn deep_mimic_seed() -> String {
    let mut row = vec![0.0; 44];
    row[0] = 0.05;
    for at in [4, 8, 12, 16, 21, 25, 30, 35, 39] {
        row[at] = 1.0;
    }
    let mut last = row.clone();
    last[4] = 0.5;
    format!("{{\"Loop\": \"none\", \"Frames\": [{row:?}, {row:?}, {last:?}]}}")
}

fn by_content(body: &BodyRest, name: &str, bytes: Vec<u8>) -> bool {
    let Ok(motions) = parse_motions(bytes, name, &options()) else {
        return false;
    };
    for motion in &motions {
        if let SourceMotion::Skeleton(clip) = &motion.motion {
            use_clip(clip, body);
        }
    }
    true
}

#[test]
fn bvh_and_deep_mimic() {
    let body = support::figure();
    let mut files = corpus(&[".bvh", ".json", ".txt"]);
    for _ in 0..6 {
        files.push(("walk.bvh".into(), bvh_seed().into_bytes()));
        files.push(("stand.json".into(), deep_mimic_seed().into_bytes()));
    }
    let words: [&[u8]; 16] = [
        b"ROOT a\n{\n",
        b"JOINT b\n{\n",
        b"End Site\n{\n",
        b"}\n",
        b"}",
        b"OFFSET 0 0 0\n",
        b"CHANNELS 3 Xrotation Yrotation Zrotation\n",
        b"CHANNELS 0\n",
        b"MOTION\n",
        b"Frames: ",
        b"Frame Time: 0\n",
        b"Xposition",
        b"\0",
        b"[",
        b"#",
        b"\xff\xfe",
    ];
    fuzz("BVH, DeepMimic", &files, &words, |name, bytes| {
        by_content(&body, name, bytes)
    });
}

/// The two files of a pair, one after the other with a mark between.
const BETWEEN: &[u8] = b"\n:::\n";

fn read_pair(body: &BodyRest, bytes: &[u8]) -> bool {
    let cut = bytes
        .windows(BETWEEN.len())
        .position(|window| window == BETWEEN);
    let (asf, amc) = match cut {
        Some(cut) => (&bytes[..cut], &bytes[cut + BETWEEN.len()..]),
        None => (bytes, bytes),
    };
    let clip = acclaim::parse(asf, "a.asf", amc, "a.amc", &options());
    clip.inspect(|clip| use_clip(clip, body)).is_ok()
}

#[test]
fn acclaim_pairs() {
    let body = support::figure();
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    for (name, asf) in corpus(&[".asf"]) {
        let amc = Path::new(&name).with_extension("amc");
        let amc = fs::read(amc).unwrap_or_default();
        files.push((name, [&asf, BETWEEN, &amc].concat()));
    }
    let words: [&[u8]; 14] = [
        b"begin\n",
        b"end\n",
        b":hierarchy\n",
        b":bonedata\n",
        b":root\n",
        b":units\n",
        b"dof rx ry rz\n",
        b"axis 0 90 0 XYZ\n",
        b"order TX TY TZ RX RY RZ\n",
        b":RADIANS\n",
        b":FULLY-SPECIFIED\n",
        b"root ",
        b"\0",
        b"\xff\xfe",
    ];
    fuzz("ASF/AMC", &files, &words, |_, bytes| {
        read_pair(&body, &bytes)
    });
}

fn gltf_seeds() -> Vec<(String, Vec<u8>)> {
    let walk = embedded::clip("walk").unwrap().load().unwrap().motion;
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let rest = support::figure();
    let joints = Joint::ALL.map(|joint| rest.joint(joint));
    let parents = Joint::ALL.map(|joint| joint.parent().map(Joint::index));
    let mesh = glb::SkinnedMesh {
        positions: &positions,
        triangles: &[[0, 1, 2]],
        rest_joints: &joints,
        parents: &parents,
        influences: 1,
        blend_joints: &[0; 3],
        blend_weights: &[1.0; 3],
    };
    let file = glb::to_glb(&mesh, &walk, "walk").unwrap();
    let mut files = corpus(&[".glb", ".gltf"]);
    files.extend((0..8).map(|_| ("walk.glb".into(), file.clone())));
    files
}

#[test]
fn gltf() {
    let body = support::figure();
    let words: [&[u8]; 16] = [
        b"{",
        b"}",
        b"[",
        b"]",
        b"\"children\":[0]",
        b"\"skin\":0,",
        b"\"count\":4294967296,",
        b"\"byteStride\":1,",
        b"\"sparse\":{",
        b"\"CUBICSPLINE\"",
        b"\"STEP\"",
        b"\"normalized\":true,",
        b"\"scale\":[0,0,0],",
        b"\"matrix\":[",
        b"5122",
        b"\0",
    ];
    fuzz("glTF", &gltf_seeds(), &words, |name, bytes| {
        let Ok(clips) = glb::parse(&bytes, name, &options()) else {
            return false;
        };
        clips.iter().for_each(|(_, clip)| use_clip(clip, &body));
        true
    });
}

#[test]
fn arrays_and_tables() {
    let body = support::figure();
    let files = corpus(&[".npz", ".npy", ".pkl", ".pt", ".csv"]);
    let words: [&[u8]; 10] = [
        b"'<f8'",
        b"'<f4'",
        b"'|O'",
        b"(4294967296, 263)",
        b"(2, 263)",
        b"(1, 22, 3)",
        b"True",
        b"PK\x01\x02",
        b"\x80\x02",
        b"\0\0\xc0\x7f",
    ];
    fuzz(
        "AMASS, native, features, MDM, CSV",
        &files,
        &words,
        |name, bytes| by_content(&body, name, bytes),
    );
}

#[test]
fn no_truncation_panics() {
    let body = support::figure();
    let mut files = corpus(&[
        ".bvh", ".json", ".txt", ".npz", ".npy", ".pkl", ".pt", ".csv", ".glb", ".gltf", ".amc",
    ]);
    files.push(("walk.bvh".into(), bvh_seed().into_bytes()));
    files.push(("stand.json".into(), deep_mimic_seed().into_bytes()));
    files.push(gltf_seeds().pop().unwrap());
    for (name, bytes) in files {
        let step = (bytes.len() / 300).max(1);
        for length in (0..bytes.len()).step_by(step) {
            let result = panic::catch_unwind(|| by_content(&body, &name, bytes[..length].to_vec()));
            assert!(result.is_ok(), "{name} cut to {length} bytes panics");
        }
    }
}

#[test]
fn seeds_are_sound() {
    let body = support::figure();
    assert!(by_content(&body, "walk.bvh", bvh_seed().into_bytes()));
    assert!(by_content(
        &body,
        "stand.json",
        deep_mimic_seed().into_bytes()
    ));
    // The same clip as text again.
    let clip = bvh::parse(bvh_seed().as_bytes(), "walk.bvh", &BvhOptions::default()).unwrap();
    let again = bvh::format_clip(&clip, &BvhWriteOptions::default());
    assert!(by_content(&body, "again.bvh", again.into_bytes()));
}
