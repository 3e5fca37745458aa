//! Three-vectors and 3 x 3 matrices of lanes, matrices row by row.

use super::workspace::Transform;
use crate::lanes::{Lanes, Simd};

/// The same vector in all lanes.
#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, vector: [f32; 3]) -> [S::Lanes; 3] {
    let [x, y, z] = vector;
    [simd.splat(x), simd.splat(y), simd.splat(z)]
}

#[inline(always)]
pub(super) fn add<L: Lanes>(a: [L; 3], b: [L; 3]) -> [L; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(super) fn subtract<L: Lanes>(a: [L; 3], b: [L; 3]) -> [L; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn scale<L: Lanes>(a: [L; 3], factor: L) -> [L; 3] {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}

#[inline(always)]
pub(super) fn dot<L: Lanes>(a: [L; 3], b: [L; 3]) -> L {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

#[inline(always)]
pub(super) fn cross<L: Lanes>([ax, ay, az]: [L; 3], [bx, by, bz]: [L; 3]) -> [L; 3] {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

/// The rotation of a joint's transform.
#[inline(always)]
pub(super) fn rotation<L: Lanes>(transform: &Transform<L>) -> [L; 9] {
    let [a, b, c, d, e, f, g, h, i, ..] = *transform;
    [a, b, c, d, e, f, g, h, i]
}

#[inline(always)]
pub(super) fn transpose<L: Lanes>([a, b, c, d, e, f, g, h, i]: &[L; 9]) -> [L; 9] {
    [*a, *d, *g, *b, *e, *h, *c, *f, *i]
}

#[inline(always)]
pub(super) fn add_to<L: Lanes>(sum: &mut [L; 9], matrix: &[L; 9]) {
    for place in 0..9 {
        sum[place] = sum[place] + matrix[place];
    }
}

/// A v.
#[inline(always)]
pub(super) fn multiply<L: Lanes>([a, b, c, d, e, f, g, h, i]: &[L; 9], v: [L; 3]) -> [L; 3] {
    [
        dot([*a, *b, *c], v),
        dot([*d, *e, *f], v),
        dot([*g, *h, *i], v),
    ]
}

/// A B.
#[inline(always)]
pub(super) fn product<L: Lanes>(a: &[L; 9], b: &[L; 9]) -> [L; 9] {
    let mut product = *a;
    for row in 0..3 {
        let left = [a[3 * row], a[3 * row + 1], a[3 * row + 2]];
        for column in 0..3 {
            product[3 * row + column] = dot(left, [b[column], b[3 + column], b[6 + column]]);
        }
    }
    product
}

/// a b^T.
#[inline(always)]
pub(super) fn outer<L: Lanes>(a: [L; 3], b: [L; 3]) -> [L; 9] {
    let [[r, s, t], [u, v, w], [x, y, z]] = [scale(b, a[0]), scale(b, a[1]), scale(b, a[2])];
    [r, s, t, u, v, w, x, y, z]
}
