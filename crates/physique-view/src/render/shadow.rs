//! Soft shadows on the floor: they show where a foot touches and where it floats.

use glam::{Vec2, Vec3};

use super::ground::floor;
use super::light::KEY_DIRECTION;

/// Metres a cell, unless the shadow would then have too many cells.
const FINEST_CELL: f32 = 0.012;
const MOST_CELLS: f32 = 512.0;
/// Darkness of the shadow cast by the key light, and of the one under near surface.
const CAST: f32 = 0.20;
const CONTACT: f32 = 0.60;
/// The height over which the contact shadow fades, in metres.
const CONTACT_HEIGHT: f32 = 0.10;

/// How much light the bodies take from the floor, on a grid in the plane.
#[derive(Clone, Debug)]
pub(crate) struct GroundShadow {
    origin: Vec2,
    cell: f32,
    columns: usize,
    rows: usize,
    darkness: Vec<f32>,
}

impl GroundShadow {
    /// The shadow of triangles (by their corners) on the plane y = `height`; nothing from nothing.
    pub(crate) fn new(
        triangles: impl Iterator<Item = [Vec3; 3]> + Clone,
        height: f32,
    ) -> Option<Self> {
        let cast = |p: Vec3| {
            let above = (p.y - height).max(0.0);
            Vec2::new(p.x, p.z)
                - Vec2::new(KEY_DIRECTION.x, KEY_DIRECTION.z) * (above / KEY_DIRECTION.y)
        };
        let below = |p: Vec3| Vec2::new(p.x, p.z);
        let (mut min, mut max) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for point in triangles.clone().flatten() {
            min = min.min(cast(point)).min(below(point));
            max = max.max(cast(point)).max(below(point));
        }
        if min.x > max.x {
            return None;
        }
        let extent = (max - min).max_element();
        let cell = FINEST_CELL.max(extent / MOST_CELLS);
        let pad = 8.0 * cell + 0.12;
        let origin = min - pad;
        let size = ((max - min + 2.0 * pad) / cell).ceil();
        let (columns, rows) = (size.x as usize + 1, size.y as usize + 1);
        let mut shadow = Self {
            origin,
            cell,
            columns,
            rows,
            darkness: Vec::new(),
        };
        let mut cast_cells = vec![0.0; columns * rows];
        let mut contact_cells = cast_cells.clone();
        for points in triangles {
            shadow.fill(&mut cast_cells, points.map(cast), 1.0);
            let lowest = points
                .iter()
                .map(|p| (p.y - height).abs())
                .fold(f32::INFINITY, f32::min);
            if lowest < 5.0 * CONTACT_HEIGHT {
                shadow.fill(
                    &mut contact_cells,
                    points.map(below),
                    (-lowest / CONTACT_HEIGHT).exp(),
                );
            }
        }
        shadow.blur(&mut cast_cells, 0.030);
        shadow.blur(&mut contact_cells, 0.020);
        shadow.darkness = cast_cells
            .iter()
            .zip(&contact_cells)
            .map(|(cast, contact)| 1.0 - (1.0 - CAST * cast) * (1.0 - CONTACT * contact))
            .collect();
        Some(shadow)
    }

    /// Darkness at a point of the plane: 0 for full light.
    pub(crate) fn at(&self, x: f32, z: f32) -> f32 {
        let place = (Vec2::new(x, z) - self.origin) / self.cell - 0.5;
        let (column, row) = (floor(place.x), floor(place.y));
        let (tx, ty) = (place.x - column, place.y - row);
        // Casts saturate, so that no place is inside by accident.
        let (column, row) = (column as i32, row as i32);
        if column < 0
            || row < 0
            || column as usize + 1 >= self.columns
            || row as usize + 1 >= self.rows
        {
            return 0.0;
        }
        let first = row as usize * self.columns + column as usize;
        let cell = |dx: usize, dy: usize| self.darkness[first + dy * self.columns + dx];
        let top = cell(0, 0) * (1.0 - tx) + cell(1, 0) * tx;
        let bottom = cell(0, 1) * (1.0 - tx) + cell(1, 1) * tx;
        top * (1.0 - ty) + bottom * ty
    }

