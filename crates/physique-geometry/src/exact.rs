//! Do two triangles meet? Answered without rounding, by the signs of determinants that the `robust`
//! crate (Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates", 1997) evaluates exactly.
//!
//! Triangles and segments are closed sets: touching in a single point counts. Degenerate triangles
//! (three points on a line, or fewer than three different points) are the segments or points that they
//! are.

use glam::Vec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

type Triangle = [Vec3; 3];
type Segment = [Vec3; 2];

/// Whether two closed triangles have a point in common, exactly.
///
/// Positions must be finite and below 1e37 m.
///
/// ```
/// use glam::Vec3;
/// use physique_geometry::exact::triangles_meet;
///
/// let floor = [Vec3::ZERO, Vec3::X, Vec3::Z];
/// // Its tip touches the floor's edge; lifted by the least number there is, it does not.
/// let tip = Vec3::new(0.5, 0.0, 0.0);
/// let spike = |lift: f32| [tip + Vec3::Y * lift, Vec3::new(0.0, 1.0, 0.0), Vec3::new(1.0, 1.0, 0.0)];
/// assert!(triangles_meet(floor, spike(0.0)));
/// assert!(!triangles_meet(floor, spike(1e-45)));
/// ```
#[must_use]
pub fn triangles_meet(a: Triangle, b: Triangle) -> bool {
    if same_side(a, b) || same_side(b, a) {
        return false;
    }
    // If two convex sets meet, an edge of one meets the other; that includes one lying inside the
    // other. A degenerate triangle is its edges.
    edges(a).iter().any(|&edge| segment_meets_triangle(edge, b))
        || edges(b).iter().any(|&edge| segment_meets_triangle(edge, a))
        || edges(a)
            .iter()
            .any(|&p| edges(b).iter().any(|&q| segments_meet(p, q)))
}

/// Whether two triangles that share the single corner `a[0] == b[0]` meet anywhere else.
#[must_use]
pub(crate) fn meet_beyond_corner(a: Triangle, b: Triangle) -> bool {
    segment_meets_triangle([a[1], a[2]], b) || segment_meets_triangle([b[1], b[2]], a)
}

/// Whether two triangles that share the edge from `a[0] == b[0]` to `a[1] == b[1]` meet anywhere else:
/// if they lie in one plane, on the same side of the edge.
#[must_use]
pub(crate) fn meet_beyond_edge(a: Triangle, b: Triangle) -> bool {
    let [p, q, r] = a;
    let s = b[2];
    if side(a, s) != 0.0 {
        return false;
    }
    // The plane seen along the axes that show it as more than a line.
    let sides = Projection::ALL.map(|view| (view.side(p, q, r), view.side(p, q, s)));
    sides
        .iter()
        .any(|&(of_r, of_s)| (of_r > 0.0 && of_s > 0.0) || (of_r < 0.0 && of_s < 0.0))
}

/// Whether all of `b` lies strictly on one side of the plane of `a`.
fn same_side(a: Triangle, b: Triangle) -> bool {
    let sides = b.map(|corner| side(a, corner));
    sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
}

/// Whether a closed segment and a closed triangle that is not degenerate have a point in common. Of a
/// degenerate triangle: never.
fn segment_meets_triangle([p, q]: Segment, triangle: Triangle) -> bool {
    let (of_p, of_q) = (side(triangle, p), side(triangle, q));
    if (of_p > 0.0 && of_q > 0.0) || (of_p < 0.0 && of_q < 0.0) {
        return false;
    }
    if of_p == 0.0 && of_q == 0.0 {
        return coplanar_segment_meets_triangle([p, q], triangle);
    }
    // The segment's line crosses the plane in one point: does it turn the same way around all edges?
    let turns = edges(triangle).map(|[from, to]| side([p, q, from], to));
    turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0)
}

fn coplanar_segment_meets_triangle([p, q]: Segment, triangle: Triangle) -> bool {
    let [a, b, c] = triangle;
    let Some(view) = Projection::ALL
        .into_iter()
        .find(|view| view.side(a, b, c) != 0.0)
    else {
        return false;
    };
    let inside = |point: Vec3| {
        let sides = edges(triangle).map(|[from, to]| view.side(from, to, point));
        sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
    };
    inside(p)
        || edges(triangle)
            .iter()
            .any(|&edge| view.segments_meet([p, q], edge))
}

/// Whether two closed segments have a point in common. Either may be a single point.
fn segments_meet(first: Segment, second: Segment) -> bool {
    let ([p, q], [r, s]) = (first, second);
    if side([p, q, r], s) != 0.0 {
        return false;
    }
    // They lie in a plane; a view that shows it as more than a line shows whether they meet.
    let flat = |view: &Projection| {
        [[p, q, r], [p, q, s], [r, s, p], [r, s, q]]
            .iter()
            .any(|&[a, b, c]| view.side(a, b, c) != 0.0)
    };
    match Projection::ALL.into_iter().find(flat) {
        Some(view) => view.segments_meet(first, second),
        // All four points on one line: their ranges overlap on every axis.
        None => (p.min(q).cmple(r.max(s)) & r.min(s).cmple(p.max(q))).all(),
    }
}

fn edges([a, b, c]: Triangle) -> [Segment; 3] {
    [[a, b], [b, c], [c, a]]
}

/// On which side of the plane through three points a fourth lies: the sign is exact.
fn side([a, b, c]: Triangle, point: Vec3) -> f64 {
    let coord = |p: Vec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    orient3d(coord(a), coord(b), coord(c), coord(point))
}

/// A view along one of the axes.
#[derive(Debug, Clone, Copy)]
enum Projection {
    AlongX,
    AlongY,
    AlongZ,
}

impl Projection {
    const ALL: [Self; 3] = [Self::AlongX, Self::AlongY, Self::AlongZ];

    /// On which side of the line from `a` to `b` a third point is seen: the sign is exact.
    fn side(self, a: Vec3, b: Vec3, point: Vec3) -> f64 {
        let coord = |p: Vec3| match self {
            Self::AlongX => Coord { x: p.y, y: p.z },
            Self::AlongY => Coord { x: p.z, y: p.x },
            Self::AlongZ => Coord { x: p.x, y: p.y },
        };
        orient2d(coord(a), coord(b), coord(point))
    }

    /// Whether two closed segments meet in this view.
    fn segments_meet(self, [p, q]: Segment, [r, s]: Segment) -> bool {
        let (of_p, of_q) = (self.side(r, s, p), self.side(r, s, q));
        let (of_r, of_s) = (self.side(p, q, r), self.side(p, q, s));
        let apart = |x: f64, y: f64| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
        if apart(of_p, of_q) && apart(of_r, of_s) {
            return true;
        }
        // An end on the other segment's line: is it on the segment?
        (of_p == 0.0 && self.between(r, s, p))
            || (of_q == 0.0 && self.between(r, s, q))
            || (of_r == 0.0 && self.between(p, q, r))
            || (of_s == 0.0 && self.between(p, q, s))
    }

    /// Whether a point on the line of a segment lies within its box.
    fn between(self, a: Vec3, b: Vec3, point: Vec3) -> bool {
        let within = a.min(b).cmple(point) & point.cmple(a.max(b));
        match self {
            Self::AlongX => within.test(1) && within.test(2),
            Self::AlongY => within.test(2) && within.test(0),
            Self::AlongZ => within.test(0) && within.test(1),
        }
    }
}
