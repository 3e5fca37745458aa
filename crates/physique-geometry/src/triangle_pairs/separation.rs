//! Proofs that triangles do not meet, one triangle against sixteen, in single precision.
//!
//! A plane separates two triangles if all corners of one lie strictly on one side of it and all
//! corners of the other do not. Tried are the planes of both triangles, and the planes upright on
//! their edges (which tell neighbours on a nearly flat surface apart). A corner counts as on one side
//! only if its distance exceeds the greatest possible rounding error, so that no pair is rejected
//! wrongly.
//!
//! Corners that both triangles share lie on both sides of everything; they are disregarded as long as
//! the other triangle touches the plane only with what is shared.

use super::lanes::Vector;
use super::leaf::{ALL_LANES, Lanes, Leaf};
use super::tree::Aabb;

/// Rounding error of a product of differences of `f32` numbers, relative to the product of the
/// vectors' lengths as sums of absolute coordinates. Each term of the sum passes at most through
/// eleven roundings of 2^-24 each (upright planes: four differences, three products, two differences
/// and two sums); 2^-20 is sixteen.
pub(super) const RELATIVE_ERROR: f32 = 1.0 / (1 << 20) as f32;
/// Added to every error: products too small for `f32` are lost in full.
const LEAST_ERROR: f32 = 1e-30;

/// Sixteen triangles, or sixteen times the same one.
struct Faces<V> {
    /// By corner, then by axis.
    corners: [[V; 3]; 3],
    normal: [V; 3],
    slack: V,
}

impl<V: Vector> Faces<V> {
    #[inline(always)]
    fn one(leaf: &Leaf, lane: usize) -> Self {
        Self::each(leaf, |lanes| V::splat(lanes[lane]))
    }

    #[inline(always)]
    fn all(leaf: &Leaf) -> Self {
        Self::each(leaf, V::load)
    }

    /// Spelled out: `array::map` is no place for vectors, it is compiled without their instructions.
    #[inline(always)]
    fn each(leaf: &Leaf, take: impl Fn(&Lanes) -> V) -> Self {
        let Leaf {
            corners: [a, b, c],
            normal: n,
            slack,
            ..
        } = leaf;
        Self {
            corners: [
                [take(&a[0]), take(&a[1]), take(&a[2])],
                [take(&b[0]), take(&b[1]), take(&b[2])],
                [take(&c[0]), take(&c[1]), take(&c[2])],
            ],
            normal: [take(&n[0]), take(&n[1]), take(&n[2])],
            slack: take(slack),
        }
    }

    /// Where the plane of `self` has all of `other` strictly on one side; `shared` are the corners of
    /// `other` to disregard.
    #[inline(always)]
    fn apart_by_plane(&self, other: &Self, shared: [u32; 3]) -> u32 {
        let (mut above, mut below) = (ALL_LANES, ALL_LANES);
        for (corner, shared) in other.corners.iter().zip(shared) {
            let offset = sub(*corner, self.corners[0]);
            let distance = dot(self.normal, offset);
            let error = self.slack.mul(length(offset)).add(V::splat(LEAST_ERROR));
            above &= distance.greater(error) | shared;
            below &= V::splat(0.0).sub(distance).greater(error) | shared;
        }
        above | below
    }

    /// Where an edge of `self` has all of `other` strictly outside, seen in the plane of `self`;
    /// `shared(edge, corner)` are the corners of `other` that lie on that edge.
    #[inline(always)]
    fn apart_by_edges(&self, other: &Self, shared: impl Fn(usize, usize) -> u32) -> u32 {
        let mut apart = 0;
        for edge in 0..3 {
            let along = sub(self.corners[(edge + 1) % 3], self.corners[edge]);
            let outwards = cross(along, self.normal);
            let slack = self.slack.mul(length(along));
            let mut outside = ALL_LANES;
            for corner in 0..3 {
                let offset = sub(other.corners[corner], self.corners[edge]);
                let error = slack.mul(length(offset)).add(V::splat(LEAST_ERROR));
                outside &= dot(outwards, offset).greater(error) | shared(edge, corner);
            }
            apart |= outside;
        }
        apart
    }
}

