//! The mesh-based loss against brute force, differences and what must not change it.

use glam::{DMat3, DVec3, Quat, Vec3};
use physique_body::{Body, Joint, Pose, open_body, open_body_low};
use physique_geometry::exact::triangles_meet;
use physique_geometry::reference::conic_pair_cost;
use physique_proxy::{
    Error, MeshLoss, MeshLossOptions, PoseMatrices, SphereBody, pose_matrices, reference,
};

type Rotations = [Quat; Joint::COUNT];

fn body() -> Body {
    Body::new(open_body_low().expect("embedded"), &[0.5, -0.5]).expect("a body")
}

/// The left forearm folded back through the chest, with the head and the right leg in other poses.
fn folded() -> Rotations {
    let mut pose = [Quat::IDENTITY; Joint::COUNT];
    pose[Joint::Pelvis.index()] = Quat::from_rotation_y(0.4);
    pose[Joint::Neck.index()] = Quat::from_rotation_x(0.3);
    pose[Joint::LeftShoulder.index()] = Quat::from_rotation_z(-1.2);
    pose[Joint::LeftElbow.index()] = Quat::from_rotation_z(-1.6);
    pose[Joint::RightHip.index()] = Quat::from_rotation_z(0.25);
    pose
}

/// Pairs that intersect and count, each tested with each.
fn brute_force(body: &Body, vertices: &[Vec3], least_tree_distance: u8) -> Vec<[[usize; 3]; 2]> {
    let model = body.model();
    let (triangles, parts) = (model.triangles(), model.triangle_parts());
    let corners = |t: usize| triangles[t].map(|vertex| vertices[vertex as usize]);
    let bounds: Vec<_> = (0..triangles.len())
        .map(|t| {
            let [a, b, c] = corners(t);
            (a.min(b).min(c), a.max(b).max(c))
        })
        .collect();
    let mut pairs = Vec::new();
    for a in 0..triangles.len() {
        for b in a + 1..triangles.len() {
            let apart = bounds[a].0.cmpgt(bounds[b].1) | bounds[b].0.cmpgt(bounds[a].1);
            let shared = triangles[a].iter().any(|v| triangles[b].contains(v));
            let near = parts[a].tree_distance(parts[b]) < least_tree_distance;
            if !(apart.any() || shared || near) && triangles_meet(corners(a), corners(b)) {
                pairs.push([a, b].map(|t| triangles[t].map(|vertex| vertex as usize)));
            }
        }
    }
    pairs
}

/// Vertices by the slow reference of posing, as spheres without extent.
fn surface(body: &Body) -> SphereBody {
    let weights = body.model().blend_weights();
    SphereBody {
        rest_joints: Joint::ALL.map(|joint| body.rest_joint(joint)),
        centres: body.rest_vertices().to_vec(),
        radii: vec![0.0; body.rest_vertices().len()],
        blend_weights: (0..weights.vertex_count())
            .map(|vertex| {
                let mut row = [(0, 0.0); 4];
                for (place, (joint, weight)) in row.iter_mut().zip(weights.row(vertex)) {
                    *place = (joint as u8, weight);
                }
                row
            })
            .collect(),
    }
}

fn cost(options: &MeshLossOptions, pairs: &[[[usize; 3]; 2]], vertices: &[DVec3]) -> f64 {
    let corners = |triangle: [usize; 3]| triangle.map(|vertex| vertices[vertex]);
    let costs = pairs
        .iter()
        .map(|&[a, b]| conic_pair_cost(&options.field, corners(a), corners(b)));
    costs.sum()
}

fn posed(body: &Body, rotations: &Rotations) -> Vec<Vec3> {
    let mut posed = body.posed();
    let pose = Pose {
        root_translation: Vec3::ZERO,
        rotations,
    };
    body.pose(&pose, &mut posed).expect("a pose");
    posed.vertices().to_vec()
}

fn gradient(loss: &MeshLoss, pose: &PoseMatrices) -> (f32, PoseMatrices) {
    let (mut losses, mut by_poses) = ([f32::NAN], [[[f32::NAN; 9]; 22]]);
    loss.gradient(&[*pose], &[1.0], &mut losses, &mut by_poses)
        .expect("finite");
    (losses[0], by_poses[0])
}

#[test]
fn equals_brute_force() {
    let body = body();
    for least_tree_distance in [2, 4] {
        let options = MeshLossOptions {
            least_tree_distance,
            ..MeshLossOptions::default()
        };
        let loss = MeshLoss::new(&body, &options).expect("sound");
        for rotations in [[Quat::IDENTITY; Joint::COUNT], folded()] {
            let vertices = posed(&body, &rotations);
            let pairs = brute_force(&body, &vertices, least_tree_distance);
            let vertices: Vec<_> = vertices.iter().map(|vertex| vertex.as_dvec3()).collect();
            let expected = cost(&options, &pairs, &vertices);
            assert_eq!(rotations == folded(), pairs.len() > 20, "{}", pairs.len());

            let mut found = [f32::NAN];
            let pose = pose_matrices(&rotations);
            loss.losses(&[pose], &mut found).expect("finite");
            // Vertices are rounded to 1e-7 m, 1e-4 of the field's unit.
            let error = (f64::from(found[0]) - expected).abs();
            assert!(error <= 1e-3 * expected, "{found:?} {expected}");
            assert_eq!(found[0], gradient(&loss, &pose).0);
        }
    }
}

