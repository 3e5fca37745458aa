//! The order of spheres: by limb, and by nearness within a limb.
//!
//! What may touch then lies close in memory, and the pair tests find it in the first-level cache.
//! Limbs are cut without regard to joints, so that all quads but the last of each limb are full.

use std::ops::Range;

use physique_body::Joint;

use super::QUAD;
use crate::SphereBody;

/// Spheres in a group: three quads.
const GROUP: usize = 3 * QUAD;

/// Spheres in order, quads as ranges of places, and groups as ranges of quads.
pub(super) fn order(body: &SphereBody) -> (Vec<u16>, Vec<Range<u16>>, Vec<Range<u16>>) {
    let (mut order, mut quads, mut groups) = (Vec::new(), Vec::new(), Vec::new());
    for limb in limbs() {
        let mut members: Vec<_> = (0..body.sphere_count())
            .filter(|&sphere| limb.contains(&body.dominant_joint(sphere)))
            .map(|sphere| sphere as u16)
            .collect();
        split(body, &mut members, GROUP, &mut |group| {
            let first_quad = quads.len() as u16;
            split(body, group, QUAD, &mut |quad| {
                let start = order.len() as u16;
                order.extend_from_slice(quad);
                quads.push(start..order.len() as u16);
            });
            groups.push(first_quad..quads.len() as u16);
        });
    }
    (order, quads, groups)
}

/// Halves `members` across their longest extent until each part has `size` members; the last may
/// have fewer.
fn split(body: &SphereBody, members: &mut [u16], size: usize, part: &mut dyn FnMut(&mut [u16])) {
    let Some(&first) = members.first() else {
        return;
    };
    let count = members.len().div_ceil(size);
    if count == 1 {
        part(members);
        return;
    }
    let centre = |sphere: u16| body.centres[usize::from(sphere)];
    let first = centre(first);
    let (low, high) = members.iter().fold((first, first), |(low, high), &sphere| {
        (low.min(centre(sphere)), high.max(centre(sphere)))
    });
    let axis = (high - low).max_position();
    members.sort_by(|&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]));
    let (left, right) = members.split_at_mut(count / 2 * size);
    split(body, left, size, part);
    split(body, right, size, part);
}

/// Chains of joints between branches, in depth-first order.
fn limbs() -> Vec<Vec<Joint>> {
    let children = |joint: Joint| {
        let joints = Joint::ALL.into_iter().rev();
        joints.filter(move |child| child.parent() == Some(joint))
    };
    let mut limbs: Vec<Vec<Joint>> = Vec::new();
    let mut waiting = vec![Joint::Pelvis];
    while let Some(joint) = waiting.pop() {
        let only_child = |parent: Joint| children(parent).count() == 1;
        match limbs.last_mut() {
            Some(limb) if joint.parent().is_some_and(only_child) => limb.push(joint),
            _ => limbs.push(vec![joint]),
        }
        waiting.extend(children(joint));
    }
    limbs
}

#[cfg(test)]
mod tests {
    use physique_body::Joint;

    use super::limbs;

    #[test]
    fn limbs_hold_every_joint_once() {
        let limbs = limbs();
        let mut joints: Vec<Joint> = limbs.concat();
        assert_eq!(limbs.len(), 7);
        assert!(limbs.contains(&vec![
            Joint::LeftHip,
            Joint::LeftKnee,
            Joint::LeftAnkle,
            Joint::LeftFoot
        ]));
        joints.sort();
        assert_eq!(joints, Joint::ALL);
    }
}
