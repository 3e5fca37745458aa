//! glTF in: round trips, and every rule of the standard against matrices or by hand.

#![allow(clippy::unwrap_used)]

use std::fs;

use base64::Engine as _;
use glam::{Mat4, Quat, Vec3};
use physique_body::{Body, Joint, open_body_low};
use physique_motion::bvh::LengthUnit;
use physique_motion::glb::{self, SkinnedMesh, to_glb};
use physique_motion::mapping::{BodyRest, MappingOptions, find_joints, map_to_body};
use physique_motion::{
    Error, FrameRate, Limits, ReadOptions, SkeletonClip, embedded, read_motion, read_motions,
};
use serde_json::{Value, json};

/// A document under construction with one buffer.
struct Gltf {
    json: Value,
    data: Vec<u8>,
}

impl Gltf {
    fn new(nodes: Value) -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "nodes": nodes,
            "accessors": [], "bufferViews": [], "animations": [],
        });
        Self {
            json,
            data: Vec::new(),
        }
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        let (offset, length) = (self.data.len(), bytes.len());
        self.data.extend(bytes);
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
        self.push("bufferViews", view)
    }

    fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        let view = self.view(&bytes);
        let width = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let count = values.len() / width;
        let accessor =
            json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind });
        self.push("accessors", accessor)
    }

    fn animate(&mut self, name: &str, tracks: &[(usize, &str, &str, usize, usize)]) {
        let samplers: Vec<Value> = tracks
            .iter()
            .map(|(_, _, interpolation, input, output)| {
                json!({ "input": input, "output": output, "interpolation": interpolation })
            })
            .collect();
        let channels: Vec<Value> = tracks
            .iter()
            .enumerate()
            .map(|(sampler, (node, path, ..))| {
                json!({ "sampler": sampler, "target": { "node": node, "path": path } })
            })
            .collect();
        let animation = json!({ "name": name, "samplers": samplers, "channels": channels });
        self.push("animations", animation);
    }

    /// With the buffer in base64.
    fn text(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        let data = base64::engine::general_purpose::STANDARD.encode(&self.data);
        let uri = format!("data:application/octet-stream;base64,{data}");
        json["buffers"] = json!([{ "byteLength": self.data.len(), "uri": uri }]);
        json.to_string().into_bytes()
    }

    /// With the buffer in a file of this name.
    fn beside(&self, uri: &str) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "byteLength": self.data.len(), "uri": uri }]);
        json.to_string().into_bytes()
    }

    fn binary(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "byteLength": self.data.len() }]);
        let mut json = json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut file = b"glTF\x02\0\0\0".to_vec();
        let word = |length: usize| u32::try_from(length).unwrap().to_le_bytes();
        file.extend(word(28 + json.len() + self.data.len()));
        file.extend(word(json.len()));
        file.extend(b"JSON");
        file.extend(json);
        file.extend(word(self.data.len()));
        file.extend(b"BIN\0");
        file.extend(&self.data);
        file
    }
}

fn parse(bytes: &[u8]) -> Result<Vec<(String, SkeletonClip)>, Error> {
    glb::parse(bytes, "some.glb", &ReadOptions::default())
}

fn only(bytes: &[u8]) -> SkeletonClip {
    let mut clips = parse(bytes).unwrap();
    assert_eq!(clips.len(), 1);
    clips.remove(0).1
}

fn error(gltf: &Gltf) -> String {
    parse(&gltf.text()).unwrap_err().to_string()
}

