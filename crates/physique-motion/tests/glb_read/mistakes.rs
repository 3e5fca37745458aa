//! Buffers elsewhere, mistakes, limits and damage.

use std::fs;

use physique_motion::glb;
use physique_motion::{Error, Limits, ReadOptions};
use serde_json::{Value, json};

use crate::figures::mixamo;
use crate::file::{Gltf, error, pair, parse};

#[test]
fn buffers_lie_in_the_file_or_beside_it_and_nowhere_else() {
    let mut gltf = pair();
    let input = gltf.floats("SCALAR", &[0.0, 1.0]);
    let output = gltf.floats("VEC3", &[0.0, 0.0, 0.0, 3.0, 0.0, 0.0]);
    gltf.animate("walk", &[(0, "translation", "LINEAR", input, output)]);
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("figure");
    fs::create_dir_all(inside.join("data")).unwrap();
    let file = inside.join("walk.gltf");
    for place in ["my walk.bin", "data/ä.bin"] {
        fs::write(inside.join(place), &gltf.data).unwrap();
    }
    fs::write(folder.path().join("secret.bin"), &gltf.data).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(folder.path().join("secret.bin"), inside.join("link.bin")).unwrap();
    let read = |uri: &str| {
        fs::write(&file, gltf.beside(uri)).unwrap();
        glb::read(&file, &ReadOptions::default())
    };
    for uri in ["my%20walk.bin", "my walk.bin", "./data/%C3%A4.bin"] {
        assert_eq!(read(uri).unwrap()[0].1.translation(30, 0).x, 3.0, "{uri}");
    }
    let absolute = folder.path().join("secret.bin").display().to_string();
    for uri in [
        "../secret.bin",
        "%2e%2e/secret.bin",
        "data/../../secret.bin",
        &absolute,
        "http://localhost/secret.bin",
        "file:///etc/passwd",
        "..\\secret.bin",
        "c:secret.bin",
        "",
        "a%00b",
        "%ff",
        #[cfg(unix)]
        "link.bin",
    ] {
        let message = read(uri).unwrap_err().to_string();
        assert!(message.contains("same folder"), "{uri}: {message}");
    }
    assert!(matches!(read("missing.bin"), Err(Error::Io { .. })));
    for uri in ["data:text/plain,abc", "data:;base64,%%%%"] {
        assert!(
            read(uri).unwrap_err().to_string().contains("base64"),
            "{uri}"
        );
    }
}