/// Which corners are the same vertex: by corner of the one, then of the others.
struct Shared([[u32; 3]; 3]);

impl Shared {
    #[inline(always)]
    fn between<V: Vector>(one: &Leaf, lane: usize, leaf: &Leaf) -> Self {
        let mut same = [[0; 3]; 3];
        for (row, vertices) in same.iter_mut().zip(&one.vertices) {
            for (mask, theirs) in row.iter_mut().zip(&leaf.vertices) {
                *mask = V::equal(theirs, vertices[lane]);
            }
        }
        Self(same)
    }

    /// By corner of the one: which others have it.
    #[inline(always)]
    fn of_one(&self) -> [u32; 3] {
        let [a, b, c] = self.0;
        [a[0] | a[1] | a[2], b[0] | b[1] | b[2], c[0] | c[1] | c[2]]
    }

    /// By corner of the others: which of them share it.
    #[inline(always)]
    fn of_others(&self) -> [u32; 3] {
        let [a, b, c] = self.0;
        [a[0] | b[0] | c[0], a[1] | b[1] | c[1], a[2] | b[2] | c[2]]
    }

    #[inline(always)]
    fn any(&self) -> u32 {
        let [a, b, c] = self.of_one();
        a | b | c
    }
}

/// Bit mask of the triangles of `leaf` whose box overlaps this one.
#[inline(always)]
pub(super) fn overlapping<V: Vector>(bounds: &Aabb, leaf: &Leaf) -> u32 {
    let mut apart = 0;
    for axis in 0..3 {
        apart |= V::load(&leaf.least[axis]).greater(V::splat(bounds.most[axis]));
        apart |= V::splat(bounds.least[axis]).greater(V::load(&leaf.most[axis]));
    }
    !apart & ALL_LANES
}

/// Of the `candidates` among the triangles of `leaf`, those that nothing proves apart from triangle
/// `lane` of `one`. Those that share a vertex with it are dropped if `skip_shared`.
#[inline(always)]
pub(super) fn unseparated<V: Vector>(
    one: &Leaf,
    lane: usize,
    leaf: &Leaf,
    skip_shared: bool,
    mut candidates: u32,
) -> u32 {
    let shared = Shared::between::<V>(one, lane, leaf);
    if skip_shared {
        candidates &= !shared.any();
    }
    if candidates == 0 {
        return 0;
    }
    let (a, b) = (Faces::<V>::one(one, lane), Faces::<V>::all(leaf));
    candidates &= !a.apart_by_plane(&b, shared.of_others());
    candidates &= !b.apart_by_plane(&a, shared.of_one());
    let Shared(same) = shared;
    if candidates == 0 {
        return 0;
    }
    candidates &= !a.apart_by_edges(&b, |edge, corner| {
        same[edge][corner] | same[(edge + 1) % 3][corner]
    });
    candidates
        & !b.apart_by_edges(&a, |edge, corner| {
            same[corner][edge] | same[corner][(edge + 1) % 3]
        })
}

#[inline(always)]
fn sub<V: Vector>(a: [V; 3], b: [V; 3]) -> [V; 3] {
    [a[0].sub(b[0]), a[1].sub(b[1]), a[2].sub(b[2])]
}

#[inline(always)]
fn dot<V: Vector>(a: [V; 3], b: [V; 3]) -> V {
    a[0].mul(b[0]).add(a[1].mul(b[1])).add(a[2].mul(b[2]))
}

#[inline(always)]
fn cross<V: Vector>(a: [V; 3], b: [V; 3]) -> [V; 3] {
    let component = |k: usize, l: usize| a[k].mul(b[l]).sub(a[l].mul(b[k]));
    [component(1, 2), component(2, 0), component(0, 1)]
}

/// Sum of the absolute coordinates.
#[inline(always)]
fn length<V: Vector>(a: [V; 3]) -> V {
    a[0].abs().add(a[1].abs()).add(a[2].abs())
}