#[test]
fn what_we_write_comes_back_to_a_tenth_of_a_millimetre() {
    let body = Body::new(open_body_low().unwrap(), &[0.8, -1.0]).unwrap();
    let mut worst = 0.0f32;
    for clip in embedded::clips() {
        let motion = clip.load().unwrap().motion;
        let file = to_glb(&SkinnedMesh::of(&body), &motion, clip.name).unwrap();
        let read = parse(&file).unwrap();
        let [(name, again)] = &read[..] else {
            panic!("one animation")
        };
        assert_eq!(name, clip.name);
        let (rate, known) = (
            again.frame_rate().per_second(),
            motion.frame_rate().per_second(),
        );
        assert!((rate / known - 1.0).abs() < 1e-4, "{rate} {known}");
        assert_eq!(again.frame_count(), motion.frame_count());
        let direct = SkeletonClip::from_motion(&motion, &BodyRest::from(&body)).unwrap();
        for frame in 0..motion.frame_count() {
            let (a, b) = (again.pose(frame), direct.pose(frame));
            for joint in Joint::ALL {
                let at = again.skeleton().find(joint.name()).unwrap();
                worst = worst.max(a.positions[at].distance(b.positions[joint.index()]));
                let turn = a.rotations[at].angle_between(b.rotations[joint.index()]);
                assert!(turn < 2e-3, "{turn}");
            }
        }
        // Mapped, it is the motion that was written.
        let options = MappingOptions {
            share_wrist_twist: false,
            ..MappingOptions::default()
        };
        let mapped = map_to_body(again, &BodyRest::from(&body), &options).unwrap();
        let error = mapped.report.fit_error.all;
        assert!(error.max_cm < 0.01, "{}: {error:?}", clip.name);
    }
    assert!(worst < 1e-4, "{worst} m");
    println!("largest difference of a joint: {:.5} mm", worst * 1000.0);
}

