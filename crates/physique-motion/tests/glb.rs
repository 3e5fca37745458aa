//! Skinned GLB: parsed back and posed by glTF's own rules, it must be the body that was written.

#![allow(clippy::unwrap_used)]

use glam::{Mat4, Quat, Vec3, Vec4};
use gltf_json::accessor::ComponentType;
use gltf_json::animation::Property;
use gltf_json::mesh::Semantic;
use gltf_json::validation::Checked::Valid;
use gltf_json::{Accessor, Index, Root};
use physique_body::{Body, Joint, Pose, open_body_low};
use physique_motion::glb::{SkinnedMesh, to_glb, write};
use physique_motion::{Error, FrameRate, Motion, embedded};

fn body() -> Body {
    Body::new(open_body_low().unwrap(), &[0.8, -1.0]).unwrap()
}

/// A parsed file.
struct Glb {
    root: Root,
    data: Vec<u8>,
}

impl Glb {
    fn parse(file: &[u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!(
            (&file[..4], word(4), word(8)),
            (b"glTF".as_slice(), 2, file.len())
        );
        let json_length = word(12);
        assert_eq!(&file[16..20], b"JSON");
        let json = &file[20..20 + json_length];
        let binary = 20 + json_length;
        assert_eq!(&file[binary + 4..binary + 8], b"BIN\0");
        let data = file[binary + 8..].to_vec();
        assert_eq!(
            (word(binary), json_length % 4, data.len() % 4),
            (data.len(), 0, 0)
        );
        let root = Root::from_slice(json).unwrap();
        assert_eq!(root.buffers.len(), 1);
        assert!(
            root.buffers[0].uri.is_none(),
            "nothing lies outside the file"
        );
        Self { root, data }
    }

    fn bytes(&self, index: Index<Accessor>) -> (&[u8], usize) {
        let accessor = &self.root.accessors[index.value()];
        let view = &self.root.buffer_views[accessor.buffer_view.unwrap().value()];
        let start = view.byte_offset.unwrap().0 as usize;
        let bytes = &self.data[start..start + view.byte_length.0 as usize];
        (bytes, bytes.len() / accessor.count.0 as usize)
    }

    fn floats(&self, index: Index<Accessor>) -> Vec<f32> {
        let (bytes, _) = self.bytes(index);
        bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|&value| f32::from_le_bytes(value))
            .collect()
    }

    fn vectors(&self, index: Index<Accessor>) -> Vec<Vec3> {
        self.floats(index)
            .chunks_exact(3)
            .map(Vec3::from_slice)
            .collect()
    }

    fn attribute(&self, semantic: Semantic) -> Index<Accessor> {
        self.root.meshes[0].primitives[0].attributes[&Valid(semantic)]
    }

    /// Key times of the animation.
    fn times(&self) -> Vec<f32> {
        self.floats(self.root.animations[0].samplers[0].input)
    }

    /// Vertices at a key, by glTF 2.0, section 3.7.3: joint matrix = global transform of the
    /// joint's node times its inverse bind matrix; the skinned node's own transform is ignored.
    fn posed(&self, key: usize) -> Vec<Vec3> {
        let animation = &self.root.animations[0];
        let mut locals: Vec<(Vec3, Quat)> = self
            .root
            .nodes
            .iter()
            .map(|node| {
                let translation = node.translation.map_or(Vec3::ZERO, Vec3::from_array);
                (
                    translation,
                    node.rotation
                        .map_or(Quat::IDENTITY, |q| Quat::from_array(q.0)),
                )
            })
            .collect();
        for channel in &animation.channels {
            let output = self.floats(animation.samplers[channel.sampler.value()].output);
            let local = &mut locals[channel.target.node.value()];
            match channel.target.path.unwrap() {
                Property::Translation => local.0 = Vec3::from_slice(&output[key * 3..]),
                Property::Rotation => local.1 = Quat::from_slice(&output[key * 4..]),
                other => panic!("{other:?} is not animated"),
            }
        }
        let mut parents = vec![None; self.root.nodes.len()];
        for (parent, node) in self.root.nodes.iter().enumerate() {
            for child in node.children.iter().flatten() {
                parents[child.value()] = Some(parent);
            }
        }
        let skin = &self.root.skins[0];
        let binds = self.floats(skin.inverse_bind_matrices.unwrap());
        let joint_matrices: Vec<Mat4> = skin
            .joints
            .iter()
            .zip(binds.chunks_exact(16))
            .map(|(joint, bind)| {
                let mut global = Mat4::IDENTITY;
                let mut node = Some(joint.value());
                while let Some(index) = node {
                    let (translation, rotation) = locals[index];
                    global = Mat4::from_rotation_translation(rotation, translation) * global;
                    node = parents[index];
                }
                global * Mat4::from_cols_slice(bind)
            })
            .collect();

        let positions = self.vectors(self.attribute(Semantic::Positions));
        let weights = self.floats(self.attribute(Semantic::Weights(0)));
        let (joints, _) = self.bytes(self.attribute(Semantic::Joints(0)));
        let bindings = joints.chunks_exact(4).zip(weights.chunks_exact(4));
        positions
            .iter()
            .zip(bindings)
            .map(|(position, (joints, weights))| {
                let position = Vec4::from((*position, 1.0));
                let moved = joints.iter().zip(weights).map(|(&joint, &weight)| {
                    joint_matrices[usize::from(joint)] * position * weight
                });
                moved.sum::<Vec4>().truncate()
            })
            .collect()
    }
}

