//! Which triangle is seen at which sample.
//!
//! The rasteriser only finds *what* is visible (a visibility buffer, Burns and Hunt 2013): the
//! number of the nearest triangle at eight samples a pixel. Colours are found afterwards, once
//! for each triangle that a pixel shows, by meeting the triangle with the line of sight.

use super::clip::clip;
use super::projection::{ClipPoint, ViewTransform};

/// Samples in a pixel.
pub(super) const SAMPLES: usize = 8;

/// Where the samples lie, in sixteenths of a pixel. All eight columns differ, so that upright
/// edges have eight steps, and the pattern equals its mirror image, so that mirrored scenes give
/// mirrored pictures.
pub(super) const SAMPLE_POSITIONS: [(i64, i64); SAMPLES] = [
    (1, 2),
    (15, 2),
    (5, 6),
    (11, 6),
    (3, 10),
    (13, 10),
    (7, 14),
    (9, 14),
];

/// No triangle: the ground or the background.
pub(super) const NOTHING: u32 = u32::MAX;

/// Sub-pixel steps: vertices are snapped to 1/256 pixel, so that coverage is exact integer
/// arithmetic and neighbours share their edges without gap or overlap.
const STEPS: i64 = 256;

/// A triangle (or a part left by clipping) ready to be drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    id: u32,
    highlighted: bool,
    /// Edge functions `a x + b y + c` in sub-pixel steps, not negative inside.
    edges: [(i64, i64, i64); 3],
    /// Pixels touched: first and last column, first and last row.
    columns: (i64, i64),
    rows: (i64, i64),
    /// Nearness at the picture's corner, by column and by row, and its least and greatest value.
    nearness: (f64, f64, f64),
    range: (f32, f32),
}

impl Facet {
    pub(super) fn rows(&self) -> (i64, i64) {
        self.rows
    }

    pub(super) fn highlighted(&self) -> bool {
        self.highlighted
    }
}

/// Append the drawable parts of a triangle inside a picture of `width` x `height` pixels.
pub(super) fn push_facets(
    facets: &mut Vec<Facet>,
    view: &ViewTransform,
    triangle: [ClipPoint; 3],
    id: u32,
    highlighted: bool,
    (width, height): (u32, u32),
) {
    let polygon = clip(triangle, view.near());
    let [first, rest @ ..] = polygon.corners() else {
        return;
    };
    for pair in rest.windows(2) {
        facets.extend(facet(
            [*first, pair[0], pair[1]],
            id,
            highlighted,
            (width, height),
        ));
    }
}

fn facet(
    corners: [ClipPoint; 3],
    id: u32,
    highlighted: bool,
    (width, height): (u32, u32),
) -> Option<Facet> {
    let snap = |value: f64| (value * STEPS as f64).round() as i64;
    let mut x = corners.map(|p| snap(p.x / p.w));
    let mut y = corners.map(|p| snap(p.y / p.w));
    let mut near = corners.map(|p| p.depth / p.w);
    let mut area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if area == 0 {
        return None;
    }
    if area < 0 {
        // Both sides are drawn: turn the triangle over.
        x.swap(1, 2);
        y.swap(1, 2);
        near.swap(1, 2);
        area = -area;
    }
    let span = |values: [i64; 3], limit: u32| {
        let low = values
            .into_iter()
            .fold(i64::MAX, i64::min)
            .div_euclid(STEPS)
            .max(0);
        let high = values
            .into_iter()
            .fold(i64::MIN, i64::max)
            .div_euclid(STEPS);
        (low, high.min(i64::from(limit) - 1))
    };
    let (columns, rows) = (span(x, width), span(y, height));
    if columns.0 > columns.1 || rows.0 > rows.1 {
        return None;
    }
    let edge = |from: usize, to: usize| {
        let (dx, dy) = (x[to] - x[from], y[to] - y[from]);
        // A sample exactly on an edge belongs to the triangle on one side only: the top-left rule.
        let owns_edge = dy < 0 || (dy == 0 && dx > 0);
        (-dy, dx, dy * x[from] - dx * y[from] - i64::from(!owns_edge))
    };
    let edges = [edge(1, 2), edge(2, 0), edge(0, 1)];
    // Nearness is linear over the picture: solve for its slopes in pixels.
    let step = 1.0 / STEPS as f64;
    let (ux, uy) = ((x[1] - x[0]) as f64 * step, (y[1] - y[0]) as f64 * step);
    let (vx, vy) = ((x[2] - x[0]) as f64 * step, (y[2] - y[0]) as f64 * step);
    let (du, dv) = (near[1] - near[0], near[2] - near[0]);
    let twice_area = area as f64 * step * step;
    let by_column = (du * vy - dv * uy) / twice_area;
    let by_row = (dv * ux - du * vx) / twice_area;
    let at_corner = near[0] - by_column * x[0] as f64 * step - by_row * y[0] as f64 * step;
    let range = (
        near.into_iter().fold(f64::INFINITY, f64::min) as f32,
        near.into_iter().fold(f64::NEG_INFINITY, f64::max) as f32,
    );
    Some(Facet {
        id,
        highlighted,
        edges,
        columns,
        rows,
        nearness: (at_corner, by_column, by_row),
        range,
    })
}

