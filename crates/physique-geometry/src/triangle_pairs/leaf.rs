//! Sixteen triangles side by side, and the tests of one triangle against all of them.

#![expect(
    clippy::needless_range_loop,
    reason = "lane by lane, in step over several arrays"
)]

use glam::Vec3;
use multiversion::multiversion;

use super::SharedVertices;
use super::tree::Aabb;
use crate::Triangles;
use crate::exact;

/// Triangles a leaf: the `f32` lanes of the widest vectors.
pub(super) const LANES: usize = 16;

const ALL_LANES: u32 = (1 << LANES) - 1;

/// One number a triangle.
type Lanes = [f32; LANES];
/// Names no vertex: unused lanes share vertices with nothing.
const NO_VERTEX: u32 = u32::MAX;

/// Triangles as structure of arrays.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Leaf {
    count: usize,
    triangles: [u32; LANES],
    /// The vertices at every corner.
    vertices: [[u32; LANES]; 3],
    /// By corner, then by axis.
    corners: [[Lanes; 3]; 3],
    /// Boxes; empty in unused lanes.
    least: [Lanes; 3],
    most: [Lanes; 3],
    /// Normals, twice the area long.
    normal: [Lanes; 3],
    /// How wrong the distance of a point to the plane (times the normal's length) may be, over the
    /// point's distance to the first corner.
    slack: Lanes,
}

impl Leaf {
    /// Leaves for triangles in this order, not yet fitted to any pose.
    pub(super) fn fill(triangles: &Triangles, order: &[u32]) -> Vec<Self> {
        let fill = |chunk: &[u32]| {
            let mut leaf = Self::empty();
            leaf.count = chunk.len();
            for (lane, &triangle) in chunk.iter().enumerate() {
                leaf.triangles[lane] = triangle;
                for (corner, &vertex) in triangles.corners()[triangle as usize].iter().enumerate() {
                    leaf.vertices[corner][lane] = vertex;
                }
            }
            leaf
        };
        order.chunks(LANES).map(fill).collect()
    }

    fn empty() -> Self {
        Self {
            count: 0,
            triangles: [0; LANES],
            vertices: [[NO_VERTEX; LANES]; 3],
            corners: [[[0.0; LANES]; 3]; 3],
            least: [[f32::INFINITY; LANES]; 3],
            most: [[f32::NEG_INFINITY; LANES]; 3],
            normal: [[0.0; LANES]; 3],
            slack: [0.0; LANES],
        }
    }

    /// Takes over a pose.
    pub(super) fn refit(&mut self, positions: &[Vec3]) {
        for corner in 0..3 {
            for lane in 0..self.count {
                let position = positions[self.vertices[corner][lane] as usize];
                for axis in 0..3 {
                    self.corners[corner][axis][lane] = position[axis];
                }
            }
        }
        let [a, b, c] = &self.corners;
        for axis in 0..3 {
            for lane in 0..self.count {
                let (a, b, c) = (a[axis][lane], b[axis][lane], c[axis][lane]);
                self.least[axis][lane] = a.min(b).min(c);
                self.most[axis][lane] = a.max(b).max(c);
            }
        }
        for lane in 0..LANES {
            let u = [0, 1, 2].map(|axis| b[axis][lane] - a[axis][lane]);
            let v = [0, 1, 2].map(|axis| c[axis][lane] - a[axis][lane]);
            self.normal[0][lane] = u[1] * v[2] - u[2] * v[1];
            self.normal[1][lane] = u[2] * v[0] - u[0] * v[2];
            self.normal[2][lane] = u[0] * v[1] - u[1] * v[0];
            self.slack[lane] = RELATIVE_ERROR * length(u) * length(v);
        }
    }

    /// The box around all its triangles.
    pub(super) fn bounds(&self) -> Aabb {
        let least = |axis: usize| {
            self.least[axis]
                .iter()
                .copied()
                .fold(f32::INFINITY, f32::min)
        };
        let most = |axis: usize| {
            self.most[axis]
                .iter()
                .copied()
                .fold(f32::NEG_INFINITY, f32::max)
        };
        Aabb {
            least: Vec3::new(least(0), least(1), least(2)),
            most: Vec3::new(most(0), most(1), most(2)),
        }
    }

    fn triangle(&self, lane: usize) -> [Vec3; 3] {
        self.corners
            .map(|[x, y, z]| Vec3::new(x[lane], y[lane], z[lane]))
    }

    fn vertices(&self, lane: usize) -> [u32; 3] {
        self.vertices.map(|corner| corner[lane])
    }

    fn bounds_of(&self, lane: usize) -> Aabb {
        let vector = |lanes: &[Lanes; 3]| Vec3::new(lanes[0][lane], lanes[1][lane], lanes[2][lane]);
        Aabb {
            least: vector(&self.least),
            most: vector(&self.most),
        }
    }
}

/// Rounding error of a triple product of differences of `f32` numbers, relative to the product of
/// the three vectors' lengths as sums of absolute coordinates. Each of the six terms of the triple
/// product passes through eight roundings (three differences, a product, a difference, a product and
/// two sums) of 2^-24 each; 2^-20 leaves a factor of two.
const RELATIVE_ERROR: f32 = 1.0 / (1 << 20) as f32;
/// Added to every slack: products too small for `f32` are lost in full.
const LEAST_SLACK: f32 = 1e-30;

/// Sum of the absolute coordinates.
#[inline(always)]
fn length([x, y, z]: [f32; 3]) -> f32 {
    x.abs() + y.abs() + z.abs()
}

