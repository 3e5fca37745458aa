use glam::Vec3;

use super::leaf::{LANES, Leaf};
use crate::Triangles;

/// An axis-parallel box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Aabb {
    pub(super) least: Vec3,
    pub(super) most: Vec3,
}

impl Aabb {
    /// Contains nothing, overlaps nothing.
    pub(super) const EMPTY: Self = Self {
        least: Vec3::INFINITY,
        most: Vec3::NEG_INFINITY,
    };

    #[inline]
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        (self.least.cmple(other.most) & other.least.cmple(self.most)).all()
    }

    #[inline]
    fn union(&self, other: &Self) -> Self {
        Self {
            least: self.least.min(other.least),
            most: self.most.max(other.most),
        }
    }
}

/// A balanced binary tree over leaves in a fixed order. A node covers a range of leaves and its
/// children the halves of that range; nodes lie in pre-order: the left child follows its parent, the
/// right child follows the left one's `2 * leaves - 1` nodes. So the tree is nothing but its boxes.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    boxes: Vec<Aabb>,
    leaf_count: usize,
}

/// A node: its place in the boxes and the leaves that it covers.
#[derive(Debug, Clone, Copy)]
struct Node {
    place: usize,
    first_leaf: usize,
    leaf_count: usize,
}

impl Node {
    fn is_leaf(&self) -> bool {
        self.leaf_count == 1
    }

    fn children(&self) -> [Self; 2] {
        let left_count = self.leaf_count.div_ceil(2);
        let left = Self {
            place: self.place + 1,
            first_leaf: self.first_leaf,
            leaf_count: left_count,
        };
        let right = Self {
            place: self.place + 2 * left_count,
            first_leaf: self.first_leaf + left_count,
            leaf_count: self.leaf_count - left_count,
        };
        [left, right]
    }
}

impl Tree {
    /// Arranges the triangles so that neighbours in space become neighbours in the list; every
    /// [`LANES`] of them make a leaf.
    pub(super) fn build(triangles: &Triangles, positions: &[Vec3]) -> (Self, Vec<u32>) {
        let thirds = |corners: &[u32; 3]| corners.map(|v| positions[v as usize] / 3.0).iter().sum();
        let centroids: Vec<Vec3> = triangles.corners().iter().map(thirds).collect();
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let leaf_count = triangles.len().div_ceil(LANES);
        if leaf_count > 0 {
            arrange(&mut order, leaf_count, &centroids);
        }
        (
            Self {
                boxes: vec![Aabb::EMPTY; (2 * leaf_count).saturating_sub(1)],
                leaf_count,
            },
            order,
        )
    }

    fn root(&self) -> Option<Node> {
        (self.leaf_count > 0).then_some(Node {
            place: 0,
            first_leaf: 0,
            leaf_count: self.leaf_count,
        })
    }

    /// Takes over the boxes of refitted leaves.
    pub(super) fn refit(&mut self, leaves: &[Leaf]) {
        if let Some(root) = self.root() {
            self.refit_node(root, leaves);
        }
    }

    fn refit_node(&mut self, node: Node, leaves: &[Leaf]) -> Aabb {
        let bounds = if node.is_leaf() {
            leaves[node.first_leaf].bounds()
        } else {
            let [left, right] = node.children().map(|child| self.refit_node(child, leaves));
            left.union(&right)
        };
        self.boxes[node.place] = bounds;
        bounds
    }

    /// Calls `visit` for every unordered pair of leaves whose boxes overlap, and for every leaf with
    /// itself, with the box of the second.
    pub(super) fn visit_overlapping_leaves(&self, mut visit: impl FnMut(usize, usize, &Aabb)) {
        if let Some(root) = self.root() {
            self.visit_within(root, &mut visit);
        }
    }

    fn visit_within(&self, node: Node, visit: &mut impl FnMut(usize, usize, &Aabb)) {
        if node.is_leaf() {
            visit(node.first_leaf, node.first_leaf, &self.boxes[node.place]);
            return;
        }
        let [left, right] = node.children();
        self.visit_within(left, visit);
        self.visit_within(right, visit);
        self.visit_between(left, right, visit);
    }

    fn visit_between(&self, a: Node, b: Node, visit: &mut impl FnMut(usize, usize, &Aabb)) {
        if !self.boxes[a.place].overlaps(&self.boxes[b.place]) {
            return;
        }
        if a.is_leaf() && b.is_leaf() {
            visit(a.first_leaf, b.first_leaf, &self.boxes[b.place]);
        } else if a.leaf_count >= b.leaf_count {
            let [left, right] = a.children();
            self.visit_between(left, b, visit);
            self.visit_between(right, b, visit);
        } else {
            let [left, right] = b.children();
            self.visit_between(a, left, visit);
            self.visit_between(a, right, visit);
        }
    }
}

/// Sorts `order` so that both halves of a node's leaves are apart along its longest side.
fn arrange(order: &mut [u32], leaf_count: usize, centroids: &[Vec3]) {
    if leaf_count < 2 {
        return;
    }
    let (mut least, mut most) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for &triangle in order.iter() {
        least = least.min(centroids[triangle as usize]);
        most = most.max(centroids[triangle as usize]);
    }
    let axis = (most - least).max_position();
    let left_count = leaf_count.div_ceil(2);
    let split = left_count * LANES;
    let along = |&triangle: &u32| centroids[triangle as usize][axis];
    // Ties by number: the tree does not depend on how the selection is implemented.
    order.select_nth_unstable_by(split, |a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
    let (left, right) = order.split_at_mut(split);
    arrange(left, left_count, centroids);
    arrange(right, leaf_count - left_count, centroids);
}
