//! The figure at rest: joints as nodes, mesh, skin and scene.

use std::collections::BTreeMap;

use glam::{Mat4, Vec3};
use gltf_json::buffer::Target;
use gltf_json::material::{PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked::Valid;
use gltf_json::{Index, Material, Mesh, Node, Scene, Skin};
use physique_body::Joint;

use super::SkinnedMesh;
use super::buffer::Buffer;

/// A matt clay, in linear light.
const COLOUR: [f32; 4] = [0.56, 0.47, 0.40, 1.0];

/// Weights that glTF's players know at each vertex.
const KEPT: usize = 4;

/// Adds the figure and returns the nodes of its joints.
pub(super) fn add(buffer: &mut Buffer, mesh: &SkinnedMesh<'_>, name: &str) -> Vec<Index<Node>> {
    let joints = add_joints(buffer, mesh);
    let inverse_binds: Vec<[f32; 16]> = mesh
        .rest_joints
        .iter()
        .map(|&rest| Mat4::from_translation(-rest).to_cols_array())
        .collect();
    let inverse_bind_matrices = Some(buffer.floats(&inverse_binds, None));
    let root = mesh
        .parents
        .iter()
        .position(Option::is_none)
        .map(|root| joints[root]);
    let skin = buffer.root.push(Skin {
        inverse_bind_matrices,
        joints: joints.clone(),
        name: Some(name.into()),
        skeleton: root,
        extensions: None,
        extras: Default::default(),
    });
    let figure = add_mesh(buffer, mesh, name);
    let figure = buffer.root.push(Node {
        mesh: Some(figure),
        skin: Some(skin),
        name: Some(name.into()),
        ..Node::default()
    });
    let scene = buffer.root.push(Scene {
        nodes: root.into_iter().chain([figure]).collect(),
        name: Some(name.into()),
        extensions: None,
        extras: Default::default(),
    });
    buffer.root.scene = Some(scene);
    joints
}

/// One node a joint, at its rest place in its parent.
fn add_joints(buffer: &mut Buffer, mesh: &SkinnedMesh<'_>) -> Vec<Index<Node>> {
    let joints: Vec<Index<Node>> = mesh
        .rest_joints
        .iter()
        .zip(mesh.parents)
        .enumerate()
        .map(|(joint, (&rest, parent))| {
            let offset = parent.map_or(rest, |parent| rest - mesh.rest_joints[parent]);
            let name = Joint::from_index(joint)
                .map_or_else(|| format!("joint_{joint}"), |joint| joint.name().into());
            buffer.root.push(Node {
                name: Some(name),
                translation: Some(offset.to_array()),
                ..Node::default()
            })
        })
        .collect();
    for (&child, parent) in joints.iter().zip(mesh.parents) {
        if let Some(parent) = parent {
            let node = &mut buffer.root.nodes[joints[*parent].value()];
            node.children.get_or_insert_default().push(child);
        }
    }
    joints
}

fn add_mesh(buffer: &mut Buffer, mesh: &SkinnedMesh<'_>, name: &str) -> Index<Mesh> {
    let target = Some(Target::ArrayBuffer);
    let positions: Vec<[f32; 3]> = mesh.positions.iter().map(Vec3::to_array).collect();
    let normals: Vec<[f32; 3]> = vertex_normals(mesh).iter().map(Vec3::to_array).collect();
    let (joints, weights): (Vec<_>, Vec<_>) = mesh
        .blend_joints
        .chunks_exact(mesh.influences)
        .zip(mesh.blend_weights.chunks_exact(mesh.influences))
        .map(|(joints, weights)| strongest(joints, weights))
        .unzip();
    let attributes = BTreeMap::from([
        (
            Valid(Semantic::Positions),
            buffer.bounded_floats(&positions, target),
        ),
        (Valid(Semantic::Normals), buffer.floats(&normals, target)),
        (Valid(Semantic::Joints(0)), buffer.bytes(&joints, target)),
        (Valid(Semantic::Weights(0)), buffer.floats(&weights, target)),
    ]);
    let indices = Some(buffer.indices(mesh.triangles, mesh.positions.len()));
    let material = buffer.root.push(Material {
        name: Some("body".into()),
        pbr_metallic_roughness: PbrMetallicRoughness {
            base_color_factor: PbrBaseColorFactor(COLOUR),
            metallic_factor: StrengthFactor(0.0),
            roughness_factor: StrengthFactor(0.8),
            ..PbrMetallicRoughness::default()
        },
        ..Material::default()
    });
    buffer.root.push(Mesh {
        name: Some(name.into()),
        primitives: vec![Primitive {
            attributes,
            indices,
            material: Some(material),
            mode: Valid(Mode::Triangles),
            targets: None,
            extensions: None,
            extras: Default::default(),
        }],
        weights: None,
        extensions: None,
        extras: Default::default(),
    })
}

/// The four largest weights of a vertex, summing to 1; joints without weight are 0.
fn strongest(joints: &[u8], weights: &[f32]) -> ([u8; KEPT], [f32; KEPT]) {
    let mut order: Vec<usize> = (0..weights.len())
        .filter(|&slot| weights[slot] > 0.0)
        .collect();
    order.sort_by(|&a, &b| weights[b].total_cmp(&weights[a]));
    order.truncate(KEPT);
    let sum: f32 = order.iter().map(|&slot| weights[slot]).sum();
    let (mut kept_joints, mut kept_weights) = ([0; KEPT], [0.0; KEPT]);
    for (kept, &slot) in order.iter().enumerate() {
        kept_joints[kept] = joints[slot];
        kept_weights[kept] = weights[slot] / sum;
    }
    // Rounding goes to the largest, so that the sum is 1 as exactly as glTF's validator asks.
    kept_weights[0] = 1.0 - kept_weights[1..].iter().sum::<f32>();
    (kept_joints, kept_weights)
}

/// Unit normals at the vertices, triangles weighing by their area.
fn vertex_normals(mesh: &SkinnedMesh<'_>) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; mesh.positions.len()];
    for corners in mesh.triangles {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        for &corner in corners {
            normals[corner as usize] += (b - a).cross(c - a);
        }
    }
    // A vertex of no or only degenerate triangles has no normal: any direction will do.
    normals
        .into_iter()
        .map(|normal| normal.normalize_or(Vec3::Y))
        .collect()
}
