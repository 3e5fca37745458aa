//! SMPL-family files of invented content in every layout.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{Quat, Vec3};
use physique_body::{
    Body, BodyModel, BodyOptions, Error, Joint, JointSet, Pose, parse_body, read_body,
};

mod support;
use support::{largest_distance, reference_vertices};

const VERTICES: usize = 12;

/// File, joints, betas, whether it has pose directions.
const FILES: [(&str, usize, usize, bool); 14] = [
    ("smpl_py2_clean_p0.pkl", 24, 10, true),
    ("smpl_py2_chumpy_p1.pkl", 24, 10, true),
    ("smpl_py2_chumpy_p2.pkl", 24, 10, true),
    ("smpl_py3_p1.pkl", 24, 10, true),
    ("smpl_py3_p2.pkl", 24, 10, true),
    ("smpl_py3_p3.pkl", 24, 10, true),
    ("smpl_py3_p4.pkl", 24, 10, true),
    ("smpl_py3_p5.pkl", 24, 10, true),
    ("smpl_csr.pkl", 24, 10, false),
    ("smpl_sparse.npz", 24, 10, true),
    ("body_22.npz", 22, 4, true),
    ("smplh.npz", 52, 16, true),
    ("smplx_400.npz", 55, 300, true),
    ("smplx_20.npz", 55, 10, true),
];

fn path(name: &str) -> PathBuf {
    PathBuf::from("tests/fixtures").join(name)
}