/// The gradient is the derivative for the pairs that intersect.
#[test]
fn gradients_are_differences() {
    let body = body();
    let options = MeshLossOptions::default();
    let loss = MeshLoss::new(&body, &options).expect("sound");
    let rotations = folded();
    let pairs = brute_force(
        &body,
        &posed(&body, &rotations),
        options.least_tree_distance,
    );
    let surface = surface(&body);
    let pose = pose_matrices(&rotations);
    let (_, by_pose) = gradient(&loss, &pose);
    let rest = reference::rotations(&pose);
    let mut largest = 0.0_f64;
    for joint in [0, 3, 9, 13, 16, 18, 20, 5] {
        for entry in 0..9 {
            const STEP: f64 = 1e-6;
            let at = |step: f64| {
                let mut moved = rest;
                let mut change = [0.0; 9];
                change[entry] = step;
                moved[joint] += DMat3::from_cols_array(&change).transpose();
                let vertices = reference::pose(&surface, &moved, DVec3::ZERO).centres;
                cost(&options, &pairs, &vertices)
            };
            let expected = (at(STEP) - at(-STEP)) / (2.0 * STEP);
            let found = f64::from(by_pose[joint][entry]);
            largest = largest.max(expected.abs());
            let error = (found - expected).abs();
            assert!(
                error <= 2e-3 * largest,
                "{joint} {entry}: {found} {expected}"
            );
        }
    }
    assert!(largest > 0.0);
}

/// Downhill is out: small steps against the gradient lessen the loss.
#[test]
fn steps_downhill_lessen_it() {
    let body = body();
    let loss = MeshLoss::new(&body, &MeshLossOptions::default()).expect("sound");
    let mut rotations = folded();
    let first = gradient(&loss, &pose_matrices(&rotations)).0;
    for _ in 0..30 {
        let pose = pose_matrices(&rotations);
        let (_, by_pose) = gradient(&loss, &pose);
        for joint in [Joint::LeftShoulder, Joint::LeftElbow] {
            let turn = turning(&pose[joint.index()], &by_pose[joint.index()]);
            let step = turn.normalize_or_zero() * 0.005;
            let rotation = &mut rotations[joint.index()];
            *rotation = Quat::from_scaled_axis(-step) * *rotation;
        }
    }
    let last = gradient(&loss, &pose_matrices(&rotations)).0;
    assert!(last < 0.5 * first, "{first} {last}");
}

/// Derivative by a small turn that is put before a rotation: the skew part of `gradient R^T`.
fn turning(rotation: &[f32; 9], gradient: &[f32; 9]) -> Vec3 {
    let product = |row: usize, column: usize| -> f32 {
        (0..3)
            .map(|k| gradient[3 * row + k] * rotation[3 * column + k])
            .sum()
    };
    let skew = |row: usize, column: usize| product(row, column) - product(column, row);
    Vec3::new(skew(2, 1), skew(0, 2), skew(1, 0))
}

#[test]
fn threads_and_company_change_nothing() {
    let body = Body::new(open_body().expect("embedded"), &[]).expect("a body");
    let loss = MeshLoss::new(&body, &MeshLossOptions::default()).expect("sound");
    let poses: Vec<_> = (0..21)
        .map(|frame| {
            let mut rotations = folded();
            rotations[Joint::LeftElbow.index()] = Quat::from_rotation_z(-0.1 * frame as f32);
            pose_matrices(&rotations)
        })
        .collect();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| {
            let weights = vec![0.5; poses.len()];
            let (mut losses, mut by_poses) = (vec![0.0; poses.len()], vec![[[0.0; 9]; 22]; 21]);
            loss.gradient(&poses, &weights, &mut losses, &mut by_poses)
                .expect("finite");
            (losses, by_poses)
        })
    };
    let alone = with(1);
    assert!(alone.0.iter().any(|loss| *loss > 0.0));
    assert_eq!(alone, with(3));
    // A frame knows nothing of the others, and halves weigh half.
    let (loss_of_last, by_last) = gradient(&loss, &poses[20]);
    assert_eq!(loss_of_last, alone.0[20]);
    for (whole, half) in by_last.iter().flatten().zip(alone.1[20].iter().flatten()) {
        assert!((whole - 2.0 * half).abs() <= 1e-5 * whole.abs().max(1.0));
    }
}

#[test]
fn numbers_that_are_none_are_named() {
    let loss = MeshLoss::new(&body(), &MeshLossOptions::default()).expect("sound");
    let mut poses = vec![pose_matrices(&[]); 12];
    poses[9][4][2] = f32::NAN;
    poses[10][0][0] = f32::INFINITY;
    let error = loss.losses(&poses, &mut [0.0; 12]).expect_err("not finite");
    let Error::NotFinite { frame: 9, joint } = error else {
        panic!("{error}");
    };
    assert_eq!(joint.index(), 4);
    let error = loss.losses(&poses, &mut [0.0; 3]).expect_err("too short");
    assert!(matches!(
        error,
        Error::Length {
            expected: 12,
            found: 3,
            ..
        }
    ));
    poses[9] = poses[0].map(|matrix| matrix.map(|number| 1e20 * number));
    let error = loss
        .losses(&poses[..10], &mut [0.0; 10])
        .expect_err("too far");
    assert!(matches!(error, Error::Overflow { frame: 9 }), "{error}");
}
