use multiversion::multiversion;

use super::crossing::Crossing;
use super::lattice::Snapped;
use crate::{Error, Triangles};

/// Scratch and result of drawing triangles onto the lattice.
#[derive(Debug, Clone, Default)]
pub(crate) struct Raster {
    /// Triangles whose box holds a line.
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
        snapped: &[Snapped],
        lines: [usize; 2],
        most_crossings: u64,
    ) -> Result<(), Error> {
        let lines = lines.map(|count| count as i32);
        let found = cull::<BITS>(triangles.corners(), snapped, lines, &mut self.candidates);
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
        self.count = cross::<BITS>(
            triangles.corners(),
            snapped,
            lines,
            &self.candidates,
            &mut self.lines,
            &mut self.crossings,
        );
        Ok(())
    }

    /// Line and crossing of all that was found, in order of the triangles.
    pub(crate) fn crossings(&self) -> (&[u32], &[Crossing]) {
        (&self.lines[..self.count], &self.crossings[..self.count])
    }
}

/// Lists the triangles whose box holds a line; returns how many lines the boxes hold together.
#[multiversion(targets = "simd")]
fn cull<const BITS: u32>(
    corners: &[[u32; 3]],
    snapped: &[Snapped],
    lines: [i32; 2],
    candidates: &mut Vec<u32>,
) -> u64 {
    candidates.resize(corners.len(), 0);
    let (mut kept, mut found) = (0, 0);
    for (triangle, corners) in corners.iter().enumerate() {
        let bounds = Bounds::of::<BITS>(corners.map(|v| snapped[v as usize].across), lines);
        let held = bounds.line_count();
        // Without a branch, which would be mispredicted for every other triangle.
        candidates[kept] = triangle as u32;
        kept += usize::from(held > 0);
        found += u64::from(held);
    }
    candidates.truncate(kept);
    found
}

/// Tests the lines in the boxes of the candidates.
#[multiversion(targets = "simd")]
fn cross<const BITS: u32>(
    corners: &[[u32; 3]],
    snapped: &[Snapped],
    lines: [i32; 2],
    candidates: &[u32],
    found_lines: &mut [u32],
    crossings: &mut [Crossing],
) -> usize {
    let mut count = 0;
    for &triangle in candidates {
        let [a, b, c] = corners[triangle as usize].map(|v| snapped[v as usize]);
        let bounds = Bounds::of::<BITS>([a.across, b.across, c.across], lines);
        let owns = [owns_ties(b, c), owns_ties(c, a), owns_ties(a, b)];
        for v in bounds.first[1]..=bounds.last[1] {
            for u in bounds.first[0]..=bounds.last[0] {
                let [to_a, to_b, to_c] = [a, b, c].map(|corner| {
                    [
                        corner.across[0] - (u << BITS),
                        corner.across[1] - (v << BITS),
                    ]
                });
                // Twice the signed areas of line and edge: the line's barycentric coordinates.
                let areas = [area(to_b, to_c), area(to_c, to_a), area(to_a, to_b)];
                let area = areas[0] + areas[1] + areas[2];
                let [x, y, z] = [0, 1, 2].map(|k| areas[k] + i64::from(owns[k]) > 0);
                let meets = (x == y) & (y == z) & (area != 0);

                let [_, of_b, of_c] = areas.map(|part| part as f32 / area as f32);
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
    fn of<const BITS: u32>([a, b, c]: [[i32; 2]; 3], lines: [i32; 2]) -> Self {
        let least = |k: usize| a[k].min(b[k]).min(c[k]);
        let most = |k: usize| a[k].max(b[k]).max(c[k]);
        let up = (1 << BITS) - 1;
        Self {
            first: [0, 1].map(|k| ((least(k) + up) >> BITS).max(0)),
            last: [0, 1].map(|k| (most(k) >> BITS).min(lines[k] - 1)),
        }
    }

    #[inline(always)]
    fn line_count(&self) -> u32 {
        let [width, height] = [0, 1].map(|k| (self.last[k] + 1 - self.first[k]).max(0) as u32);
        width * height
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
    let [u, v] = [0, 1].map(|k| to.across[k] - from.across[k]);
    v < 0 || (v == 0 && u > 0)
}
