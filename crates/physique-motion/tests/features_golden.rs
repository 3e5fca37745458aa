//! Features equal to the published pipelines, array by array.
//!
//! Vectors of recorded motion may not be given away: they lie in `shared/golden/recorded` beside
//! the checkout. Without them these tests say so and pass, unless `PHYSIQUE_REQUIRE_SHARED=1`.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::{Path, PathBuf};

use glam::{DMat3, Vec3};
use physique_body::{Body, open_body};
use physique_motion::FrameRate;
use physique_motion::features::{
    BoneRotations, FeatureLayout, FeatureSkeleton, Heading, JointPositions, MotionFeatures,
    RotationLayer, extract, recover_from_positions, recover_from_rotations,
};
use physique_motion::inverse_kinematics::{IkOptions, solve};
use physique_motion::mapping::BodyRest;
use physique_motion::npz::{Archive, ArrayLimits};

const METRES: f32 = 1e-5;
const KIT_UNITS: f32 = 1e-2;

/// Four units in the last place of a coordinate between 1 and 2 metres.
const LAST_PLACES: f32 = 4.8e-7;

/// What the tolerance on KIT's positions lets its shortest bone, of 30 units, turn.
const KIT_ROTATION: f32 = KIT_UNITS / 30.0;

/// The published formula of the layer divides rounded zeros by rounded zeros near a bone's rest
/// direction; in 32 bits it is this far from the exact rotation.
const PUBLISHED_ROUNDING: f32 = 1e-4;

struct Golden(Archive);

impl Golden {
    fn open(path: &Path) -> Self {
        let bytes = std::fs::read(path).unwrap();
        Self(Archive::open(bytes, ArrayLimits::default()).unwrap())
    }

    /// Vectors of recorded motion, if they are here.
    fn recorded(name: &str) -> Option<Self> {
        let shared = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
        let path = shared.join("golden/recorded").join(name);
        if path.is_file() {
            return Some(Self::open(&path));
        }
        let required = std::env::var_os("PHYSIQUE_REQUIRE_SHARED").is_some_and(|set| set == "1");
        assert!(!required, "{} is required and missing", path.display());
        eprintln!("skipped: {} is not here", path.display());
        None
    }

    fn array(&mut self, key: &str) -> Vec<f32> {
        self.0.array(key).unwrap().to_f32().unwrap()
    }

    fn vectors(&mut self, key: &str) -> Vec<Vec3> {
        let values = self.array(key);
        values
            .as_chunks()
            .0
            .iter()
            .copied()
            .map(Vec3::from_array)
            .collect()
    }

    fn features(&mut self, key: &str, skeleton: FeatureSkeleton) -> MotionFeatures {
        MotionFeatures::new(rate(skeleton), skeleton, self.array(key)).unwrap()
    }

    fn positions(&mut self, key: &str, skeleton: FeatureSkeleton) -> JointPositions {
        JointPositions::new(rate(skeleton), skeleton, self.vectors(key)).unwrap()
    }
}

fn rate(skeleton: FeatureSkeleton) -> FrameRate {
    FrameRate::new(skeleton.frames_per_second()).unwrap()
}

fn flat(vectors: &[Vec3]) -> Vec<f32> {
    vectors.iter().flat_map(Vec3::to_array).collect()
}

/// Largest difference, printed with its array's name and demanded to be within the tolerance.
fn assert_near(name: &str, ours: &[f32], theirs: &[f32], tolerance: f32) {
    assert_eq!(ours.len(), theirs.len(), "{name}");
    let differences = ours.iter().zip(theirs).map(|(a, b)| (a - b).abs());
    let largest = differences.fold(0.0_f32, |largest, next| {
        if next > largest || next.is_nan() {
            next
        } else {
            largest
        }
    });
    println!("{name}: largest difference {largest:.2e}, allowed {tolerance:.0e}");
    assert!(largest <= tolerance, "{name}: {largest} > {tolerance}");
}

/// Block by block, so that an error says where it is.
fn assert_features_near(
    name: &str,
    ours: &MotionFeatures,
    theirs: &MotionFeatures,
    tolerance: f32,
) {
    assert_eq!(ours.frame_count(), theirs.frame_count());
    const BLOCKS: [&str; 7] = [
        "turn",
        "root velocity",
        "height",
        "positions",
        "rotations",
        "velocities",
        "contacts",
    ];
    for (block, columns) in BLOCKS
        .into_iter()
        .zip(FeatureLayout::of(ours.skeleton()).blocks())
    {
        let cut = |features: &MotionFeatures| -> Vec<f32> {
            features
                .rows()
                .flat_map(|row| row[columns.clone()].to_vec())
                .collect()
        };
        // Angles, rotations and contacts have no unit of length.
        let allowed = match block {
            "turn" | "contacts" => METRES,
            "rotations" if ours.skeleton() == FeatureSkeleton::Kit => KIT_ROTATION,
            "rotations" => METRES,
            _ => tolerance,
        };
        assert_near(
            &format!("{name}, {block}"),
            &cut(ours),
            &cut(theirs),
            allowed,
        );
    }
}