/// What is seen at each sample of some rows of a picture.
#[derive(Debug)]
pub(super) struct Samples {
    width: usize,
    first_row: i64,
    pub(super) ids: Vec<[u32; SAMPLES]>,
    pub(super) nearness: Vec<[f32; SAMPLES]>,
}

impl Samples {
    pub(super) fn new(width: u32, first_row: u32, rows: usize) -> Self {
        let pixels = width as usize * rows;
        Self {
            width: width as usize,
            first_row: i64::from(first_row),
            ids: vec![[NOTHING; SAMPLES]; pixels],
            nearness: vec![[f32::NEG_INFINITY; SAMPLES]; pixels],
        }
    }

    /// Draw a facet into these rows; at equal nearness the first one drawn stays.
    pub(super) fn draw(&mut self, facet: &Facet) {
        let rows = (self.ids.len() / self.width) as i64;
        let first = facet.rows.0.max(self.first_row);
        let last = facet.rows.1.min(self.first_row + rows - 1);
        // Edge functions at the samples relative to the pixel's corner, in units of 1/16 of theirs:
        // below 2^25 * (15 + 14) inside the guard band, so eight of them fit a vector of 32 bits.
        let offsets = facet
            .edges
            .map(|(a, b, _)| SAMPLE_POSITIONS.map(|(x, y)| (a * x + b * y) as i32));
        let (at_corner, by_column, by_row) = facet.nearness;
        let lifts = SAMPLE_POSITIONS
            .map(|(x, y)| ((by_column * x as f64 + by_row * y as f64) / 16.0) as f32);
        for row in first..=last {
            let start = (row - self.first_row) as usize * self.width;
            for column in facet.columns.0..=facet.columns.1 {
                // Whole sixteenths decide the sign, as the offsets are whole; what lies beyond the
                // greatest offset is far inside or far outside.
                let corner = |(a, b, c): (i64, i64, i64)| {
                    let value = (a * column + b * row) * STEPS + c;
                    (value >> 4).clamp(-(1 << 30), 1 << 30) as i32
                };
                let [e0, e1, e2] = [
                    corner(facet.edges[0]),
                    corner(facet.edges[1]),
                    corner(facet.edges[2]),
                ];
                // The sign bit of the union is set if any of the three is negative.
                let signs: [i32; SAMPLES] = std::array::from_fn(|sample| {
                    (e0 + offsets[0][sample])
                        | (e1 + offsets[1][sample])
                        | (e2 + offsets[2][sample])
                });
                if signs.iter().fold(-1, |all, sign| all & sign) < 0 {
                    continue;
                }
                let base = (at_corner + by_column * column as f64 + by_row * row as f64) as f32;
                let ids = &mut self.ids[start + column as usize];
                let nearness = &mut self.nearness[start + column as usize];
                for sample in 0..SAMPLES {
                    let here = (base + lifts[sample]).clamp(facet.range.0, facet.range.1);
                    let wins = signs[sample] >= 0 && here > nearness[sample];
                    nearness[sample] = if wins { here } else { nearness[sample] };
                    ids[sample] = if wins { facet.id } else { ids[sample] };
                }
            }
        }
    }
}
