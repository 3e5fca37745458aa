//! Hot code here spells arrays out: `array::map` is compiled without the vector instructions of its
//! caller, and called.

use multiversion::multiversion;

use super::crossing::Crossing;
use super::snapped::{Cell, Snapped, SnappedVertices};
use crate::{Error, Triangles};

/// Scratch and result of drawing triangles onto the lattice.
#[derive(Debug, Clone, Default)]
pub(crate) struct Raster {
    /// Triangles whose box holds a line; all of the list is kept, only its beginning is valid.
    candidates: Vec<u32>,
    /// Lines of the crossings; the first `count` are valid.
    lines: Vec<u32>,
    /// The crossings; the first `count` are valid.
    crossings: Vec<Crossing>,
    count: usize,
}

impl Raster {
    /// Finds all crossings of `triangles` with `lines[0]` by `lines[1]` lines at multiples of 2^`BITS`
    /// subcells. Other lines, if any vertex lies that far out, are left alone.
    pub(crate) fn draw<const BITS: u32>(
        &mut self,
        triangles: &Triangles,
        snapped: &SnappedVertices,
        lines: [usize; 2],
        most_crossings: u64,
    ) -> Result<(), Error> {
        let (corners, vertices) = (triangles.corners(), &snapped.vertices);
        let lines = lines.map(|count| count as i32);
        self.candidates.resize(corners.len(), 0);
        let count = cull(corners, &snapped.cells, &mut self.candidates);
        let mesh = Candidates {
            triangles: &self.candidates[..count],
            corners,
            vertices,
        };
        let found = count_lines::<BITS>(mesh, lines);
        if found > most_crossings {
            return Err(Error::TooManyCrossings {
                found,
                limit: most_crossings,
            });
        }
        // One spare place: a rejected crossing is written and then overwritten.
        let room = found as usize + 1;
        if self.lines.len() < room {
            self.lines.resize(room, 0);
            self.crossings.resize(room, Crossing::default());
        }
        self.count = cross::<BITS>(mesh, lines, &mut self.lines, &mut self.crossings);
        Ok(())
    }

    /// Line and crossing of all that was found, in order of the triangles.
    pub(crate) fn crossings(&self) -> (&[u32], &[Crossing]) {
        (&self.lines[..self.count], &self.crossings[..self.count])
    }
}

/// Triangles to draw.
#[derive(Clone, Copy)]
struct Candidates<'a> {
    triangles: &'a [u32],
    corners: &'a [[u32; 3]],
    vertices: &'a [Snapped],
}

impl Candidates<'_> {
    #[inline(always)]
    fn corners(&self, triangle: u32) -> [Snapped; 3] {
        let [a, b, c] = self.corners[triangle as usize];
        let vertex = |v: u32| self.vertices[v as usize];
        [vertex(a), vertex(b), vertex(c)]
    }
}

/// Lists the triangles whose box holds a line; returns how many.
#[multiversion(targets = "simd")]
fn cull(corners: &[[u32; 3]], cells: &[Cell], candidates: &mut [u32]) -> usize {
    let mut kept = 0;
    let cell = |v: u32| cells[v as usize];
    for (triangle, &[a, b, c]) in corners.iter().enumerate() {
        // Without a branch, which would be mispredicted for every other triangle.
        candidates[kept] = triangle as u32;
        kept += usize::from(Cell::hold_a_line([cell(a), cell(b), cell(c)]));
    }
    kept
}

/// How many lines the boxes of the candidates hold together.
#[multiversion(targets = "simd")]
fn count_lines<const BITS: u32>(mesh: Candidates<'_>, lines: [i32; 2]) -> u64 {
    let mut found = 0;
    for &triangle in mesh.triangles {
        found += Bounds::of::<BITS>(mesh.corners(triangle), lines).line_count() as u64;
    }
    found
}

/// Tests the lines in the boxes of the candidates.
#[multiversion(targets = "simd")]
fn cross<const BITS: u32>(
    mesh: Candidates<'_>,
    lines: [i32; 2],
    found_lines: &mut [u32],
    crossings: &mut [Crossing],
) -> usize {
    let mut count = 0;
    for &triangle in mesh.triangles {
        let corners = mesh.corners(triangle);
        let bounds = Bounds::of::<BITS>(corners, lines);
        let [a, b, c] = corners;
        let owns = [owns_ties(b, c), owns_ties(c, a), owns_ties(a, b)];
        for v in bounds.first[1]..=bounds.last[1] {
            for u in bounds.first[0]..=bounds.last[0] {
                let from_line = |corner: Snapped| {
                    [
                        corner.across[0] - (u << BITS),
                        corner.across[1] - (v << BITS),
                    ]
                };
                let (to_a, to_b, to_c) = (from_line(a), from_line(b), from_line(c));
                // Twice the signed areas of line and edge: the line's barycentric coordinates.
                let areas = [area(to_b, to_c), area(to_c, to_a), area(to_a, to_b)];
                let area = areas[0] + areas[1] + areas[2];
                let left = |k: usize| areas[k] + i64::from(owns[k]) > 0;
                let (x, y, z) = (left(0), left(1), left(2));
                let meets = (x == y) & (y == z) & (area != 0);

                let (of_b, of_c) = (areas[1] as f32 / area as f32, areas[2] as f32 / area as f32);
                let depth = a.depth + (of_b * (b.depth - a.depth) + of_c * (c.depth - a.depth));
                found_lines[count] = (v * lines[0] + u) as u32;
                // Counter-clockwise seen against the line: its outside is where the line goes.
                crossings[count] = Crossing::new(depth.round_ties_even() as i32, triangle, x);
                count += usize::from(meets);
            }
        }
    }
    count
}

/// The lines in a triangle's box: `first..=last` in both directions, empty if last < first.
struct Bounds {
    first: [i32; 2],
    last: [i32; 2],
}

impl Bounds {
    #[inline(always)]
    fn of<const BITS: u32>(corners: [Snapped; 3], lines: [i32; 2]) -> Self {
        let [a, b, c] = corners;
        let side = |k: usize| {
            let (a, b, c) = (a.across[k], b.across[k], c.across[k]);
            let (least, most) = (a.min(b).min(c), a.max(b).max(c));
            let first = (least + ((1 << BITS) - 1)) >> BITS;
            (first.max(0), (most >> BITS).min(lines[k] - 1))
        };
        let ((first_u, last_u), (first_v, last_v)) = (side(0), side(1));
        Self {
            first: [first_u, first_v],
            last: [last_u, last_v],
        }
    }

    #[inline(always)]
    fn line_count(&self) -> usize {
        let side = |k: usize| (self.last[k] + 1 - self.first[k]).max(0) as usize;
        side(0) * side(1)
    }
}

/// Twice the signed area between a line and an edge, exact: both ends lie within 2^30 subcells.
#[inline(always)]
fn area(p: [i32; 2], q: [i32; 2]) -> i64 {
    i64::from(p[0]) * i64::from(q[1]) - i64::from(p[1]) * i64::from(q[0])
}

/// Whether a line exactly on the edge counts as on its left: the sign of its area after the line was
/// shifted by an infinitesimal step along u and a yet smaller one along v.
#[inline(always)]
fn owns_ties(from: Snapped, to: Snapped) -> bool {
    let side = |k: usize| to.across[k] - from.across[k];
    side(1) < 0 || (side(1) == 0 && side(0) > 0)
}