#[test]
fn positions_recovered_from_a_published_clip_equal_the_published_ones_to_the_last_places() {
    let Some(mut golden) = Golden::recorded("hml_012314.npz") else {
        return;
    };
    let features = golden.features("vec", FeatureSkeleton::HumanMl3d);
    let recovered = recover_from_positions(&features).unwrap();
    let published = golden.array("joints_published");
    assert_near(
        "hml 012314 RIC",
        &flat(recovered.positions()),
        &published,
        LAST_PLACES,
    );
}

#[test]
fn positions_recovered_from_other_clips_equal_the_references() {
    for (file, skeleton, tolerance) in [
        ("hml_000021.npz", FeatureSkeleton::HumanMl3d, METRES),
        ("kit_03950.npz", FeatureSkeleton::Kit, KIT_UNITS),
    ] {
        let Some(mut golden) = Golden::recorded(file) else {
            return;
        };
        let recovered = recover_from_positions(&golden.features("vec", skeleton)).unwrap();
        let reference = golden.array("joints_ref_recover_from_ric");
        assert_near(
            &format!("{file} RIC"),
            &flat(recovered.positions()),
            &reference,
            tolerance,
        );
    }
}

#[test]
fn positions_recovered_from_rotations_equal_the_references() {
    for (file, offsets, skeleton, tolerance) in [
        (
            "hml_012314.npz",
            "tgt_offsets_000021",
            FeatureSkeleton::HumanMl3d,
            METRES,
        ),
        (
            "hml_000021.npz",
            "tgt_offsets",
            FeatureSkeleton::HumanMl3d,
            METRES,
        ),
        (
            "kit_03950.npz",
            "tgt_offsets",
            FeatureSkeleton::Kit,
            KIT_UNITS,
        ),
    ] {
        let Some(mut golden) = Golden::recorded(file) else {
            return;
        };
        let offsets = golden.vectors(offsets);
        let features = golden.features("vec", skeleton);
        let recovered = recover_from_rotations(&features, &offsets).unwrap();
        let reference = golden.array("joints_ref_recover_from_rot");
        assert_near(
            &format!("{file} rotations"),
            &flat(recovered.positions()),
            &reference,
            tolerance,
        );
        let ours = flat(&skeleton.offsets());
        assert_near(
            &format!("{file} skeleton"),
            &ours,
            &flat(&offsets),
            tolerance,
        );
    }
}

#[test]
fn features_extracted_from_published_positions_equal_the_references() {
    for (file, positions, skeleton, tolerance) in [
        (
            "hml_012314.npz",
            "joints_published",
            FeatureSkeleton::HumanMl3d,
            METRES,
        ),
        (
            "kit_03950.npz",
            "joints_ref_recover_from_ric",
            FeatureSkeleton::Kit,
            KIT_UNITS,
        ),
    ] {
        let Some(mut golden) = Golden::recorded(file) else {
            return;
        };
        let features = extract(&golden.positions(positions, skeleton)).unwrap();
        let reference = golden.features("reextracted_vec", skeleton);
        assert_features_near(file, &features, &reference, tolerance);
    }
}

#[test]
fn bone_rotations_equal_the_references() {
    let Some(mut golden) = Golden::recorded("hml_ik_000021.npz") else {
        return;
    };
    let positions = golden.positions("joints", FeatureSkeleton::HumanMl3d);
    for (key, heading) in [
        ("ik_quat", Heading::EachFrame),
        ("ik_quat_smooth", Heading::Smoothed),
    ] {
        let bones = BoneRotations::from_positions(&positions, heading).unwrap();
        let ours: Vec<f32> = bones
            .rotations()
            .iter()
            .flat_map(|q| [q.w, q.x, q.y, q.z])
            .collect();
        assert_near(key, &ours, &golden.array(key), METRES);
    }
    let bones = BoneRotations::from_positions(&positions, Heading::EachFrame).unwrap();
    let roots: Vec<Vec3> = positions.frames().map(|joints| joints[0]).collect();
    let offsets =
        Golden::recorded("hml_000021.npz").map(|mut golden| golden.vectors("tgt_offsets"));
    let again = bones.positions(&offsets.unwrap(), &roots);
    assert_near(
        "fk_joints",
        &flat(&again),
        &golden.array("fk_joints"),
        METRES,
    );
}