    /// Raise to `value` the cells whose middle lies in a triangle, and the one under its centroid.
    fn fill(&self, cells: &mut [f32], points: [Vec2; 3], value: f32) {
        let [a, b, c] = points.map(|p| (p - self.origin) / self.cell - 0.5);
        let raise = |cells: &mut [f32], column: usize, row: usize| {
            if column < self.columns && row < self.rows {
                let cell = &mut cells[row * self.columns + column];
                *cell = cell.max(value);
            }
        };
        let centroid = (a + b + c) / 3.0;
        raise(
            cells,
            centroid.x.round() as usize,
            centroid.y.round() as usize,
        );
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 {
            return;
        }
        for row in
            min.y.ceil().max(0.0) as usize..=(max.y.floor().max(0.0) as usize).min(self.rows - 1)
        {
            for column in min.x.ceil().max(0.0) as usize
                ..=(max.x.floor().max(0.0) as usize).min(self.columns - 1)
            {
                let p = Vec2::new(column as f32, row as f32);
                let inside = [(a, b), (b, c), (c, a)]
                    .iter()
                    .all(|&(from, to)| (to - from).perp_dot(p - from) * area >= 0.0);
                if inside {
                    raise(cells, column, row);
                }
            }
        }
    }

    /// Three box blurs, which are nearly a Gaussian of `deviation` metres.
    fn blur(&self, cells: &mut [f32], deviation: f32) {
        let radius = ((deviation / self.cell).round() as usize).clamp(1, 12);
        let mut line = vec![0.0; self.columns.max(self.rows)];
        for _ in 0..3 {
            for row in 0..self.rows {
                let row = row * self.columns;
                box_blur(cells, row, 1, self.columns, radius, &mut line);
            }
            for column in 0..self.columns {
                box_blur(cells, column, self.columns, self.rows, radius, &mut line);
            }
        }
    }
}

fn box_blur(
    cells: &mut [f32],
    start: usize,
    stride: usize,
    count: usize,
    radius: usize,
    line: &mut [f32],
) {
    let value = |cells: &[f32], index: usize| cells[start + index * stride];
    let mut sum: f32 = (0..radius.min(count))
        .map(|index| value(cells, index))
        .sum();
    for (index, mean) in line.iter_mut().enumerate().take(count) {
        if index + radius < count {
            sum += value(cells, index + radius);
        }
        if index > radius {
            sum -= value(cells, index - radius - 1);
        }
        *mean = sum.max(0.0) / (2 * radius + 1) as f32;
    }
    for (index, mean) in line.iter().enumerate().take(count) {
        cells[start + index * stride] = *mean;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(y: f32) -> [[Vec3; 3]; 2] {
        let corner = |x: f32, z: f32| Vec3::new(x, y, z);
        [
            [corner(-0.2, -0.2), corner(0.2, -0.2), corner(0.2, 0.2)],
            [corner(-0.2, -0.2), corner(0.2, 0.2), corner(-0.2, 0.2)],
        ]
    }

    #[test]
    fn touching_is_darker_than_floating_and_far_away_is_light() {
        let touching = GroundShadow::new(square(0.0).into_iter(), 0.0)
            .expect("a shadow")
            .at(0.0, 0.0);
        let floating = GroundShadow::new(square(0.05).into_iter(), 0.0)
            .expect("a shadow")
            .at(0.0, 0.0);
        assert!(touching > floating + 0.05, "{touching} {floating}");
        let shadow = GroundShadow::new(square(0.0).into_iter(), 0.0).expect("a shadow");
        assert_eq!(shadow.at(3.0, 0.0), 0.0);
        assert_eq!(shadow.at(1e30, -1e30), 0.0);
    }

    #[test]
    fn the_key_shadow_falls_away_from_the_light() {
        let shadow = GroundShadow::new(square(1.0).into_iter(), 0.0).expect("a shadow");
        // One metre up, the shadow lies where the light through the middle meets the floor.
        let away = KEY_DIRECTION / KEY_DIRECTION.y;
        assert!(shadow.at(-away.x, -away.z) > 0.9 * CAST);
        assert!(shadow.at(away.x, away.z) == 0.0);
    }

    #[test]
    fn nothing_casts_no_shadow() {
        assert!(GroundShadow::new(std::iter::empty(), 0.0).is_none());
    }
}
