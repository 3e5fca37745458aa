//! Keys, interpolations, kinds of numbers and frame rates.

use std::fs;

use glam::Quat;
use physique_motion::glb;
use physique_motion::{Error, FrameRate, ReadOptions, read_motion, read_motions};
use serde_json::json;

use crate::file::{Gltf, only, pair, path};

#[test]
fn between_keys_the_standards_interpolations_hold() {
    let near = |found: Vec<f32>, expected: &[f32]| {
        let fits = found
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 1e-5);
        assert!(
            fits && found.len() == expected.len(),
            "{found:?} {expected:?}"
        );
    };
    near(
        path("LINEAR", &[1.0, 1.2, 1.4], &[0.0, 1.0, 4.0]),
        &[0.0, 0.5, 1.0, 2.5, 4.0],
    );
    near(
        path("STEP", &[0.0, 0.2, 0.4], &[7.0, 1.0, 4.0]),
        &[7.0, 7.0, 1.0, 1.0, 4.0],
    );
    // In-tangent, value, out-tangent: from 0 with a slope of 10 a second to 1 with none. Half
    // way: 0.5 * 0 + 0.2 * 0.125 * 10 + 0.5 * 1 = 0.75.
    let spline = [0.0, 0.0, 10.0, 0.0, 1.0, 0.0];
    near(path("CUBICSPLINE", &[0.0, 0.2], &spline), &[0.0, 0.75, 1.0]);

    // Rotations take the short way, also between a quaternion and a negated one.
    let mut gltf = pair();
    let input = gltf.floats("SCALAR", &[0.0, 0.1]);
    let quarter = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let turns: Vec<f32> = [Quat::IDENTITY, -quarter]
        .iter()
        .flat_map(Quat::to_array)
        .collect();
    let output = gltf.floats("VEC4", &turns);
    gltf.animate("turn", &[(0, "rotation", "LINEAR", input, output)]);
    let options = ReadOptions {
        frame_rate: Some(FrameRate::new(20.0).unwrap()),
        ..ReadOptions::default()
    };
    let clip = &glb::parse(&gltf.text(), "turn.gltf", &options).unwrap()[0].1;
    let half = Quat::from_rotation_z(std::f32::consts::FRAC_PI_4);
    assert!(clip.rotation(1, 0).angle_between(half) < 1e-3);
    assert_eq!(clip.frame_count(), 3);
}

#[test]
fn numbers_may_be_whole_strided_or_sparse() {
    let turn = |accessor: fn(&mut Gltf) -> usize| {
        let mut gltf = pair();
        let input = gltf.floats("SCALAR", &[0.0, 1.0]);
        let output = accessor(&mut gltf);
        gltf.animate("turn", &[(0, "rotation", "STEP", input, output)]);
        let clip = only(&gltf.binary());
        clip.rotation(clip.frame_count() - 1, 0)
    };
    let eighth = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    for (found, tolerance) in [
        (
            turn(|gltf| {
                let bytes: Vec<u8> = [0, 0, 0, 32767, 0, 0, 23170_i16, 23170]
                    .iter()
                    .flat_map(|value| value.to_le_bytes())
                    .collect();
                let view = gltf.view(&bytes);
                let accessor = json!({ "bufferView": view, "componentType": 5122, "count": 2,
                    "type": "VEC4", "normalized": true });
                gltf.push("accessors", accessor)
            }),
            1e-3,
        ),
        (
            turn(|gltf| {
                let view = gltf.view(&[0, 0, 0, 127, 9, 9, 0, 0, 90, 90]);
                gltf.json["bufferViews"][view]["byteStride"] = json!(6);
                let accessor = json!({ "bufferView": view, "componentType": 5120, "count": 2,
                    "type": "VEC4", "normalized": true });
                gltf.push("accessors", accessor)
            }),
            1e-3,
        ),
        (
            turn(|gltf| {
                // No view at all: zeros, of which both elements are replaced.
                let indices = gltf.view(&[0, 1]);
                let bytes: Vec<u8> = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0_f32]
                    .iter()
                    .flat_map(|value| value.to_le_bytes())
                    .collect();
                let values = gltf.view(&bytes);
                let accessor = json!({ "componentType": 5126, "count": 2, "type": "VEC4",
                    "sparse": { "count": 2,
                        "indices": { "bufferView": indices, "componentType": 5121 },
                        "values": { "bufferView": values } } });
                gltf.push("accessors", accessor)
            }),
            1e-3,
        ),
    ] {
        assert!(found.angle_between(eighth) < tolerance, "{found}");
    }
}

#[test]
fn frame_rates_follow_the_keys() {
    let rate = |times: &[f32]| {
        let mut gltf = pair();
        let input = gltf.floats("SCALAR", times);
        let output = gltf.floats("VEC3", &vec![0.5; 3 * times.len()]);
        gltf.animate("rate", &[(0, "translation", "LINEAR", input, output)]);
        let clip = only(&gltf.text());
        let note = clip.conversion().notes.join("\n");
        (clip.frame_rate().per_second(), clip.frame_count(), note)
    };
    let (found, frames, note) = rate(&[0.0, 1.0 / 60.0, 2.0 / 60.0]);
    assert_eq!((found, frames), (60.0, 3));
    assert!(note.contains("as the keys are spaced"), "{note}");
    let (found, frames, note) = rate(&[0.5, 0.5 + 1.0 / 24.0, 1.5]);
    assert_eq!((found, frames), (24.0, 25));
    assert!(note.contains("uneven"), "{note}");
    let (found, frames, note) = rate(&[0.0, 2.0]);
    assert_eq!((found, frames), (30.0, 61));
    assert!(note.contains("few and far between"), "{note}");
}

#[test]
fn every_animation_is_a_motion() {
    let mut gltf = pair();
    let input = gltf.floats("SCALAR", &[0.0, 1.0]);
    let output = gltf.floats("VEC3", &[0.0; 6]);
    for name in ["walk", "run", "walk", ""] {
        gltf.animate(name, &[(0, "translation", "LINEAR", input, output)]);
    }
    gltf.animate("broken", &[(0, "rotation", "LINEAR", input, 99)]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.glb");
    fs::write(&path, gltf.binary()).unwrap();
    // One that is broken is an error of its own.
    let options = ReadOptions::default();
    let message = read_motions(&path, &options).unwrap_err().to_string();
    assert!(
        message.contains("two.glb") && message.contains("accessor 99"),
        "{message}"
    );
    gltf.json["animations"].as_array_mut().unwrap().pop();
    fs::write(&path, gltf.binary()).unwrap();
    let motions = read_motions(&path, &options).unwrap();
    let names: Vec<&str> = motions.iter().map(|motion| motion.name.as_str()).collect();
    assert_eq!(
        names,
        ["two.glb#walk", "two.glb#run", "two.glb#walk.2", "two.glb#3"]
    );
    assert!(matches!(
        read_motion(&path, &options),
        Err(Error::ManyMotions { found: 4, .. })
    ));
    assert!(read_motion(folder.path().join("two.glb#run"), &options).is_ok());
}
