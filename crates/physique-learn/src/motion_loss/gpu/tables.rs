//! A loss as the arrays that kernels read.

use physique::body::Joint;
use physique_motion::features::{FeatureSkeleton, FeatureStatistics, GradientRule, KIT_SOURCES};
use physique_proxy::{FeatureLoss, Pairs, Penalty, SphereBody};

use super::memory::JOINTS;
use super::skeleton;
use super::spheres::{INFLUENCES, SphereCounts};

/// Arrays of a loss.
#[derive(Debug)]
pub(super) struct Tables {
    /// Means of all columns, their deviations, and what is no number.
    pub(super) statistics: Vec<f32>,
    /// By joint, [`skeleton::NUMBERS`].
    pub(super) skeleton: Vec<f32>,
    /// The parent of each joint, then two joints of the features that it lies in the middle of.
    pub(super) hierarchy: Vec<u32>,
    /// By sphere and influence, how the sphere hangs on a joint: the vector from joint to centre at
    /// rest times the weight, and the weight; then the reach of each sphere.
    pub(super) numbers: Vec<f32>,
    /// By sphere and influence, the joint; by sphere, a bit for each other that it is compared with;
    /// by joint, where its followers begin and at last where they end; the followers, as places of
    /// influences.
    pub(super) indices: Vec<u32>,
    pub(super) counts: SphereCounts,
    /// -1 where left is at -x in the features.
    pub(super) handed: f32,
    /// Whether the gradient reaches a joint's rotation through those of its parents.
    pub(super) full: bool,
}

impl Tables {
    pub(super) fn new(loss: &FeatureLoss, statistics: &FeatureStatistics) -> Self {
        let spheres = loss.loss();
        let (body, options) = (spheres.body(), spheres.options());
        let counts = SphereCounts {
            spheres: body.sphere_count(),
            words: body.sphere_count().div_ceil(32),
            linear: options.penalty == Penalty::Linear,
        };
        let mut all_statistics = [statistics.mean(), statistics.deviation()].concat();
        all_statistics.push(f32::NAN);
        Self {
            statistics: all_statistics,
            skeleton: skeleton_numbers(loss),
            hierarchy: hierarchy(statistics.skeleton()),
            numbers: sphere_numbers(body, options.tolerance),
            indices: sphere_indices(body, spheres.pairs(), counts.words),
            counts,
            handed: match statistics.skeleton() {
                FeatureSkeleton::HumanMl3d => 1.0,
                FeatureSkeleton::Kit => -1.0,
            },
            full: loss.rule() == GradientRule::Full,
        }
    }
}

fn skeleton_numbers(loss: &FeatureLoss) -> Vec<f32> {
    let rest_joints = &loss.loss().body().rest_joints;
    let mut numbers = Vec::with_capacity(JOINTS * skeleton::NUMBERS);
    for (joint, direction) in Joint::ALL.iter().zip(loss.layer().rest_directions()) {
        let rest = rest_joints[joint.index()];
        let from = joint.parent().map(|parent| rest_joints[parent.index()]);
        let offset = from.map_or(rest, |from| rest - from);
        numbers.extend(offset.to_array());
        let Some(direction) = direction else {
            numbers.resize(numbers.len() + skeleton::NUMBERS - 3, 0.0);
            continue;
        };
        numbers.extend(direction.as_vec3().to_array());
        numbers.push(1.0);
        // Half a turn about any axis across: 2 a a^T - I.
        let axis = direction.any_orthonormal_vector().to_array();
        for row in 0..3 {
            for column in 0..3 {
                let one = f64::from(u8::from(row == column));
                numbers.push((2.0 * axis[row] * axis[column] - one) as f32);
            }
        }
    }
    numbers
}

fn hierarchy(skeleton: FeatureSkeleton) -> Vec<u32> {
    let parents = Joint::ALL.iter().map(|joint| joint.parent());
    let parents = parents.map(|parent| parent.map_or(0, Joint::index));
    let sources = (0..JOINTS).flat_map(|joint| match skeleton {
        FeatureSkeleton::HumanMl3d => [joint, joint],
        FeatureSkeleton::Kit => KIT_SOURCES[joint],
    });
    parents.chain(sources).map(|index| index as u32).collect()
}

fn sphere_numbers(body: &SphereBody, tolerance: f32) -> Vec<f32> {
    let mut numbers = Vec::new();
    for (centre, row) in body.centres.iter().zip(&body.blend_weights) {
        for &(joint, weight) in row {
            let arm = (*centre - body.rest_joints[usize::from(joint)]) * weight;
            numbers.extend([arm.x, arm.y, arm.z, weight]);
        }
    }
    // Half of what is free is each sphere's.
    numbers.extend(body.radii.iter().map(|radius| radius - 0.5 * tolerance));
    numbers
}

fn sphere_indices(body: &SphereBody, pairs: &Pairs, words: usize) -> Vec<u32> {
    let joints = body.blend_weights.as_flattened();
    let mut indices: Vec<u32> = joints.iter().map(|&(joint, _)| joint.into()).collect();

    let mut partners = vec![0_u32; body.sphere_count() * words];
    for (i, j) in pairs.iter() {
        partners[i * words + j / 32] |= 1 << (j % 32);
        partners[j * words + i / 32] |= 1 << (i % 32);
    }
    indices.extend(partners);

    let mut starts = vec![0];
    let mut followers = Vec::new();
    for joint in 0..JOINTS {
        let of_joint = joints
            .iter()
            .enumerate()
            .filter(|(_, (followed, weight))| usize::from(*followed) == joint && *weight != 0.0);
        followers.extend(of_joint.map(|(place, _)| place as u32));
        starts.push(followers.len() as u32);
    }
    debug_assert!(joints.len() == body.sphere_count() * INFLUENCES);
    indices.extend(starts);
    indices.extend(followers);
    indices
}
