//! The made-up proxy and the poses whose losses PyTorch gave, and which the processor is held to.

use physique_files::npz::{Archive, ArrayLimits};
use physique_motion::features::{FeatureSkeleton, FeatureStatistics, GradientRule, RotationLayer};
use physique_proxy::{FeatureLoss, Pairs, PoseMatrices, SelfIntersection, SphereBody, reference};

use crate::support::{FRAMES, LENGTHS};

const COLUMNS: usize = FeatureSkeleton::HumanMl3d.feature_count();
const JOINTS: usize = 22;

/// The proxy's loss, and motions `[3][FRAMES][COLUMNS]` that go through the poses.
pub(crate) fn golden(rule: GradientRule) -> (FeatureLoss, Vec<f32>, FeatureStatistics) {
    let bytes = include_bytes!("../../../physique-proxy/tests/fixtures/sphere_proxy_posed.npz");
    let mut archive =
        Archive::open(bytes.to_vec(), ArrayLimits::default()).expect("a sound archive");
    let mut array = |key: &str| archive.array(key).expect(key).to_f32().expect(key);
    let poses: Vec<PoseMatrices> = array("rotmats").as_chunks().0.as_chunks().0.to_vec();
    let vectors = |numbers: Vec<f32>| -> Vec<glam::Vec3> {
        let vectors = numbers.as_chunks().0.iter();
        vectors.map(|&xyz| glam::Vec3::from_array(xyz)).collect()
    };
    let blend_weights = array("blend_weights");
    let blend_weights = blend_weights.as_chunks::<JOINTS>().0.iter().map(|row| {
        let mut entries = [(0, 0.0); 4];
        let used = row.iter().enumerate().filter(|(_, weight)| **weight != 0.0);
        for (entry, (joint, &weight)) in entries.iter_mut().zip(used) {
            *entry = (joint as u8, weight);
        }
        entries
    });
    let body = SphereBody {
        blend_weights: blend_weights.collect(),
        rest_joints: vectors(array("joints_rest")).try_into().expect("22 joints"),
        centres: vectors(array("centers_rest")),
        radii: array("radii"),
    };
    let excluded = array("excluded_pairs");
    let spheres = body.sphere_count();
    let pairs = Pairs::all(spheres).expect("few");
    let pairs = pairs.filtered(|i, j| excluded[i * spheres + j] == 0.0);
    let motions = motions(&body, &poses);
    let loss = SelfIntersection::new(&body, &pairs).expect("possible");
    let layer = RotationLayer::published(FeatureSkeleton::HumanMl3d);
    let statistics = FeatureStatistics::new(
        FeatureSkeleton::HumanMl3d,
        vec![0.0; COLUMNS],
        vec![1.0; COLUMNS],
    );
    let loss = FeatureLoss::new(loss, &layer, rule);
    (loss, motions, statistics.expect("possible"))
}

/// From each pose to the next, as positions seen from the ground below the root.
fn motions(body: &SphereBody, poses: &[PoseMatrices]) -> Vec<f32> {
    let positions: Vec<_> = poses
        .iter()
        .map(|pose| {
            let rotations = reference::rotations(pose);
            let posed = reference::pose(body, &rotations, glam::DVec3::ZERO);
            posed.world_from_joint.map(|(_, position)| position)
        })
        .collect();
    let mut motions = vec![0.0; LENGTHS.len() * FRAMES * COLUMNS];
    for (index, row) in motions.chunks_exact_mut(COLUMNS).enumerate() {
        let (motion, frame) = (index / FRAMES, index % FRAMES);
        let from = &positions[motion % positions.len()];
        let to = &positions[(motion + 1) % positions.len()];
        let share = frame as f64 / FRAMES as f64;
        let joints: [_; JOINTS] = std::array::from_fn(|joint| from[joint].lerp(to[joint], share));
        row[3] = joints[0].y as f32;
        for (joint, place) in joints[1..].iter().zip(row[4..].as_chunks_mut::<3>().0) {
            let seen = *joint - joints[0].with_y(0.0);
            *place = seen.as_vec3().to_array();
        }
    }
    motions
}