/// Appends all intersecting pairs between two leaves (or within one).
#[multiversion(targets = "simd")]
pub(super) fn find_pairs(
    first: &Leaf,
    second: &Leaf,
    same: bool,
    box_of_second: &Aabb,
    shared_vertices: SharedVertices,
    pairs: &mut Vec<(u32, u32)>,
) {
    for lane in 0..first.count {
        if !first.bounds_of(lane).overlaps(box_of_second) {
            continue;
        }
        // Within one leaf, every pair once.
        let later = if same {
            u32::MAX << (lane + 1)
        } else {
            u32::MAX
        };
        let mut candidates = overlapping(first, lane, second) & later;
        if candidates == 0 {
            continue;
        }
        candidates &= unseparated(first, lane, second, shared_vertices);
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

/// Bit mask of the triangles of `leaf` whose box overlaps that of triangle `lane` of `one`.
#[inline(always)]
fn overlapping(one: &Leaf, lane: usize, leaf: &Leaf) -> u32 {
    let mut overlaps = [true; LANES];
    for axis in 0..3 {
        let (least, most) = (one.least[axis][lane], one.most[axis][lane]);
        for other in 0..LANES {
            overlaps[other] &=
                (leaf.least[axis][other] <= most) & (least <= leaf.most[axis][other]);
        }
    }
    mask(overlaps)
}

/// Bit mask of the triangles of `leaf` that the planes of both triangles do not prove apart from
/// triangle `lane` of `one`: corners that both share are disregarded. Pairs that share a vertex are
/// left out if so asked.
#[inline(always)]
fn unseparated(one: &Leaf, lane: usize, leaf: &Leaf, shared_vertices: SharedVertices) -> u32 {
    // Which corners are shared, of the one and of the others.
    let mut shared_of_one = [[false; LANES]; 3];
    let mut shared_of_others = [[false; LANES]; 3];
    for mine in 0..3 {
        let vertex = one.vertices[mine][lane];
        for theirs in 0..3 {
            for other in 0..LANES {
                let shared = leaf.vertices[theirs][other] == vertex;
                shared_of_one[mine][other] |= shared;
                shared_of_others[theirs][other] |= shared;
            }
        }
    }

    let mut apart = [false; LANES];
    // The others' corners over the plane of the one.
    let (mut above, mut below) = ([true; LANES], [true; LANES]);
    for corner in 0..3 {
        for other in 0..LANES {
            let point = [0, 1, 2].map(|axis| leaf.corners[corner][axis][other]);
            let (is_above, is_below) = sides(one, lane, point);
            above[other] &= is_above | shared_of_others[corner][other];
            below[other] &= is_below | shared_of_others[corner][other];
        }
    }
    for other in 0..LANES {
        apart[other] |= above[other] | below[other];
    }
    // The one's corners over the planes of the others.
    let (mut above, mut below) = ([true; LANES], [true; LANES]);
    for corner in 0..3 {
        let point = [0, 1, 2].map(|axis| one.corners[corner][axis][lane]);
        for other in 0..LANES {
            let (is_above, is_below) = sides(leaf, other, point);
            above[other] &= is_above | shared_of_one[corner][other];
            below[other] &= is_below | shared_of_one[corner][other];
        }
    }
    for other in 0..LANES {
        apart[other] |= above[other] | below[other];
    }
    if shared_vertices == SharedVertices::Skip {
        for other in 0..LANES {
            apart[other] |=
                shared_of_one[0][other] | shared_of_one[1][other] | shared_of_one[2][other];
        }
    }
    !mask(apart) & ALL_LANES
}

/// Whether a point is surely above, and surely below, the plane of a triangle.
#[inline(always)]
fn sides(leaf: &Leaf, lane: usize, point: [f32; 3]) -> (bool, bool) {
    let offset = [0, 1, 2].map(|axis| point[axis] - leaf.corners[0][axis][lane]);
    let distance = offset[0] * leaf.normal[0][lane]
        + offset[1] * leaf.normal[1][lane]
        + offset[2] * leaf.normal[2][lane];
    let slack = leaf.slack[lane] * length(offset) + LEAST_SLACK;
    (distance > slack, distance < -slack)
}

/// Bit k is element k.
#[inline(always)]
fn mask(lanes: [bool; LANES]) -> u32 {
    let mut mask = 0;
    for (lane, &set) in lanes.iter().enumerate() {
        mask |= u32::from(set) << lane;
    }
    mask
}

/// Whether two triangles meet, beyond what they share if they share vertices. Exact.
#[cold]
#[inline(never)]
fn intersect(first: &Leaf, lane: usize, second: &Leaf, other: usize) -> bool {
    let (a, b) = (first.vertices(lane), second.vertices(other));
    let (mut p, mut q) = (first.triangle(lane), second.triangle(other));
    let shared = |corner: &usize| b.contains(&a[*corner]);
    let shared_corners = [0, 1, 2].into_iter().filter(shared).count();
    match shared_corners {
        0 => exact::triangles_meet(p, q),
        1 => {
            // The shared corner first in both.
            let mine = (0..3).find(|&k| b.contains(&a[k])).unwrap_or(0);
            let theirs = (0..3).find(|&k| a.contains(&b[k])).unwrap_or(0);
            p.rotate_left(mine);
            q.rotate_left(theirs);
            exact::meet_beyond_corner(p, q)
        }
        2 => {
            // The corner that is not shared last in both, the shared ones in the same order.
            let mine = (0..3).find(|&k| !b.contains(&a[k])).unwrap_or(0);
            let theirs = (0..3).find(|&k| !a.contains(&b[k])).unwrap_or(0);
            p.rotate_left((mine + 1) % 3);
            q.rotate_left((theirs + 1) % 3);
            exact::meet_beyond_edge(p, [p[0], p[1], q[2]])
        }
        // The same three vertices: one lies on the other.
        _ => true,
    }
}