fn read(name: &str, joints: JointSet) -> BodyModel {
    let options = BodyOptions {
        joints,
        ..BodyOptions::default()
    };
    read_body(&path(name), &options).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn refused(bytes: Vec<u8>) -> Error {
    parse_body("body", bytes, &BodyOptions::default()).unwrap_err()
}

/// `make_smpl.py`'s formulas.
fn vector(of: impl Fn(f32) -> f32) -> Vec3 {
    Vec3::new(of(0.0), of(1.0), of(2.0))
}

#[test]
fn every_layout_reads_as_it_was_made() {
    for (name, joints, betas, pose_directions) in FILES {
        let model = read(name, JointSet::File);
        assert_eq!(Some(model.name()), name.split('.').next(), "the stem");
        assert_eq!(model.joint_count(), joints, "{name}");
        assert_eq!(model.beta_count(), betas, "{name}");
        assert_eq!(model.vertex_count(), VERTICES, "{name}");
        assert_eq!(model.triangles().first(), Some(&[0, 1, 2]), "{name}");
        assert_eq!(model.triangles().len(), VERTICES - 2, "{name}");
        let features = if pose_directions { 9 * (joints - 1) } else { 0 };
        assert_eq!(model.pose_directions().len(), features, "{name}");
        for vertex in 0..VERTICES {
            let v = vertex as f32;
            let template = vector(|c| (0.1 * (3.0 * v + c) + 1.0).sin());
            assert!(model.template()[vertex].distance(template) < 1e-6, "{name}");
            for (beta, direction) in model.shape_directions().iter().enumerate() {
                let b = beta as f32;
                let expected = vector(|c| 0.01 * (v + 2.0 * c + 3.0 * b).cos());
                assert!(
                    direction[vertex].distance(expected) < 2e-6,
                    "{name}, beta {beta}"
                );
            }
            for (feature, direction) in model.pose_directions().iter().enumerate() {
                let p = feature as f32;
                let expected = vector(|c| 0.001 * (v + 5.0 * c + 7.0 * p).sin());
                assert!(
                    direction[vertex].distance(expected) < 2e-6,
                    "{name}, {feature}"
                );
            }
            let mut weights = vec![0.0; joints];
            weights[vertex * 7 % joints] += 0.75;
            weights[joints - 1 - vertex] += 0.25;
            let mut found = vec![0.0; joints];
            for (joint, weight) in model.blend_weights().row(vertex) {
                found[joint] += weight;
            }
            assert_eq!(found, weights, "{name}, vertex {vertex}");
        }
        for joint in 0..joints {
            let mut row: Vec<_> = model.joint_regressor().row(joint).collect();
            row.sort_by_key(|entry| entry.0);
            let mut vertices = [joint % VERTICES, (joint + 1) % VERTICES];
            vertices.sort_unstable();
            assert_eq!(
                row,
                vertices.map(|vertex| (vertex, 0.5)),
                "{name}, joint {joint}"
            );
        }
    }
}

#[test]
fn hands_of_a_pickle_are_passed_over() {
    assert_eq!(read("smplh_hands.pkl", JointSet::File).joint_count(), 52);
}

#[test]
fn folded_fingers_move_as_fingers_at_rest() {
    let rotations: Vec<Quat> = (0..Joint::COUNT)
        .map(|joint| Quat::from_scaled_axis(vector(|c| (joint as f32 + c).sin())))
        .collect();
    let pose = Pose {
        root_translation: Vec3::new(0.1, 0.9, -0.3),
        rotations: &rotations,
    };
    for (name, ..) in FILES {
        let full = Body::new(Arc::new(read(name, JointSet::File)), &[0.5, -1.0]).unwrap();
        let folded = Body::new(Arc::new(read(name, JointSet::Body22)), &[0.5, -1.0]).unwrap();
        assert_eq!(folded.model().joint_count(), Joint::COUNT, "{name}");
        let (mut of_full, mut of_folded) = (full.posed(), folded.posed());
        full.pose(&pose, &mut of_full).unwrap();
        folded.pose(&pose, &mut of_folded).unwrap();
        for (full, folded) in of_full.vertices().iter().zip(of_folded.vertices()) {
            assert!(full.distance(*folded) < 2e-6, "{name}: {full} {folded}");
        }
        // Pose directions included.
        let expected = reference_vertices(&full, &pose);
        assert!(
            largest_distance(&expected, of_full.vertices()) < 5e-6,
            "{name}"
        );
    }
}

#[test]
fn body_parts_of_fingers_and_face_are_wrists_and_head() {
    let model = read("smplx_400.npz", JointSet::File);
    for &part in model.vertex_parts() {
        assert!(part.index() < Joint::COUNT);
    }
    // Vertex 4 hangs on joint 28, a finger of the left hand.
    assert_eq!(model.vertex_parts()[4], Joint::LeftWrist);
}

#[test]
fn surfaces_are_closed_or_said_to_be_open() {
    let open = physique_body::open_body().unwrap().surface();
    assert_eq!((open.open_edges, open.components), (0, 1));
    assert!(read("body_22.npz", JointSet::File).surface().open_edges > 0);
}

#[test]
fn a_file_that_is_no_body_is_named() {
    let text = refused(b"HIERARCHY\n".to_vec()).to_string();
    assert!(text.contains("HIERARCHY"), "{text}");
    let text = refused(b"\x80\x02}.".to_vec()).to_string();
    assert!(text.contains("v_template"), "{text}");
    let text = refused(b"cos\nsystem\n(S'true'\ntR.".to_vec()).to_string();
    assert!(
        text.contains("os.system") && text.contains("nothing was run"),
        "{text}"
    );
    let missing = read_body(&path("none.npz"), &BodyOptions::default());
    assert!(matches!(missing, Err(Error::File(_))));
}

#[test]
fn the_limit_holds() {
    let options = BodyOptions {
        bytes: 10_000,
        ..BodyOptions::default()
    };
    for name in ["smplx_400.npz", "smpl_py3_p4.pkl"] {
        assert!(read_body(&path(name), &options).is_err());
        let bytes = fs::read(path(name)).unwrap();
        assert!(parse_body(name, bytes, &options).is_err(), "{name}");
    }
}

#[test]
fn no_truncation_panics() {
    for (name, ..) in FILES {
        let bytes = fs::read(path(name)).unwrap();
        // Every few bytes at both ends, where the structure is, and in steps between.
        let steps = (0..bytes.len())
            .filter(|&length| length < 300 || length + 300 > bytes.len() || length % 997 == 0);
        for length in steps {
            let cut = bytes[..length].to_vec();
            assert!(
                parse_body(name, cut, &BodyOptions::default()).is_err(),
                "{name} cut to {length} bytes"
            );
        }
    }
}

/// Broken copies must be refused or read, and nothing else; the seed is fixed.
#[test]
fn no_mutation_panics() {
    let mut state = 7_u64;
    let mut random = |limit: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as usize % limit
    };
    let (mut read, mut refused) = (0, 0);
    for (name, ..) in FILES {
        let original = fs::read(path(name)).unwrap();
        for _ in 0..300 {
            let mut bytes = original.clone();
            for _ in 0..=random(4) {
                let reach = if random(2) == 0 { 600 } else { bytes.len() };
                let at = random(reach.min(bytes.len()));
                bytes[at] = match random(3) {
                    0 => bytes[at] ^ (1 << random(8)),
                    1 => [0, 1, 0x7f, 0x80, 0xff][random(5)],
                    _ => random(256) as u8,
                };
            }
            let options = BodyOptions {
                joints: JointSet::Body22,
                bytes: 1 << 24,
            };
            match parse_body(name, bytes, &options) {
                Ok(_) => read += 1,
                Err(_) => refused += 1,
            }
        }
    }
    assert!(
        read > 100 && refused > 100,
        "{read} read, {refused} refused"
    );
}