#[test]
fn posed_by_gltfs_rules_it_is_the_body_to_a_tenth_of_a_millimetre() {
    let body = body();
    for clip in embedded::clips() {
        let motion = clip.load().unwrap().motion;
        let glb = Glb::parse(&to_glb(&SkinnedMesh::of(&body), &motion, clip.name).unwrap());
        let frames = motion.frame_count();
        for (frame, time) in glb.times().into_iter().enumerate() {
            let expected = frame as f64 / motion.frame_rate().per_second();
            assert!((f64::from(time) - expected).abs() < 1e-6);
        }
        let mut posed = body.posed();
        for frame in [0, frames / 3, frames / 2, frames - 1] {
            let pose = Pose {
                root_translation: motion.root_translation()[frame],
                rotations: motion.frame_rotations(frame),
            };
            body.pose(&pose, &mut posed).unwrap();
            let worst = glb
                .posed(frame)
                .iter()
                .zip(posed.vertices())
                .map(|(found, expected)| found.distance(*expected))
                .fold(0.0, f32::max);
            assert!(worst < 1e-4, "{}, frame {frame}: {worst} m", clip.name);
        }
    }
}

#[test]
fn the_document_is_one_that_players_expect() {
    let body = body();
    let motion = embedded::clip("walk").unwrap().load().unwrap().motion;
    let glb = Glb::parse(&to_glb(&SkinnedMesh::of(&body), &motion, "a wälk").unwrap());
    let root = &glb.root;
    assert_eq!(root.asset.version, "2.0");
    assert_eq!(
        (
            root.skins[0].joints.len(),
            root.animations[0].channels.len()
        ),
        (22, 23)
    );
    assert_eq!(root.animations[0].name.as_deref(), Some("a wälk"));
    let names: Vec<_> = root
        .nodes
        .iter()
        .filter_map(|node| node.name.as_deref())
        .collect();
    assert_eq!(names[..22], Joint::ALL.map(Joint::name));

    // Bounds are those of the positions; weights sum to 1; unused joints are 0; normals are unit.
    let positions = glb.attribute(Semantic::Positions);
    let low = glb
        .vectors(positions)
        .into_iter()
        .reduce(Vec3::min)
        .unwrap();
    let stated = root.accessors[positions.value()].min.as_ref().unwrap();
    for axis in 0..3 {
        assert_eq!(stated[axis].as_f64().unwrap() as f32, low[axis]);
    }
    let weights = glb.floats(glb.attribute(Semantic::Weights(0)));
    let (joints, _) = glb.bytes(glb.attribute(Semantic::Joints(0)));
    for (weights, joints) in weights.chunks_exact(4).zip(joints.chunks_exact(4)) {
        let sum: f32 = weights.iter().sum();
        assert!((sum - 1.0).abs() < 2e-7, "{weights:?}");
        assert!(
            weights
                .iter()
                .zip(joints)
                .all(|(&weight, &joint)| weight > 0.0 || joint == 0)
        );
    }
    for normal in glb.vectors(glb.attribute(Semantic::Normals)) {
        assert!((normal.length() - 1.0).abs() < 1e-5);
    }

    // Quaternions never take the long way round.
    let animation = &root.animations[0];
    for channel in &animation.channels[1..] {
        let track = glb.floats(animation.samplers[channel.sampler.value()].output);
        for pair in track.chunks_exact(4).collect::<Vec<_>>().windows(2) {
            assert!(Quat::from_slice(pair[0]).dot(Quat::from_slice(pair[1])) >= 0.0);
        }
    }
}

/// A tetrahedron bound to 22 joints in a chain.
fn tetrahedron(vertices: usize) -> (Vec<Vec3>, Vec<Vec3>, Vec<Option<usize>>) {
    let corner = |n: usize| Vec3::new((n % 2) as f32, (n / 2 % 2) as f32, n as f32 * 1e-3);
    let joints = (0..22).map(|joint| Vec3::Y * joint as f32 * 0.1).collect();
    let parents = (0..22).map(|joint: usize| joint.checked_sub(1)).collect();
    ((0..vertices).map(corner).collect(), joints, parents)
}