#[test]
fn mistakes_are_named_with_their_place() {
    let sound = || {
        let (mut gltf, _) = mixamo();
        let input = gltf.floats("SCALAR", &[0.0, 0.5]);
        let output = gltf.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        gltf.animate("wave", &[(7, "rotation", "LINEAR", input, output)]);
        gltf
    };
    assert!(parse(&sound().text()).is_ok());
    let huge = json!(1_u64 << 60);
    #[rustfmt::skip]
    let cases: Vec<(&str, Value, &[&str])> = vec![
        ("/nodes/0/children", json!([0]), &["node", "children of one parent"]),
        ("/nodes/0/children/0", json!(99), &["node 0", "node 99"]),
        ("/nodes/7/scale", json!([1.0, -1.0, 1.0]), &["node 7", "mirrored"]),
        ("/nodes/7/scale", json!([0.0, 0.0, 0.0]), &["node 7", "scale [0, 0, 0]"]),
        ("/nodes/7/rotation", json!([0.0, 0.0, 0.0, 0.0]), &["node 7", "rotation [0, 0, 0, 0]"]),
        ("/nodes/7/translation", json!([1e30, 0.0, 0.0]), &["node 7", "translation [1000"]),
        ("/nodes/7/rotation", json!([0.0, 0.0]), &["line 1", "length 2"]),
        ("/skins/0/joints/3", json!(1e9 as u64), &["skin 0", "node 1000000000"]),
        ("/skins/0/inverseBindMatrices", json!(2), &["accessor 2", "MAT4", "VEC4"]),
        ("/skins/0/inverseBindMatrices", huge.clone(), &["accessor 1152921504606846976", "3 of them"]),
        ("/animations/0/samplers/0/input", json!(2), &["accessor 2", "SCALAR"]),
        ("/animations/0/samplers/0/interpolation", json!("CUBICSPLINE"), &["accessor 2", "for 2 keys"]),
        ("/animations/0/samplers/0/interpolation", json!("FASTER"), &["line 1", "FASTER"]),
        ("/animations/0/channels/0/sampler", json!(4), &["animation \"wave\"", "sampler 4"]),
        ("/animations/0/channels/0/target/node", json!(23), &["animation \"wave\"", "none"]),
        ("/animations", json!([]), &["at least one animation"]),
        ("/accessors/1/count", json!(0), &["accessor 2", "0 keys"]),
        ("/accessors/1/count", json!(5), &["accessor 1", "5 elements of 4 bytes"]),
        ("/accessors/2/byteOffset", huge.clone(), &["accessor 2", "fewer bytes"]),
        ("/accessors/2/componentType", json!(5124), &["accessor 2", "5124"]),
        ("/accessors/2/bufferView", json!(50), &["accessor 2", "buffer view 50"]),
        ("/bufferViews/2/byteOffset", json!(u64::MAX), &["accessor 2", "fewer bytes"]),
        ("/bufferViews/2/byteLength", huge.clone(), &["accessor 2", "fewer bytes"]),
        ("/bufferViews/2/byteStride", json!(3), &["accessor 2", "fewer bytes"]),
        ("/bufferViews/2/byteStride", json!(u64::MAX), &["accessor 2", "fewer bytes"]),
        ("/bufferViews/2/buffer", json!(1), &["buffer 1", "1 of them"]),
        ("/bufferViews/2/extensions", json!({ "EXT_meshopt_compression": {} }), &["plain buffer view"]),
        ("/extensionsRequired", json!(["EXT_meshopt_compression"]), &["extensionsRequired"]),
        ("/nodes", json!({}), &["line 1", "map"]),
        ("/nodes/0", json!(-1), &["line 1"]),
    ];
    for (pointer, value, words) in cases {
        let mut gltf = sound();
        match gltf.json.pointer_mut(pointer) {
            Some(place) => *place = value.clone(),
            None => {
                let (parent, key) = pointer.rsplit_once('/').unwrap();
                gltf.json.pointer_mut(parent).unwrap()[key] = value.clone();
            }
        }
        let message = error(&gltf);
        for word in words {
            assert!(
                message.contains(word),
                "{pointer} {value}: \"{word}\" is not in: {message}"
            );
        }
    }

    let with_values = |times: &[f32], turns: &[f32]| {
        let mut gltf = pair();
        let input = gltf.floats("SCALAR", times);
        let output = gltf.floats("VEC4", turns);
        gltf.animate("bad", &[(0, "rotation", "LINEAR", input, output)]);
        error(&gltf)
    };
    let still = [0.0, 0.0, 0.0, 1.0];
    assert!(with_values(&[f32::NAN], &still).contains("accessor 0, element 0"));
    assert!(with_values(&[0.0], &[0.0, f32::INFINITY, 0.0, 1.0]).contains("accessor 1, element 0"));
    assert!(with_values(&[0.0], &[0.0; 4]).contains("accessor 1, key 0"));
    assert!(with_values(&[1.0, 0.0], &[still, still].concat()).contains("times that rise"));

    let glb = sound().binary();
    for (at, bytes, word) in [
        (4, [1, 0, 0, 0], "version 2"),
        (8, [255, 255, 255, 255], "bytes"),
        (12, [255, 255, 255, 255], "JSON chunk"),
        (16, *b"BIN\0", "JSON chunk"),
    ] {
        let mut broken = glb.clone();
        broken[at..at + 4].copy_from_slice(&bytes);
        let message = parse(&broken).unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn limits_hold_before_memory_is_taken() {
    let limited = |gltf: &Gltf, limits: Limits| {
        let options = ReadOptions {
            limits,
            ..ReadOptions::default()
        };
        match glb::parse(&gltf.text(), "some.gltf", &options) {
            Err(Error::Limit { what, .. }) => what,
            other => panic!("{other:?}"),
        }
    };
    let usual = Limits::default;
    let (mut gltf, _) = mixamo();
    let input = gltf.floats("SCALAR", &[0.0, 1000.0]);
    let output = gltf.floats("VEC3", &[0.0; 6]);
    gltf.animate("long", &[(0, "translation", "LINEAR", input, output)]);
    assert!(
        limited(
            &gltf,
            Limits {
                frames: 30_000,
                ..usual()
            }
        )
        .contains("frames")
    );
    assert!(
        limited(
            &gltf,
            Limits {
                joints: 21,
                ..usual()
            }
        )
        .contains("joints")
    );
    assert!(
        limited(
            &gltf,
            Limits {
                depth: 5,
                ..usual()
            }
        )
        .contains("depth")
    );
    assert!(
        limited(
            &gltf,
            Limits {
                bytes: 20_000,
                ..usual()
            }
        )
        .contains("document")
    );
    assert!(
        limited(
            &gltf,
            Limits {
                bytes: 300_000,
                ..usual()
            }
        )
        .contains("frames")
    );
    // Zeros that no file holds.
    gltf.json["accessors"][2] =
        json!({ "componentType": 5126, "count": 1_u64 << 60, "type": "VEC3" });
    assert!(limited(&gltf, usual()).contains("arrays"));
    // A circle of nodes has no end.
    gltf.json["nodes"] = json!([{ "children": [1] }, { "children": [0] }]);
    gltf.json["skins"] = json!([]);
    assert!(limited(&gltf, usual()).contains("depth"));
}

#[test]
fn truncated_and_damaged_files_never_panic() {
    let (mut gltf, _) = mixamo();
    let input = gltf.floats("SCALAR", &[0.0, 0.5]);
    let output = gltf.floats("VEC3", &[0.0; 6]);
    gltf.animate("walk", &[(0, "translation", "LINEAR", input, output)]);
    for file in [gltf.binary(), gltf.text()] {
        for end in (0..file.len() - 1).step_by(7) {
            assert!(parse(&file[..end]).is_err(), "{end}");
        }
        for at in (0..file.len()).step_by(3) {
            let mut damaged = file.clone();
            damaged[at] ^= 1 << (at % 8);
            if let Ok(clips) = parse(&damaged) {
                for (_, clip) in clips {
                    let finite = |frame: usize| {
                        let pose = clip.pose(frame);
                        pose.positions.iter().all(|place| place.is_finite())
                    };
                    assert!((0..clip.frame_count().min(3)).all(finite));
                }
            }
        }
    }
}
