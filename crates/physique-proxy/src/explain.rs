//! Which parts of the body pass through each other, in words.

use std::collections::BTreeMap;
use std::fmt;

use glam::Vec3;
use physique_body::Joint;

use crate::{Pairs, PoseMatrices, SphereBody};

/// Two parts of a body that pass through each other in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartOverlap {
    /// The parts, by the joints that move them; the first comes first in [`Joint`]'s order.
    pub parts: [Joint; 2],
    /// Depth of the deepest two spheres, in the body's unit.
    pub depth: f32,
    /// Indices of those spheres, in the order of the parts.
    pub spheres: [usize; 2],
    /// Middle of their overlap, about the rest body's root.
    pub middle: Vec3,
    /// Number of pairs of spheres that overlap.
    pub pair_count: usize,
}

/// "left forearm in chest, 3.1 cm deep": of a body in metres.
impl fmt::Display for PartOverlap {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, second] = self.parts;
        // The limb is told first: it is the later joint of the two.
        let (inner, outer) = (second.part_name(), first.part_name());
        write!(
            formatter,
            "{inner} in {outer}, {:.1} cm deep",
            100.0 * self.depth
        )
    }
}

/// What a self-intersection loss sees in one pose, the deepest first.
///
/// Compares every pair: some 50 microseconds for the paper's proxy.
pub fn explain(body: &SphereBody, pairs: &Pairs, pose: &PoseMatrices) -> Vec<PartOverlap> {
    let mut centres = Vec::new();
    body.pose(pose, &mut centres);
    let mut found: BTreeMap<[Joint; 2], PartOverlap> = BTreeMap::new();
    for (i, j) in pairs.iter() {
        let apart = centres[j] - centres[i];
        let distance = apart.length();
        let depth = body.radii[i] + body.radii[j] - distance;
        if depth <= 0.0 {
            continue;
        }
        let parts = [body.dominant_joint(i), body.dominant_joint(j)];
        let swapped = parts[0] > parts[1];
        let parts = if swapped { [parts[1], parts[0]] } else { parts };
        // Half-way between the two surfaces, along the line of centres.
        let along = apart.normalize_or_zero() * (body.radii[i] - depth / 2.0);
        let overlap = found.entry(parts).or_insert(PartOverlap {
            parts,
            depth: 0.0,
            spheres: [i, j],
            middle: centres[i],
            pair_count: 0,
        });
        overlap.pair_count += 1;
        if depth > overlap.depth {
            overlap.depth = depth;
            overlap.spheres = if swapped { [j, i] } else { [i, j] };
            overlap.middle = centres[i] + along;
        }
    }
    let mut found: Vec<_> = found.into_values().collect();
    found.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    found
}
