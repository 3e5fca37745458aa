//! Figures as Blender exports them: binds, placed meshes, units.

use glam::{Mat4, Quat, Vec3};
use physique_motion::ReadOptions;
use physique_motion::bvh::LengthUnit;
use physique_motion::glb;
use physique_motion::mapping::find_joints;
use serde_json::{Value, json};

use crate::file::{Gltf, only};

/// Name, parent, and place in the parent in centimetres.
pub(crate) type Bone = (&'static str, Option<usize>, Vec3);

/// A figure as Mixamo names it and Blender exports it: centimetres under an armature of 0.01,
/// every bone along its own Y, a skin, and a node pose that is not the bind pose.
pub(crate) fn mixamo() -> (Gltf, Vec<Bone>) {
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
