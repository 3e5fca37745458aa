//! Nearest triangles through a tree of boxes.

use glam::Vec3;
use multiversion::multiversion;

use super::faces::{Face, Lanes, Packet};
use super::{LANES, NearestSurface};
use crate::Triangles;

/// Most triangles of a leaf.
const LEAF: usize = 4;
/// Deeper than any balanced tree of 2^31 triangles.
const DEEPEST: usize = 40;

/// A balanced binary tree over the triangles; nodes lie in pre-order.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    faces: Vec<Face>,
    /// The mesh's number of each face.
    triangles: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    least: Vec3,
    most: Vec3,
    /// First face of a leaf; place of the right child otherwise, the left one follows its parent.
    next: u32,
    /// Faces of a leaf, 0 for an inner node.
    count: u32,
}

impl Tree {
    /// From at least one triangle.
    pub(super) fn build(triangles: &Triangles, positions: &[Vec3]) -> Self {
        let corners = |triangle: u32| {
            triangles.corners()[triangle as usize].map(|vertex| positions[vertex as usize])
        };
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let centroids: Vec<Vec3> = order
            .iter()
            .map(|&triangle| corners(triangle).iter().sum::<Vec3>() / 3.0)
            .collect();
        let mut nodes = Vec::new();
        split(&mut nodes, &mut order, 0, &centroids, &corners);
        Self {
            nodes,
            faces: order.iter().map(|&t| Face::new(corners(t))).collect(),
            triangles: order,
        }
    }

    /// Unsigned distances and nearest triangles; both slices are of one length.
    pub(super) fn fill(&self, points: &[Vec3], nearest: &mut [NearestSurface]) {
        // The last packet's nearest face bounds the next one's search: neighbours are near.
        let mut guess = 0;
        for (points, nearest) in points.chunks(LANES).zip(nearest.chunks_mut(LANES)) {
            let packet = Packet::of(points);
            let (squares, faces) = search(&self.nodes, &self.faces, &packet, guess);
            for ((nearest, square), face) in nearest.iter_mut().zip(squares).zip(faces) {
                nearest.signed_distance = square.sqrt();
                nearest.triangle = self.triangles[face as usize];
            }
            guess = faces[LANES - 1];
        }
    }
}

/// Appends the subtree of `order`, whose first face is number `first`.
fn split(
    nodes: &mut Vec<Node>,
    order: &mut [u32],
    first: u32,
    centroids: &[Vec3],
    corners: &impl Fn(u32) -> [Vec3; 3],
) {
    let place = nodes.len();
    let (mut least, mut most) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (mut least_centroid, mut most_centroid) = (least, most);
    for &triangle in &*order {
        for corner in corners(triangle) {
            (least, most) = (least.min(corner), most.max(corner));
        }
        let centroid = centroids[triangle as usize];
        least_centroid = least_centroid.min(centroid);
        most_centroid = most_centroid.max(centroid);
    }
    nodes.push(Node {
        least,
        most,
        next: first,
        count: order.len() as u32,
    });
    if order.len() <= LEAF {
        return;
    }
    let axis = (most_centroid - least_centroid).max_position();
    let middle = order.len().div_ceil(2);
    order.select_nth_unstable_by(middle, |&a, &b| {
        let along = |triangle: u32| centroids[triangle as usize][axis];
        along(a).total_cmp(&along(b)).then(a.cmp(&b))
    });
    let (left, right) = order.split_at_mut(middle);
    split(nodes, left, first, centroids, corners);
    nodes[place].next = nodes.len() as u32;
    nodes[place].count = 0;
    split(nodes, right, first + middle as u32, centroids, corners);
}

/// Squared distance to, and number of, the nearest face of every point.
#[multiversion(targets = "simd")]
fn search(nodes: &[Node], faces: &[Face], points: &Packet, guess: u32) -> (Lanes, [u32; LANES]) {
    let mut squares = faces[guess as usize].squared_distances(points);
    let mut nearest = [guess; LANES];
    let mut waiting = [(0_u32, 0.0_f32); DEEPEST];
    let mut count = 1;
    while count > 0 {
        count -= 1;
        let (place, bound) = waiting[count];
        if squares.iter().all(|&square| bound >= square) {
            continue;
        }
        let node = &nodes[place as usize];
        if node.count > 0 {
            let range = node.next as usize..(node.next + node.count) as usize;
            let found = search_leaf(&faces[range], node.next, points, (squares, nearest));
            (squares, nearest) = found;
            continue;
        }
        let children = [place + 1, node.next];
        let [left, right] = children.map(|child| visit(&nodes[child as usize], points, &squares));
        // The nearer child is taken from the pile first.
        let [far, near] = if left < right {
            [(children[1], right), (children[0], left)]
        } else {
            [(children[0], left), (children[1], right)]
        };
        for child in [far, near] {
            if child.1 < f32::INFINITY {
                waiting[count] = child;
                count += 1;
            }
        }
    }
    (squares, nearest)
}

/// Takes nearer faces of a leaf. Whole arrays go in and out, so that they stay in registers.
#[inline(always)]
fn search_leaf(
    faces: &[Face],
    first: u32,
    points: &Packet,
    (mut squares, mut nearest): (Lanes, [u32; LANES]),
) -> (Lanes, [u32; LANES]) {
    for (number, face) in (first..).zip(faces) {
        let found = face.squared_distances(points);
        for lane in 0..LANES {
            let nearer = found[lane] < squares[lane];
            nearest[lane] = if nearer { number } else { nearest[lane] };
            squares[lane] = if nearer { found[lane] } else { squares[lane] };
        }
    }
    (squares, nearest)
}

/// The least squared distance to the box of those points that it could serve; infinite if there
/// are none.
#[inline(always)]
fn visit(node: &Node, points: &Packet, squares: &Lanes) -> f32 {
    let (least, most) = (node.least, node.most);
    let mut bounds = [0.0_f32; LANES];
    for (lane, bound) in bounds.iter_mut().enumerate() {
        let (x, y, z) = (points.x[lane], points.y[lane], points.z[lane]);
        let dx = (least.x - x).max(x - most.x).max(0.0);
        let dy = (least.y - y).max(y - most.y).max(0.0);
        let dz = (least.z - z).max(z - most.z).max(0.0);
        let square = dx * dx + dy * dy + dz * dz;
        *bound = if square < squares[lane] {
            square
        } else {
            f32::INFINITY
        };
    }
    // Halves: a minimum of floats in list order does not vectorise.
    let mut width = LANES / 2;
    while width > 0 {
        for lane in 0..width {
            let (a, b) = (bounds[lane], bounds[lane + width]);
            bounds[lane] = if a < b { a } else { b };
        }
        width /= 2;
    }
    bounds[0]
}
