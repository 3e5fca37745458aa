//! The ten parts that IPMAN and HUMOS weigh a body by.

use std::collections::BTreeMap;

use glam::DVec3;
use physique_body::{Body, Joint};

/// Number of parts.
const PARTS: usize = 10;

/// Head, trunk, upper arms, forearms with hands, thighs, lower legs with feet.
const fn part(joint: Joint) -> usize {
    match joint {
        Joint::Neck | Joint::Head => 0,
        Joint::Pelvis
        | Joint::Spine1
        | Joint::Spine2
        | Joint::Spine3
        | Joint::LeftCollar
        | Joint::RightCollar => 1,
        Joint::LeftShoulder => 2,
        Joint::RightShoulder => 3,
        Joint::LeftElbow | Joint::LeftWrist => 4,
        Joint::RightElbow | Joint::RightWrist => 5,
        Joint::LeftHip => 6,
        Joint::RightHip => 7,
        Joint::LeftKnee | Joint::LeftAnkle | Joint::LeftFoot => 8,
        Joint::RightKnee | Joint::RightAnkle | Joint::RightFoot => 9,
    }
}

/// `[vertices]` share of the body's volume in m3: the volume of a vertex's part, divided evenly
/// over the part's vertices. Boundary loops of a part are closed by a fan around their centroid.
///
/// Volumes are those of `vertices`, which HUMOS takes from the first frame of a clip.
pub(super) fn vertex_volumes(body: &Body, vertices: &[DVec3]) -> Vec<f64> {
    let model = body.model();
    let mut volumes = [0.0; PARTS];
    for (index, volume) in volumes.iter_mut().enumerate() {
        let triangles: Vec<_> = model
            .triangles()
            .iter()
            .zip(model.triangle_parts())
            .filter(|(_, joint)| part(**joint) == index)
            .map(|(triangle, _)| *triangle)
            .collect();
        *volume = closed_volume(vertices, &triangles);
    }
    let mut counts = [0_usize; PARTS];
    for joint in model.vertex_parts() {
        counts[part(*joint)] += 1;
    }
    let parts = model.vertex_parts().iter().map(|joint| part(*joint));
    parts
        .map(|part| volumes[part] / counts[part] as f64)
        .collect()
}

fn closed_volume(vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let Some(first) = triangles.first() else {
        return 0.0;
    };
    // Any apex serves for a closed surface; a near one keeps the digits.
    let apex = vertices[first[0] as usize];
    let tetrahedron = |a: DVec3, b: DVec3, c: DVec3| (a - apex).dot((b - apex).cross(c - apex));
    let at = |vertex: u32| vertices[vertex as usize];
    let skin: f64 = triangles
        .iter()
        .map(|&[a, b, c]| tetrahedron(at(a), at(b), at(c)))
        .sum();
    let caps: f64 = boundary_loops(triangles)
        .iter()
        .map(|edges| {
            let sum: DVec3 = edges.iter().map(|&(from, _)| at(from)).sum();
            let middle = sum / edges.len() as f64;
            // Against the skin's direction: the cap faces out of the part.
            edges
                .iter()
                .map(|&(from, to)| tetrahedron(at(to), at(from), middle))
                .sum::<f64>()
        })
        .sum();
    (skin + caps).abs() / 6.0
}

/// Edges that only one triangle has, grouped into connected loops.
fn boundary_loops(triangles: &[[u32; 3]]) -> Vec<Vec<(u32, u32)>> {
    let mut open: BTreeMap<(u32, u32), ()> = BTreeMap::new();
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if open.remove(&(to, from)).is_none() {
                open.insert((from, to), ());
            }
        }
    }
    let mut loops = Vec::new();
    while let Some((&edge, ())) = open.first_key_value() {
        open.remove(&edge);
        let mut edges = vec![edge];
        let mut end = edge.1;
        while let Some((&next, ())) = open.range((end, 0)..=(end, u32::MAX)).next() {
            open.remove(&next);
            edges.push(next);
            end = next.1;
        }
        loops.push(edges);
    }
    loops
}

#[cfg(test)]
mod tests {
    use physique_body::{Sex, open_body_low};

    use super::*;

    #[test]
    fn parts_add_up_to_the_body() {
        let body = Body::mean(open_body_low().unwrap(), Sex::Neutral).unwrap();
        let vertices: Vec<_> = body.rest_vertices().iter().map(|v| v.as_dvec3()).collect();
        let total: f64 = vertex_volumes(&body, &vertices).iter().sum();
        // Caps of two neighbours share their loop: what one gains the other loses.
        assert!(
            (total / body.volume() - 1.0).abs() < 0.01,
            "{total} {}",
            body.volume()
        );
    }
}
