//! Uneven ground.

use glam::DVec3;

use super::Obstacle;
use crate::Error;

/// Heights over a regular grid, bilinear in between; beyond the edge the edge goes on.
///
/// The distance of a point is its height above the ground below it, times the cosine of the slope
/// there: exact on planes, and near the surface on all else.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    origin: [f64; 2],
    spacing: f64,
    columns: usize,
    rows: usize,
    heights: Vec<f64>,
}

impl HeightField {
    /// `heights` are `[rows][columns]`: rows along +Z, columns along +X, the first at `origin`
    /// (X, Z), `spacing` apart; all in metres.
    ///
    /// # Errors
    /// [`Error::HeightField`] for fewer than 2 x 2 heights, other than whole rows, or numbers that
    /// cannot be.
    pub fn new(
        origin: [f64; 2],
        spacing: f64,
        columns: usize,
        heights: Vec<f64>,
    ) -> Result<Self, Error> {
        let refuse = |expected, found| Err(Error::HeightField { expected, found });
        let rows = heights.len().checked_div(columns).unwrap_or(0);
        if columns < 2 || rows < 2 || rows * columns != heights.len() {
            let found = format!("{} heights in rows of {columns}", heights.len());
            return refuse("whole rows, at least 2 x 2 heights", found);
        }
        if !(spacing.is_finite() && spacing > 0.0 && origin.iter().all(|at| at.is_finite())) {
            let found = format!("spacing {spacing}, origin {origin:?}");
            return refuse("a finite origin and a spacing above 0", found);
        }
        if let Some(index) = heights.iter().position(|height| !height.is_finite()) {
            let found = format!("{} at index {index}", heights[index]);
            return refuse("finite heights", found);
        }
        Ok(Self {
            origin,
            spacing,
            columns,
            rows,
            heights,
        })
    }

    /// Height of the ground at (x, z), its slopes along both, and the change of one slope along the
    /// other axis.
    fn at(&self, x: f64, z: f64) -> Ground {
        let cell = |at: f64, origin: f64, count: usize| {
            let last = (count - 1) as f64;
            let place = (at - origin) / self.spacing;
            let inside = place.clamp(0.0, last);
            let index = (inside as usize).min(count - 2);
            // Beyond the edge, the ground does not rise.
            let rises = if place == inside { 1.0 } else { 0.0 };
            (index, inside - index as f64, rises)
        };
        let (column, right, rises_x) = cell(x, self.origin[0], self.columns);
        let (row, forth, rises_z) = cell(z, self.origin[1], self.rows);
        let corner = |row: usize, column: usize| self.heights[row * self.columns + column];
        let (a, b) = (corner(row, column), corner(row, column + 1));
        let (c, d) = (corner(row + 1, column), corner(row + 1, column + 1));
        let (back, front) = (a + (b - a) * right, c + (d - c) * right);
        Ground {
            height: back + (front - back) * forth,
            slope_x: rises_x * ((b - a) * (1.0 - forth) + (d - c) * forth) / self.spacing,
            slope_z: rises_z * (front - back) / self.spacing,
            twist: rises_x * rises_z * ((d - c) - (b - a)) / self.spacing.powi(2),
        }
    }
}

struct Ground {
    height: f64,
    slope_x: f64,
    slope_z: f64,
    twist: f64,
}

impl Obstacle for HeightField {
    fn distance(&self, point: DVec3) -> (f64, DVec3) {
        let Ground {
            height,
            slope_x,
            slope_z,
            twist,
        } = self.at(point.x, point.z);
        let above = point.y - height;
        let cosine = (1.0 + slope_x * slope_x + slope_z * slope_z).sqrt().recip();
        // Within a cell, the slope along X changes along Z only, and the other way round.
        let by_cosine = above * cosine.powi(3) * twist;
        let gradient = DVec3::new(
            -slope_x * cosine - by_cosine * slope_z,
            cosine,
            -slope_z * cosine - by_cosine * slope_x,
        );
        (above * cosine, gradient)
    }
}
