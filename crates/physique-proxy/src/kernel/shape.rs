//! Derivatives by the shape: rest joints, rest centres and radii, summed over frames.

use physique_body::Joint;

use super::Workspace;
use super::kinematics::PARENTS;
use super::workspace::Transform;
use crate::lanes::{Lanes, MOST_LANES, Simd};
use crate::plan::{Blend, Plan};

/// Sums over frames; spheres by their place in the plan.
#[derive(Clone, Debug)]
pub(crate) struct ShapeSums {
    pub(crate) rest_joints: [[f64; 3]; Joint::COUNT],
    pub(crate) centres: Vec<[f64; 3]>,
    pub(crate) radii: Vec<f64>,
}

impl ShapeSums {
    pub(crate) fn new(spheres: usize) -> Self {
        Self {
            rest_joints: [[0.0; 3]; Joint::COUNT],
            centres: vec![[0.0; 3]; spheres],
            radii: vec![0.0; spheres],
        }
    }

    /// Adds the sums over later frames.
    pub(crate) fn add(&mut self, later: &Self) {
        let sums = [&mut self.rest_joints[..], &mut self.centres[..]];
        for (sums, later) in sums
            .into_iter()
            .zip([&later.rest_joints[..], &later.centres[..]])
        {
            for (sum, later) in sums.iter_mut().flatten().zip(later.iter().flatten()) {
                *sum += later;
            }
        }
        for (sum, later) in self.radii.iter_mut().zip(&later.radii) {
            *sum += later;
        }
    }
}

/// Adds what reaches centres, radii and joints by skinning. `by_world` holds what skinning alone has
/// given it.
#[inline(always)]
pub(super) fn add_skin<S: Simd>(
    simd: S,
    plan: &Plan,
    work: &Workspace<S::Lanes>,
    scale: S::Lanes,
    sums: &mut ShapeSums,
) {
    for sphere in 0..plan.sphere_count() {
        sums.radii[sphere] += total(work.by_reaches[sphere] * scale);
    }
    add_centres(simd, &plan.blends.one, work, scale, sums);
    add_centres(simd, &plan.blends.two, work, scale, sums);
    add_centres(simd, &plan.blends.three, work, scale, sums);
    add_centres(simd, &plan.blends.four, work, scale, sums);
    // A sphere hangs on its joints by an arm, which a joint that moves shortens.
    for joint in 0..Joint::COUNT {
        let by_world = &work.by_world[joint];
        let position = [by_world[9], by_world[10], by_world[11]];
        let at_rest = turned_back(&work.world_from_joint[joint], position);
        add(&mut sums.rest_joints[joint], at_rest, -1.0);
    }
}

/// `rotation^T * by_sphere`, weighted, for every joint that a sphere follows.
#[inline(always)]
fn add_centres<S: Simd, const JOINTS: usize>(
    simd: S,
    blends: &[Blend<JOINTS>],
    work: &Workspace<S::Lanes>,
    scale: S::Lanes,
    sums: &mut ShapeSums,
) {
    for blend in blends {
        let sphere = usize::from(blend.sphere);
        let [x, y, z] = work.by_spheres[sphere];
        for joint in 0..JOINTS {
            let scale = scale * simd.splat(blend.arms[joint].weight);
            let by_sphere = [x * scale, y * scale, z * scale];
            let transform = &work.world_from_joint[usize::from(blend.joints[joint])];
            add(
                &mut sums.centres[sphere],
                turned_back(transform, by_sphere),
                1.0,
            );
        }
    }
}

/// Adds what reaches joints by the bones between them. `by_world` is complete.
#[inline(always)]
pub(super) fn add_joints<L: Lanes>(work: &Workspace<L>, sums: &mut ShapeSums) {
    for joint in 0..Joint::COUNT {
        let by_world = &work.by_world[joint];
        let position = [by_world[9], by_world[10], by_world[11]];
        if joint == 0 {
            add(&mut sums.rest_joints[0], position, 1.0);
            continue;
        }
        let parent = PARENTS[joint];
        let in_parent = turned_back(&work.world_from_joint[parent], position);
        add(&mut sums.rest_joints[joint], in_parent, 1.0);
        add(&mut sums.rest_joints[parent], in_parent, -1.0);
    }
}

/// `rotation^T * vector`.
#[inline(always)]
fn turned_back<L: Lanes>(transform: &Transform<L>, [x, y, z]: [L; 3]) -> [L; 3] {
    let [a, b, c, d, e, f, g, h, i, ..] = *transform;
    [
        x.mul_add(a, y.mul_add(d, z * g)),
        x.mul_add(b, y.mul_add(e, z * h)),
        x.mul_add(c, y.mul_add(f, z * i)),
    ]
}

#[inline(always)]
fn add<L: Lanes>(sums: &mut [f64; 3], lanes: [L; 3], sign: f64) {
    for axis in 0..3 {
        sums[axis] += sign * total(lanes[axis]);
    }
}

/// The sum of all lanes, in their order.
#[inline(always)]
fn total<L: Lanes>(lanes: L) -> f64 {
    let mut numbers = [0.0; MOST_LANES];
    lanes.store(&mut numbers);
    let mut sum = 0.0;
    for number in numbers {
        sum += f64::from(number);
    }
    sum
}