#[test]
fn the_papers_rotation_layer_equals_the_reference_where_that_is_finite() {
    for (name, skeleton, nan_frames) in [
        ("hml", FeatureSkeleton::HumanMl3d, 0),
        ("kit", FeatureSkeleton::Kit, 1),
    ] {
        let Some(mut golden) = Golden::recorded(&format!("smpl_layer_{name}.npz")) else {
            return;
        };
        let positions = recover_from_positions(&golden.features("vec", skeleton)).unwrap();
        let smpl = positions.to_smpl_joints().unwrap();
        let layer = RotationLayer::published(skeleton);
        let ours: Vec<Vec<f32>> = smpl
            .positions()
            .as_chunks::<22>()
            .0
            .iter()
            .map(|joints| layer.rotations(joints).iter().flat_map(row_major).collect())
            .collect();
        let (roots, bodies) = (
            golden.array("root_orient_mat"),
            golden.array("body_orient_mat"),
        );
        let (mut compared, mut reference) = (Vec::new(), Vec::new());
        for ((frame, root), body) in ours.iter().zip(roots.chunks(9)).zip(bodies.chunks(21 * 9)) {
            assert!(frame.iter().all(|number| number.is_finite()));
            if !body.iter().chain(root).any(|number| number.is_nan()) {
                compared.extend(frame);
                reference.extend(root.iter().chain(body));
            }
        }
        assert_eq!(ours.len() * 198 - compared.len(), nan_frames * 198);
        assert_near(
            &format!("layer {name}, reference"),
            &compared,
            &reference,
            PUBLISHED_ROUNDING,
        );
        let stable = golden.array("own_rotmats");
        assert_near(
            &format!("layer {name}, all frames"),
            &ours.concat(),
            &stable,
            METRES,
        );

        let motion = layer.motion(&positions, Vec3::ZERO).unwrap();
        let trans = golden.array("trans");
        let tolerance = if name == "hml" { METRES } else { KIT_UNITS };
        assert_near(
            &format!("layer {name}, trans"),
            &flat(motion.root_translation()),
            &trans,
            tolerance,
        );
        let Some(mut golden) = Golden::recorded(&format!("smpl_layer_{name}_joints.npz")) else {
            return;
        };
        let joints = golden.array("smpl_order_joints");
        assert_near(
            &format!("joints {name}"),
            &flat(smpl.positions()),
            &joints,
            tolerance,
        );
    }
}

#[test]
fn rest_directions_equal_the_golden_ones() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    let mut golden = Golden::open(&fixtures.join("rest_directions.npz"));
    for (key, skeleton) in [
        ("hml", FeatureSkeleton::HumanMl3d),
        ("kit", FeatureSkeleton::Kit),
    ] {
        let directions = golden.vectors(key);
        // A body that stands as those directions say is at rest: no joint turns.
        let mut joints = [Vec3::ZERO; 22];
        for joint in physique_body::Joint::ALL {
            if let Some(parent) = joint.parent() {
                joints[joint.index()] = joints[parent.index()] + directions[joint.index()];
            }
        }
        let local = RotationLayer::published(skeleton).rotations(&joints);
        for (joint, rotation) in local.iter().enumerate().skip(1) {
            // The heading is the body's own, up to what its hips and shoulders say.
            let is_near = rotation.abs_diff_eq(DMat3::IDENTITY, 0.1);
            assert!(is_near, "{key} joint {joint}: {rotation:?}");
        }
    }
    let betas = golden.0.array("beta_hml").unwrap().to_f64().unwrap();
    assert_eq!(betas, physique_motion::features::BETAS_HUMANML3D);
    let betas = golden.0.array("beta_kit").unwrap().to_f64().unwrap();
    assert_eq!(betas, physique_motion::features::BETAS_KIT);
}

fn row_major(matrix: &DMat3) -> [f32; 9] {
    matrix
        .transpose()
        .to_cols_array()
        .map(|number| number as f32)
}

#[test]
fn inverse_kinematics_meets_published_clips() {
    let body = Body::new(open_body().unwrap(), &[]).unwrap();
    for (file, skeleton, mean_cm, max_cm) in [
        ("hml_012314.npz", FeatureSkeleton::HumanMl3d, 0.01, 0.02),
        ("kit_03950.npz", FeatureSkeleton::Kit, 0.2, 2.0),
    ] {
        let Some(mut golden) = Golden::recorded(file) else {
            return;
        };
        let positions = recover_from_positions(&golden.features("vec", skeleton)).unwrap();
        let options = IkOptions::default();
        let fit = solve(&positions, &BodyRest::from(&body), &options)
            .unwrap()
            .fit
            .all;
        println!("{file}: {fit:?}");
        assert!(
            fit.mean_cm < mean_cm && fit.max_cm < max_cm,
            "{file}: {fit:?}"
        );
    }
}
