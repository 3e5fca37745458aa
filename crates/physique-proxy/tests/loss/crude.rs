//! Spheres in the open body, placed by a simple rule: enough for tests and benchmarks that want
//! real bodies, poses and loads. Fitted proxies come from `physique proxy fit`.

use glam::Vec3;
use physique_body::{Body, Joint, open_body};
use physique_motion::embedded;
use physique_proxy::{Pairs, PoseMatrices, SphereBody, pose_matrices};

/// Spheres of the paper's proxy.
pub(crate) const SPHERES: usize = 192;

/// Balls that touch the skin from within, the most useful first: each next one covers the most
/// vertices that none covers yet.
pub(crate) fn body() -> SphereBody {
    let body = Body::new(open_body().expect("embedded"), &[]).expect("mean shape");
    let vertices = body.rest_vertices();
    let normals = normals(&body);
    let candidates: Vec<_> = (0..vertices.len())
        .step_by(2)
        .map(|vertex| inner_ball(vertices, vertices[vertex], normals[vertex]))
        .collect();
    let covered_by = |&(centre, radius): &(Vec3, f32)| {
        let near = |vertex: &usize| vertices[*vertex].distance(centre) < radius + 0.006;
        (0..vertices.len()).filter(near).collect::<Vec<_>>()
    };
    let covers: Vec<_> = candidates.iter().map(covered_by).collect();
    let mut free = vec![true; vertices.len()];
    let (mut centres, mut radii) = (Vec::new(), Vec::new());
    for _ in 0..SPHERES {
        let gain = |cover: &Vec<usize>| cover.iter().filter(|&&vertex| free[vertex]).count();
        let best = (0..covers.len()).max_by_key(|&ball| gain(&covers[ball]));
        let best = best.expect("candidates");
        covers[best].iter().for_each(|&vertex| free[vertex] = false);
        centres.push(candidates[best].0);
        radii.push(candidates[best].1);
    }
    let rows = centres.iter().map(|&centre| blend_weights(&body, centre));
    SphereBody {
        blend_weights: rows.collect(),
        rest_joints: Joint::ALL.map(|joint| body.rest_joint(joint)),
        centres,
        radii,
    }
}

/// The paper's choice: not of one joint, and not those that intersect in 90 % of the poses.
pub(crate) fn pairs(body: &SphereBody, poses: &[PoseMatrices]) -> Pairs {
    let spheres = body.sphere_count();
    let mut together = vec![0_usize; spheres * spheres];
    let mut centres = Vec::new();
    for pose in poses {
        body.pose(pose, &mut centres);
        for j in 0..spheres {
            for i in 0..j {
                let touching = body.radii[i] + body.radii[j];
                together[i * spheres + j] +=
                    usize::from(centres[i].distance_squared(centres[j]) < touching * touching);
            }
        }
    }
    let all = Pairs::all(spheres).expect("few");
    all.filtered(|i, j| {
        body.dominant_joint(i) != body.dominant_joint(j)
            && 10 * together[i * spheres + j] < 9 * poses.len()
    })
}

/// Poses of all embedded clips, one after the other.
pub(crate) fn real_poses() -> Vec<PoseMatrices> {
    let mut poses = Vec::new();
    for clip in embedded::clips() {
        let motion = clip.load().expect("embedded").motion;
        poses.extend((0..motion.frame_count()).map(|f| pose_matrices(motion.frame_rotations(f))));
    }
    poses
}

/// The largest ball that touches the skin at `point` and holds no vertex.
fn inner_ball(vertices: &[Vec3], point: Vec3, normal: Vec3) -> (Vec3, f32) {
    let radius = vertices.iter().map(|&other| {
        let inwards = (point - other).dot(normal);
        let square = point.distance_squared(other);
        if inwards > 1e-6 {
            square / (2.0 * inwards)
        } else {
            f32::MAX
        }
    });
    let radius = radius.fold(0.15, f32::min);
    (point - normal * radius, radius)
}

fn normals(body: &Body) -> Vec<Vec3> {
    let vertices = body.rest_vertices();
    let mut normals = vec![Vec3::ZERO; vertices.len()];
    for triangle in body.model().triangles() {
        let [a, b, c] = triangle.map(|vertex| vertices[vertex as usize]);
        for &vertex in triangle {
            normals[vertex as usize] += (b - a).cross(c - a);
        }
    }
    normals.into_iter().map(Vec3::normalize_or_zero).collect()
}

/// The mean of the eight nearest vertices' weights, the four largest of it.
fn blend_weights(body: &Body, centre: Vec3) -> [(u8, f32); 4] {
    let vertices = body.rest_vertices();
    let mut nearest: Vec<_> = (0..vertices.len()).collect();
    nearest.sort_by(|&a, &b| {
        let distance = |vertex: usize| vertices[vertex].distance(centre);
        distance(a).total_cmp(&distance(b))
    });
    let mut mean = [0.0; Joint::COUNT];
    for &vertex in &nearest[..8] {
        for (joint, weight) in body.model().blend_weights().row(vertex) {
            mean[joint.min(Joint::COUNT - 1)] += weight;
        }
    }
    let mut order: [usize; Joint::COUNT] = std::array::from_fn(|joint| joint);
    order.sort_by(|&a, &b| mean[b].total_cmp(&mean[a]));
    let sum: f32 = order[..4].iter().map(|&joint| mean[joint]).sum();
    std::array::from_fn(|place| (order[place] as u8, mean[order[place]] / sum))
}
