//! A sphere body and its pairs, laid out for the fused kernel.
//!
//! Spheres stand limb by limb, and within a limb in *quads*: up to four neighbours. Up to three quads
//! are a *group*. The broad phase compares boxes of groups, then boxes of quads, then 4 x 4 spheres at
//! once; a pair that is not to be compared has a threshold that nothing is below.

mod blends;
mod quads;

use std::ops::Range;

use glam::Vec3;
use physique_body::Joint;

pub(crate) use blends::{Blend, Blends, Influence};

use crate::{Pairs, SphereBody};

/// Spheres in a quad.
pub(crate) const QUAD: usize = 4;

/// What the kernel reads; spheres are named by their place in [`Plan::order`].
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// The body's index of the sphere at each place.
    pub(crate) order: Vec<u16>,
    /// Half of the depth-free reach of each sphere: its radius less half the tolerance. Padded, so
    /// that every quad can be read as four.
    pub(crate) reach: Vec<f32>,
    /// Position of each joint at rest, from its parent.
    pub(crate) offsets: [[f32; 3]; Joint::COUNT],
    pub(crate) blends: Blends,
    /// By joint, the spheres that follow it.
    pub(crate) followers: [Vec<Influence>; Joint::COUNT],
    /// Places of each quad's four spheres; the last is repeated where there are fewer.
    pub(crate) members: Vec<[u16; QUAD]>,
    pub(crate) quads: Vec<Range<u16>>,
    /// Quads of each group.
    pub(crate) groups: Vec<Range<u16>>,
    pub(crate) group_pairs: Vec<GroupPair>,
    pub(crate) quad_pairs: Vec<[u16; 2]>,
    /// By quad pair: places of the first sphere of each quad.
    pub(crate) quad_starts: Vec<[u16; 2]>,
    /// By quad pair: row `i`, column `j`, half the squared distance below which `i` of the first
    /// quad may touch `j` of the second.
    pub(crate) thresholds: Vec<[[f32; QUAD]; QUAD]>,
}

/// Two groups and the pairs of their quads.
#[derive(Clone, Debug)]
pub(crate) struct GroupPair {
    pub(crate) groups: [u16; 2],
    pub(crate) quad_pairs: Range<u32>,
}

impl Plan {
    /// `body` is checked and `pairs` are pairs of its spheres.
    pub(crate) fn new(body: &SphereBody, pairs: &Pairs, tolerance: f32) -> Self {
        let (order, quads, groups) = quads::order(body);
        let mut place = vec![0; order.len()];
        for (index, &sphere) in order.iter().enumerate() {
            place[usize::from(sphere)] = index;
        }
        let mut reach: Vec<_> = order
            .iter()
            .map(|&sphere| body.radii[usize::from(sphere)] - 0.5 * tolerance)
            .collect();
        reach.resize(order.len() + QUAD - 1, 0.0);
        let (blends, followers) = blends::lay_out(body, &order);
        let members = quads
            .iter()
            .map(|quad| std::array::from_fn(|place| (quad.start + place as u16).min(quad.end - 1)));
        let mut plan = Self {
            offsets: offsets(body),
            reach,
            blends,
            followers,
            members: members.collect(),
            quads,
            groups,
            order,
            group_pairs: Vec::new(),
            quad_pairs: Vec::new(),
            quad_starts: Vec::new(),
            thresholds: Vec::new(),
        };
        plan.lay_out(body, &place, pairs);
        plan
    }

    pub(crate) fn sphere_count(&self) -> usize {
        self.order.len()
    }

    fn lay_out(&mut self, body: &SphereBody, place: &[usize], pairs: &Pairs) {
        let quad_of = owners(&self.quads, self.order.len());
        let group_of = owners(&self.groups, self.quads.len());
        let margin = margin(body);
        let mut entries: Vec<_> = pairs
            .iter()
            .map(|(i, j)| {
                let (a, b) = (place[i].min(place[j]), place[i].max(place[j]));
                let (quad_a, quad_b) = (quad_of[a], quad_of[b]);
                let groups = [group_of[quad_a], group_of[quad_b]];
                (groups, [quad_a, quad_b], a, b)
            })
            .collect();
        entries.sort_unstable();
        for ([group_a, group_b], [quad_a, quad_b], a, b) in entries {
            let (groups, quads) = (
                [group_a as u16, group_b as u16],
                [quad_a as u16, quad_b as u16],
            );
            let next = self.quad_pairs.len() as u32;
            if self
                .group_pairs
                .last()
                .is_none_or(|last| last.groups != groups)
            {
                self.group_pairs.push(GroupPair {
                    groups,
                    quad_pairs: next..next,
                });
            }
            let group_pair = self.group_pairs.len() - 1;
            let range = &mut self.group_pairs[group_pair].quad_pairs;
            if range.start == range.end || self.quad_pairs.last() != Some(&quads) {
                self.quad_pairs.push(quads);
                let starts = [quad_a, quad_b].map(|quad| self.quads[quad].start);
                self.quad_starts.push(starts);
                self.thresholds.push([[f32::NEG_INFINITY; QUAD]; QUAD]);
                range.end += 1;
            }
            let row = a - usize::from(self.quads[quad_a].start);
            let column = b - usize::from(self.quads[quad_b].start);
            let touching = self.reach[a] + self.reach[b];
            if touching > 0.0 {
                let last = self.thresholds.len() - 1;
                self.thresholds[last][row][column] = 0.5 * touching * touching + margin;
            }
        }
    }
}

/// For each of `count` things, which range holds it.
fn owners(ranges: &[Range<u16>], count: usize) -> Vec<usize> {
    let mut owners = vec![0; count];
    for (owner, range) in ranges.iter().enumerate() {
        owners[usize::from(range.start)..usize::from(range.end)].fill(owner);
    }
    owners
}

/// A bound on the rounding errors of half a squared distance, computed as a difference of squares:
/// no touching pair is missed. What is found beyond is measured exactly.
fn margin(body: &SphereBody) -> f32 {
    let mut from_root = [0.0; Joint::COUNT];
    from_root[0] = body.rest_joints[0].length();
    for joint in &Joint::ALL[1..] {
        if let Some(parent) = joint.parent().map(Joint::index) {
            let bone = body.rest_joints[joint.index()] - body.rest_joints[parent];
            from_root[joint.index()] = from_root[parent] + bone.length();
        }
    }
    let farthest = body
        .centres
        .iter()
        .zip(&body.blend_weights)
        .flat_map(|(centre, row)| {
            row.iter().map(|&(joint, _)| {
                let joint = usize::from(joint);
                from_root[joint] + centre.distance(body.rest_joints[joint])
            })
        });
    let farthest = farthest.fold(0.0, f32::max);
    8.0 * f32::EPSILON * farthest * farthest
}

fn offsets(body: &SphereBody) -> [[f32; 3]; Joint::COUNT] {
    Joint::ALL.map(|joint| {
        let parent = joint.parent();
        let from = parent.map_or(Vec3::ZERO, |parent| body.rest_joints[parent.index()]);
        (body.rest_joints[joint.index()] - from).to_array()
    })
}
