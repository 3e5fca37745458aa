//! Winding numbers by counting crossings along a ray.

use glam::{DVec2, DVec3, Vec3};

use crate::Triangles;

/// Most cells along a side of the grid.
const MOST_CELLS: f32 = 256.0;

/// The triangles, seen along the surface's shortest side and sorted into a grid of cells.
///
/// The winding number of a point is the number of triangles beyond it through which a ray leaves,
/// less those through which it enters. Each side of a triangle is tested in f64 in an order that
/// both its triangles share, and ends are half open: a ray through an edge or vertex is counted
/// once, whatever the rounding.
#[derive(Debug, Clone)]
pub(super) struct RayGrid {
    /// Turns coordinates so that rays run along the last.
    axes: [usize; 3],
    least: Vec3,
    most: Vec3,
    cells_a_metre: f32,
    columns: usize,
    rows: usize,
    /// First entry of every cell, and the end.
    starts: Vec<u32>,
    entries: Vec<Entry>,
}

/// A triangle as seen along the ray.
#[derive(Debug, Clone, Copy)]
struct Entry {
    corners: [Vec3; 3],
    /// For each side, whether its lower-numbered vertex comes second.
    turned: [bool; 3],
}

impl RayGrid {
    pub(super) fn new(triangles: &Triangles, positions: &[Vec3]) -> Self {
        let least = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let most = positions
            .iter()
            .copied()
            .fold(Vec3::NEG_INFINITY, Vec3::max);
        let shortest = (most - least).min_position();
        // A cyclic turn keeps the orientation.
        let axes = [(shortest + 1) % 3, (shortest + 2) % 3, shortest];
        let turn = |p: Vec3| Vec3::new(p[axes[0]], p[axes[1]], p[axes[2]]);
        let (least, most) = (turn(least), turn(most));

        // About as many cells as triangles, but for what lies beside the body.
        let extent = (most - least).truncate().max(glam::Vec2::splat(1e-6));
        let wanted = (2.0 * (triangles.len() as f32).sqrt()).clamp(1.0, MOST_CELLS);
        let cells_a_metre = wanted / extent.max_element();
        let cells = (extent * cells_a_metre).ceil().max(glam::Vec2::ONE);
        let (columns, rows) = (cells.x as usize, cells.y as usize);

        let mut grid = Self {
            axes,
            least,
            most,
            cells_a_metre,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            entries: Vec::new(),
        };
        let seen: Vec<Entry> = triangles
            .corners()
            .iter()
            .map(|&vertices| Entry {
                corners: vertices.map(|vertex| turn(positions[vertex as usize])),
                turned: std::array::from_fn(|side| vertices[side] > vertices[(side + 1) % 3]),
            })
            .collect();
        // Counting sort: sizes, then places from the back.
        for entry in &seen {
            grid.cells_of(entry).for_each(|cell| grid.starts[cell] += 1);
        }
        let mut total = 0;
        for start in &mut grid.starts {
            total += *start;
            *start = total;
        }
        if let Some(&first) = seen.first() {
            grid.entries = vec![first; total as usize];
        }
        for entry in seen.iter().rev() {
            for cell in grid.cells_of(entry) {
                grid.starts[cell] -= 1;
                grid.entries[grid.starts[cell] as usize] = *entry;
            }
        }
        grid
    }

    /// How often the surface winds around the point; anything for a point on the surface, 0 for
    /// one that is not finite.
    pub(super) fn winding_number(&self, point: Vec3) -> i32 {
        let point = Vec3::new(
            point[self.axes[0]],
            point[self.axes[1]],
            point[self.axes[2]],
        );
        let within = point.cmpge(self.least).all() && point.cmple(self.most).all();
        if !within {
            return 0;
        }
        let (column, row) = (self.column(point.x), self.row(point.y));
        let cell = row * self.columns + column;
        let range = self.starts[cell] as usize..self.starts[cell + 1] as usize;
        self.entries[range]
            .iter()
            .map(|entry| entry.crossing(point))
            .sum()
    }

    fn column(&self, x: f32) -> usize {
        (((x - self.least.x) * self.cells_a_metre) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f32) -> usize {
        (((y - self.least.y) * self.cells_a_metre) as usize).min(self.rows - 1)
    }

    /// Cells that the triangle's box touches.
    fn cells_of(&self, entry: &Entry) -> impl Iterator<Item = usize> + use<> {
        let [a, b, c] = entry.corners;
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        let (first, last) = (self.column(least.x), self.column(most.x));
        let columns = self.columns;
        (self.row(least.y)..=self.row(most.y))
            .flat_map(move |row| (first..=last).map(move |column| row * columns + column))
    }
}

impl Entry {
    /// +1 if the ray from the point upwards leaves through the triangle, -1 if it enters.
    #[inline]
    fn crossing(&self, point: Vec3) -> i32 {
        let [a, b, c] = self.corners;
        if a.z.max(b.z).max(c.z) < point.z {
            return 0;
        }
        // The seen triangle winds around the seen point: counts of half-line crossings of its
        // sides. Most triangles of a cell miss the half line's height.
        let up = [a.y > point.y, b.y > point.y, c.y > point.y];
        if up[0] == up[1] && up[1] == up[2] {
            return 0;
        }
        let mut turns = 0;
        for side in 0..3 {
            let next = (side + 1) % 3;
            if up[side] != up[next] {
                let (mut from, mut to) = (self.corners[side], self.corners[next]);
                if self.turned[side] {
                    std::mem::swap(&mut from, &mut to);
                }
                let left = is_left(from, to, point) != self.turned[side];
                // A rising side to the right of the point turns left around it.
                if up[next] && left {
                    turns += 1;
                } else if !up[next] && !left {
                    turns -= 1;
                }
            }
        }
        if turns == 0 || !self.is_beyond(point) {
            return 0;
        }
        turns
    }

    /// Whether the triangle's plane, along the ray, is beyond the point.
    fn is_beyond(&self, point: Vec3) -> bool {
        let [a, b, c] = self.corners.map(|corner| (corner - point).as_dvec3());
        if a.z.min(b.z).min(c.z) > 0.0 {
            return true;
        }
        let normal: DVec3 = (b - a).cross(c - a);
        // Height of the plane above the point, times normal.z.
        let height = normal.dot(a);
        if normal.z > 0.0 {
            height > 0.0
        } else {
            height < 0.0
        }
    }
}

/// Whether the point lies left of the line, seen along the ray.
#[inline]
fn is_left(from: Vec3, to: Vec3, point: Vec3) -> bool {
    let flat = |v: Vec3| DVec2::new(f64::from(v.x), f64::from(v.y));
    let (from, to, point) = (flat(from), flat(to), flat(point));
    (to - from).perp_dot(point - from) > 0.0
}