fn still(frame_rate: f64, frames: usize) -> Motion {
    let rotations = vec![Quat::IDENTITY; 22 * frames];
    Motion::new(
        FrameRate::new(frame_rate).unwrap(),
        None,
        vec![Vec3::ZERO; frames],
        rotations,
    )
    .unwrap()
}

#[test]
fn large_meshes_and_many_weights() {
    let vertices = 70_000;
    let (positions, rest_joints, parents) = tetrahedron(vertices);
    let mesh = SkinnedMesh {
        positions: &positions,
        triangles: &[[0, 1, 69_999], [0, 2, 1]],
        rest_joints: &rest_joints,
        parents: &parents,
        influences: 6,
        blend_joints: &[3, 4, 5, 6, 7, 8].repeat(vertices),
        blend_weights: &[0.1, 0.0, 0.05, 0.4, 0.2, 0.3].repeat(vertices),
    };
    let glb = Glb::parse(&to_glb(&mesh, &still(30.0, 1), "large").unwrap());
    let indices = glb.root.meshes[0].primitives[0].indices.unwrap();
    let accessor = &glb.root.accessors[indices.value()];
    assert_eq!(accessor.component_type.unwrap().0, ComponentType::U32);
    let (bytes, _) = glb.bytes(indices);
    assert_eq!(bytes[8..12], 69_999_u32.to_le_bytes());
    // The four largest of six, largest first, summing to 1.
    let (joints, _) = glb.bytes(glb.attribute(Semantic::Joints(0)));
    assert_eq!(joints[..4], [6, 8, 7, 3]);
    let weights = glb.floats(glb.attribute(Semantic::Weights(0)));
    for (found, expected) in weights.iter().zip([0.4, 0.3, 0.2, 0.1]) {
        assert!((found - expected).abs() < 1e-6);
    }
}

#[test]
fn what_gltf_cannot_hold_is_refused() {
    let (positions, rest_joints, parents) = tetrahedron(4);
    let sound = SkinnedMesh {
        positions: &positions,
        triangles: &[[0, 1, 2]],
        rest_joints: &rest_joints,
        parents: &parents,
        influences: 1,
        blend_joints: &[0; 4],
        blend_weights: &[1.0; 4],
    };
    let motion = still(30.0, 2);
    assert!(to_glb(&sound, &motion, "sound").is_ok());
    let far = [Vec3::NAN; 4];
    let mut looped = parents.clone();
    looped[3] = Some(5);
    for (mesh, word) in [
        (
            SkinnedMesh {
                positions: &[],
                ..sound
            },
            "empty",
        ),
        (
            SkinnedMesh {
                triangles: &[[0, 1, 4]],
                ..sound
            },
            "vertex that does not exist",
        ),
        (
            SkinnedMesh {
                blend_joints: &[22; 4],
                ..sound
            },
            "joint that does not exist",
        ),
        (
            SkinnedMesh {
                blend_weights: &[1.0; 3],
                ..sound
            },
            "weights",
        ),
        (
            SkinnedMesh {
                blend_weights: &[0.0; 4],
                ..sound
            },
            "weights",
        ),
        (
            SkinnedMesh {
                blend_weights: &[f32::NAN; 4],
                ..sound
            },
            "finite",
        ),
        (
            SkinnedMesh {
                positions: &far,
                ..sound
            },
            "finite",
        ),
        (
            SkinnedMesh {
                parents: &looped,
                ..sound
            },
            "tree",
        ),
        (
            SkinnedMesh {
                parents: &[None; 22],
                ..sound
            },
            "tree",
        ),
        (
            SkinnedMesh {
                rest_joints: &rest_joints[..21],
                ..sound
            },
            "22",
        ),
    ] {
        let error = to_glb(&mesh, &motion, "unsound").unwrap_err();
        assert!(
            matches!(error, Error::Unwritable { .. }) && error.to_string().contains(word),
            "{error}"
        );
    }
    assert!(matches!(
        to_glb(&sound, &still(30.0, 0), "none"),
        Err(Error::NoFrames)
    ));
    // The fastest rate there is has times that 32 bits still tell apart.
    assert!(to_glb(&sound, &still(FrameRate::FASTEST, 2_000), "fast").is_ok());
}

#[test]
fn a_file_on_disk_is_named_after_itself_and_always_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.glb");
    let body = body();
    let motion = embedded::clip("walk").unwrap().load().unwrap().motion;
    write(&path, &SkinnedMesh::of(&body), &motion).unwrap();
    let file = std::fs::read(&path).unwrap();
    assert_eq!(
        Glb::parse(&file).root.skins[0].name.as_deref(),
        Some("walk")
    );
    assert_eq!(
        file,
        to_glb(&SkinnedMesh::of(&body), &motion, "walk").unwrap()
    );
}
