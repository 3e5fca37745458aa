//! The order of spheres: by limb and joint, and by nearness within a joint.
//!
//! What may touch then lies close in memory, and the pair tests find it in the first-level cache.

use std::ops::Range;

use physique_body::Joint;

use super::QUAD;
use crate::SphereBody;

/// Spheres in order, quads as ranges of places, and groups as ranges of quads.
pub(super) fn order(body: &SphereBody) -> (Vec<u16>, Vec<Range<u16>>, Vec<Range<u16>>) {
    let (mut order, mut quads, mut groups) = (Vec::new(), Vec::new(), Vec::new());
    for joint in limb_by_limb() {
        let mut members: Vec<_> = (0..body.sphere_count())
            .filter(|&sphere| body.dominant_joint(sphere) == joint)
            .map(|sphere| sphere as u16)
            .collect();
        if members.is_empty() {
            continue;
        }
        let first_quad = quads.len() as u16;
        let count = members.len().div_ceil(QUAD);
        split(body, &mut members, count, &mut |quad| {
            let start = order.len() as u16;
            order.extend_from_slice(quad);
            quads.push(start..order.len() as u16);
        });
        groups.push(first_quad..quads.len() as u16);
    }
    (order, quads, groups)
}

/// Halves `members` across their longest extent until each part is a quad.
fn split(body: &SphereBody, members: &mut [u16], count: usize, quad: &mut impl FnMut(&[u16])) {
    if count <= 1 {
        quad(members);
        return;
    }
    let centre = |sphere: u16| body.centres[usize::from(sphere)];
    let first = centre(members[0]);
    let (low, high) = members.iter().fold((first, first), |(low, high), &sphere| {
        (low.min(centre(sphere)), high.max(centre(sphere)))
    });
    let axis = (high - low).max_position();
    members.sort_by(|&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]));
    let half = count / 2;
    let (left, right) = members.split_at_mut(members.len() * half / count);
    split(body, left, half, quad);
    split(body, right, count - half, quad);
}

/// Joints in depth-first order: every limb in one piece.
fn limb_by_limb() -> Vec<Joint> {
    let mut joints = Vec::with_capacity(Joint::COUNT);
    let mut waiting = vec![Joint::Pelvis];
    while let Some(joint) = waiting.pop() {
        joints.push(joint);
        let children = Joint::ALL.into_iter().rev();
        waiting.extend(children.filter(|child| child.parent() == Some(joint)));
    }
    joints
}
