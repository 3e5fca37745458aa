//! Intersecting pairs between two leaves.

use multiversion::multiversion;

use super::SharedVertices;
use super::lanes::{Portable, Vector};
use super::leaf::Leaf;
use super::separation::{overlapping, unseparated};
use super::tree::Aabb;
use crate::exact;

/// Two leaves, which may be the same one.
#[derive(Clone, Copy)]
pub(super) struct LeafPair<'a> {
    pub(super) first: &'a Leaf,
    pub(super) second: &'a Leaf,
    pub(super) same: bool,
    pub(super) box_of_second: &'a Aabb,
}

/// Appends all intersecting pairs of triangles between two leaves.
pub(super) fn find(leaves: LeafPair<'_>, shared: SharedVertices, pairs: &mut Vec<(u32, u32)>) {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx512f") {
        // SAFETY: the feature was detected.
        return unsafe { find_avx512(leaves, shared, pairs) };
    }
    find_portable(leaves, shared, pairs);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn find_avx512(leaves: LeafPair<'_>, shared: SharedVertices, pairs: &mut Vec<(u32, u32)>) {
    find_with::<super::lanes::avx512::Avx512>(leaves, shared, pairs);
}

#[multiversion(targets = "simd")]
fn find_portable(leaves: LeafPair<'_>, shared: SharedVertices, pairs: &mut Vec<(u32, u32)>) {
    find_with::<Portable>(leaves, shared, pairs);
}

#[inline(always)]
fn find_with<V: Vector>(leaves: LeafPair<'_>, shared: SharedVertices, pairs: &mut Vec<(u32, u32)>) {
    let LeafPair {
        first,
        second,
        same,
        box_of_second,
    } = leaves;
    let skip_shared = shared == SharedVertices::Skip;
    let mut lanes = overlapping::<V>(box_of_second, first);
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize;
        lanes &= lanes - 1;
        // Within one leaf, every pair once.
        let later = if same {
            u32::MAX << (lane + 1)
        } else {
            u32::MAX
        };
        let mut candidates = overlapping::<V>(&first.bounds_of(lane), second) & later;
        if candidates != 0 {
            candidates = unseparated::<V>(first, lane, second, skip_shared, candidates);
        }
        while candidates != 0 {
            let other = candidates.trailing_zeros() as usize;
            candidates &= candidates - 1;
            if intersect(first, lane, second, other) {
                let (a, b) = (first.triangles[lane], second.triangles[other]);
                pairs.push((a.min(b), a.max(b)));
            }
        }
    }
}

/// Whether two triangles meet, beyond what they share if they share vertices. Exact.
#[inline(never)]
fn intersect(first: &Leaf, lane: usize, second: &Leaf, other: usize) -> bool {
    let (a, b) = (first.vertices(lane), second.vertices(other));
    let (mut p, mut q) = (first.triangle(lane), second.triangle(other));
    // The first corner that both have, or that only one has: there is one wherever it is asked for.
    let find = |of: [u32; 3], within: [u32; 3], shared: bool| {
        (0..3)
            .find(|&corner| within.contains(&of[corner]) == shared)
            .unwrap_or(0)
    };
    match a.iter().filter(|vertex| b.contains(vertex)).count() {
        0 => exact::triangles_meet(p, q),
        1 => {
            p.rotate_left(find(a, b, true));
            q.rotate_left(find(b, a, true));
            exact::meet_beyond_corner(p, q)
        }
        2 => {
            p.rotate_left((find(a, b, false) + 1) % 3);
            exact::meet_beyond_edge(p, [p[0], p[1], q[find(b, a, false)]])
        }
        // The same three vertices: one lies on the other.
        _ => true,
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use glam::Vec3;

    use super::super::lanes::avx512::Avx512;
    use super::super::leaf::LANES;
    use super::*;
    use crate::shapes::{Mesh, icosphere};

    /// The masks of both stages for one triangle against a leaf.
    #[inline(always)]
    fn masks<V: Vector>(one: &Leaf, lane: usize, leaf: &Leaf, skip_shared: bool) -> [u32; 2] {
        let all = super::super::leaf::ALL_LANES;
        [
            overlapping::<V>(&one.bounds_of(lane), leaf),
            unseparated::<V>(one, lane, leaf, skip_shared, all),
        ]
    }

    #[target_feature(enable = "avx512f")]
    fn masks_avx512(one: &Leaf, lane: usize, leaf: &Leaf, skip_shared: bool) -> [u32; 2] {
        masks::<Avx512>(one, lane, leaf, skip_shared)
    }

    #[test]
    fn wide_vectors_separate_exactly_what_the_portable_ones_do() {
        if !is_x86_feature_detected!("avx512f") {
            return;
        }
        let ball = icosphere(0.5, 3);
        let mesh =
            Mesh::joined([&ball, &ball.clone().translated(Vec3::new(0.3, 0.2, 0.1))]).unwrap();
        let order: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        let mut leaves = Leaf::fill(&mesh.triangles, &order);
        leaves
            .iter_mut()
            .for_each(|leaf| leaf.refit(&mesh.positions));
        let mut undecided = 0;
        for (one, leaf) in leaves
            .iter()
            .flat_map(|one| leaves.iter().map(move |leaf| (one, leaf)))
        {
            for (lane, skip_shared) in (0..LANES).flat_map(|lane| [(lane, true), (lane, false)]) {
                // SAFETY: the feature was detected.
                let wide = unsafe { masks_avx512(one, lane, leaf, skip_shared) };
                assert_eq!(wide, masks::<Portable>(one, lane, leaf, skip_shared));
                undecided += (wide[0] & wide[1]).count_ones();
            }
        }
        assert!(undecided > 100);
    }
}