/// Name, parent, and place in the parent in centimetres.
type Bone = (&'static str, Option<usize>, Vec3);

/// A figure as Mixamo names it and Blender exports it: centimetres under an armature of 0.01,
/// every bone along its own Y, a skin, and a node pose that is not the bind pose.
fn mixamo() -> (Gltf, Vec<Bone>) {
    let bones = vec![
        ("Hips", None, Vec3::new(0.0, 100.0, 0.0)),
        ("Spine", Some(0), Vec3::Y * 12.0),
        ("Spine1", Some(1), Vec3::Y * 13.0),
        ("Spine2", Some(2), Vec3::Y * 13.0),
        ("Neck", Some(3), Vec3::Y * 15.0),
        ("Head", Some(4), Vec3::Y * 10.0),
        ("LeftShoulder", Some(3), Vec3::new(6.0, 12.0, 0.0)),
        ("LeftArm", Some(6), Vec3::X * 12.0),
        ("LeftForeArm", Some(7), Vec3::X * 27.0),
        ("LeftHand", Some(8), Vec3::X * 27.0),
        ("RightShoulder", Some(3), Vec3::new(-6.0, 12.0, 0.0)),
        ("RightArm", Some(10), Vec3::X * -12.0),
        ("RightForeArm", Some(11), Vec3::X * -27.0),
        ("RightHand", Some(12), Vec3::X * -27.0),
        ("LeftUpLeg", Some(0), Vec3::new(9.0, -5.0, 0.0)),
        ("LeftLeg", Some(14), Vec3::Y * -44.0),
        ("LeftFoot", Some(15), Vec3::Y * -43.0),
        ("LeftToeBase", Some(16), Vec3::new(0.0, -7.0, 13.0)),
        ("RightUpLeg", Some(0), Vec3::new(-9.0, -5.0, 0.0)),
        ("RightLeg", Some(18), Vec3::Y * -44.0),
        ("RightFoot", Some(19), Vec3::Y * -43.0),
        ("RightToeBase", Some(20), Vec3::new(0.0, -7.0, 13.0)),
    ];
    // Nodes: the bones, the armature, the mesh, a lamp.
    let armature = bones.len();
    let mut nodes = Vec::new();
    for (index, (name, _, offset)) in bones.iter().enumerate() {
        let below = (0..bones.len()).filter(|&other| bones[other].1 == Some(index));
        let children: Vec<usize> = below.collect();
        let pose = Quat::from_rotation_x(0.02 * index as f32);
        let mut node = json!({
            "name": format!("mixamorig:{name}"),
            "translation": offset.to_array(),
            "rotation": pose.to_array(),
        });
        if !children.is_empty() {
            node["children"] = json!(children);
        }
        nodes.push(node);
    }
    let small = [0.01, 0.01, 0.01];
    nodes.push(json!({ "name": "Armature", "scale": small, "children": [0, armature + 1] }));
    nodes.push(json!({ "name": "Body", "mesh": 0, "skin": 0 }));
    nodes.push(json!({ "name": "Lamp", "scale": [0.0, 0.0, 0.0] }));
    let mut gltf = Gltf::new(Value::Array(nodes));

    let mut binds = Vec::new();
    let mut places: Vec<Vec3> = Vec::new();
    for (_, parent, offset) in &bones {
        let place = parent.map_or(Vec3::ZERO, |parent: usize| places[parent]) + *offset;
        places.push(place);
        // Blender: the mesh is in metres in the world, joints keep the armature's scale.
        let world = Mat4::from_scale(Vec3::splat(0.01)) * Mat4::from_translation(place);
        binds.extend(world.inverse().to_cols_array());
    }
    let binds = gltf.floats("MAT4", &binds);
    let joints: Vec<usize> = (0..bones.len()).collect();
    gltf.json["skins"] = json!([{ "joints": joints, "inverseBindMatrices": binds }]);
    (gltf, bones)
}

#[test]
fn mixamos_figure_from_blender_moves_as_by_matrices() {
    let (mut gltf, bones) = mixamo();
    let keys = 25;
    let times: Vec<f32> = (0..keys).map(|key| key as f32 / 24.0).collect();
    let input = gltf.floats("SCALAR", &times);
    let turn = |key: usize, bone: usize| {
        let wave = (key as f32 * 0.3 + bone as f32).sin();
        Quat::from_euler(glam::EulerRot::YXZ, 0.3 * wave, 0.2 * wave, 0.1)
    };
    let path = |key: usize| Vec3::new(0.0, 100.0 + key as f32, 5.0 * key as f32);
    let mut tracks = Vec::new();
    for bone in 0..bones.len() {
        let turns: Vec<f32> = (0..keys)
            .flat_map(|key| turn(key, bone).to_array())
            .collect();
        tracks.push((
            bone,
            "rotation",
            "LINEAR",
            input,
            gltf.floats("VEC4", &turns),
        ));
    }
    let places: Vec<f32> = (0..keys).flat_map(|key| path(key).to_array()).collect();
    tracks.push((
        0,
        "translation",
        "LINEAR",
        input,
        gltf.floats("VEC3", &places),
    ));
    let sizes = gltf.floats("VEC3", &[1.0; 75]);
    tracks.push((3, "scale", "LINEAR", input, sizes));
    gltf.animate("mixamo.com", &tracks);

    let clip = only(&gltf.binary());
    assert_eq!(
        (clip.frame_count(), clip.frame_rate().per_second()),
        (25, 24.0)
    );
    assert_eq!(clip.translated_joints(), [0]);
    let found = find_joints(clip.skeleton()).unwrap();
    assert!(
        format!("{:?}", found.by).contains("Mixamo"),
        "{:?}",
        found.by
    );
    let notes = clip.conversion().notes.join("\n");
    assert!(notes.contains("0.01") && notes.contains("24.0"), "{notes}");

    // The rest pose is the bind pose in metres.
    let rest = clip.skeleton().rest_pose();
    let hand = clip.skeleton().find("mixamorig:LeftHand").unwrap();
    let expected = Vec3::new(0.72, 1.5, 0.0);
    assert!(
        rest.positions[hand].distance(expected) < 1e-5,
        "{}",
        rest.positions[hand]
    );
    assert!(rest.rotations[hand].angle_between(Quat::IDENTITY) < 1e-3);

    let mut worst = 0.0f32;
    for frame in 0..keys {
        let pose = clip.pose(frame);
        let mut matrices: Vec<Mat4> = Vec::new();
        for (index, (name, parent, offset)) in bones.iter().enumerate() {
            let offset = if index == 0 { path(frame) } else { *offset };
            let above = match parent {
                Some(parent) => matrices[*parent],
                None => Mat4::from_scale(Vec3::splat(0.01)),
            };
            matrices.push(above * Mat4::from_rotation_translation(turn(frame, index), offset));
            let joint = clip.skeleton().find(&format!("mixamorig:{name}")).unwrap();
            let place = matrices[index].transform_point3(Vec3::ZERO);
            worst = worst.max(place.distance(pose.positions[joint]));
        }
    }
    assert!(worst < 1e-5, "{worst} m");
}

#[test]
fn bind_poses_are_found_however_the_mesh_is_placed() {
    let rest_hand = |gltf: &Gltf| {
        let clip = only(&gltf.text());
        let hand = clip.skeleton().find("mixamorig:LeftHand").unwrap();
        (
            clip.skeleton().rest_pose().positions[hand],
            clip.conversion().notes.join("\n"),
        )
    };
    let (mut gltf, bones) = mixamo();
    let input = gltf.floats("SCALAR", &[0.0]);
    let output = gltf.floats("VEC4", &[0.0, 0.0, 0.0, 1.0]);
    gltf.animate("still", &[(0, "rotation", "STEP", input, output)]);
    let expected = Vec3::new(0.72, 1.5, 0.0);
    assert!(rest_hand(&gltf).0.distance(expected) < 1e-5);

    // The mesh lies on its back in centimetres, and its node stands it up.
    let binds = {
        let mesh = Mat4::from_rotation_x(-std::f32::consts::FRAC_PI_2);
        let mut places: Vec<Vec3> = Vec::new();
        let mut binds = Vec::new();
        for (_, parent, offset) in &bones {
            let place = parent.map_or(Vec3::ZERO, |parent| places[parent]) + *offset;
            places.push(place);
            binds.extend((Mat4::from_translation(-place) * mesh).to_cols_array());
        }
        gltf.floats("MAT4", &binds)
    };
    gltf.json["skins"][0]["inverseBindMatrices"] = json!(binds);
    let up = Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    gltf.json["nodes"][bones.len() + 1]["rotation"] = json!(up.to_array());
    let (hand, _) = rest_hand(&gltf);
    assert!(hand.distance(expected) < 1e-5, "{hand}");

    // Without matrices, the nodes' own pose is all there is.
    gltf.json["skins"][0]
        .as_object_mut()
        .unwrap()
        .remove("inverseBindMatrices");
    let (hand, notes) = rest_hand(&gltf);
    assert!(
        hand.distance(expected) > 0.01 && notes.contains("no inverse bind matrices"),
        "{notes}"
    );
}

/// Two nodes, the lower one a metre above the upper.
fn pair() -> Gltf {
    Gltf::new(json!([
        { "name": "a", "children": [1] },
        { "name": "b", "translation": [0.0, 1.0, 0.0] },
    ]))
}

/// The path of node `a` under an interpolation, at 10 frames a second.
fn path(interpolation: &str, times: &[f32], values: &[f32]) -> Vec<f32> {
    let mut gltf = pair();
    let input = gltf.floats("SCALAR", times);
    let values: Vec<f32> = values.iter().flat_map(|&x| [x, 0.0, 0.0]).collect();
    let output = gltf.floats("VEC3", &values);
    gltf.animate("path", &[(0, "translation", interpolation, input, output)]);
    let options = ReadOptions {
        frame_rate: Some(FrameRate::new(10.0).unwrap()),
        ..ReadOptions::default()
    };
    let clips = glb::parse(&gltf.text(), "path.gltf", &options).unwrap();
    let clip = &clips[0].1;
    (0..clip.frame_count())
        .map(|frame| clip.translation(frame, 0).x)
        .collect()
}

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
fn other_units_than_metres_are_noticed() {
    let (mut gltf, bones) = mixamo();
    let input = gltf.floats("SCALAR", &[0.0]);
    let output = gltf.floats("VEC3", &[0.0, 90.0, 0.0]);
    gltf.animate("still", &[(0, "translation", "STEP", input, output)]);
    gltf.json["nodes"][bones.len()]
        .as_object_mut()
        .unwrap()
        .remove("scale");
    let clip = only(&gltf.text());
    assert_eq!(clip.conversion().metres_per_unit, 0.01);
    assert!(clip.conversion().notes.join(" ").contains("centimetres"));
    assert!((clip.translation(0, 0).y - 0.9).abs() < 1e-6);
    let given = ReadOptions {
        unit: Some(LengthUnit::Inch),
        ..ReadOptions::default()
    };
    let clip = &glb::parse(&gltf.text(), "a.gltf", &given).unwrap()[0].1;
    assert!((clip.translation(0, 0).y - 90.0 * 0.0254).abs() < 1e-5);
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
