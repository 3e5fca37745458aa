use glam::Vec3;

use super::snapped::Placement;
use super::{Axis, ScanOptions};
use crate::Error;

/// Vertices are snapped across the lines to 1/2^10 of the spacing.
pub(super) const SUBCELL_BITS: u32 = 10;
/// Depths along a line are whole multiples of 1/2^16 of the spacing.
pub(crate) const DEPTH_UNITS: f32 = 65536.0;

/// Fraction of a spacing by which the lines are shifted off the absolute multiples: the two
/// coordinates of the plastic number's low-discrepancy sequence.
const SHIFT: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
/// Positions farther from the origin than this many spacings are too coarse in `f32`.
const MOST_CELLS_FROM_ORIGIN: f64 = (1 << 20) as f64;

/// The lines that one mesh in one pose needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    axis: Axis,
    spacing: f32,
    /// Place of line (0, 0) across the lines, in metres.
    origin: [f32; 2],
    /// Where depth 0 lies along the lines, in metres.
    origin_depth: f32,
    /// Number of lines side by side in both directions.
    pub(super) lines: [usize; 2],
}

impl Lattice {
    /// Lays the lines that finite `positions` need.
    pub(super) fn around(positions: &[Vec3], options: &ScanOptions) -> Result<Self, Error> {
        let (axis, spacing) = (options.axis, options.spacing);
        let (mut least, mut most) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for &p in positions {
            least = least.min(p);
            most = most.max(p);
        }
        if positions.is_empty() {
            (least, most) = (Vec3::ZERO, Vec3::ZERO);
        }
        let ([least_u, least_v], least_depth) = axis.across_and_along(least);
        let ([most_u, most_v], most_depth) = axis.across_and_along(most);
        let (origin_u, lines_u) = side(least_u, most_u, SHIFT[0], spacing)?;
        let (origin_v, lines_v) = side(least_v, most_v, SHIFT[1], spacing)?;
        let (origin_depth, _) = side(least_depth, most_depth, 0.0, spacing)?;
        Ok(Self {
            axis,
            spacing,
            origin: [origin_u, origin_v],
            origin_depth,
            lines: [lines_u, lines_v],
        })
    }

    /// Number of lines.
    pub(super) fn line_count(&self) -> usize {
        self.lines[0] * self.lines[1]
    }

    /// Volume of one depth unit of one line, in cubic metres.
    pub(super) fn unit_volume(&self) -> f64 {
        f64::from(self.spacing).powi(3) / f64::from(DEPTH_UNITS)
    }

    /// Length of `units` along a line, in metres.
    pub(super) fn length(&self, units: i64) -> f32 {
        (units as f64 * f64::from(self.spacing) / f64::from(DEPTH_UNITS)) as f32
    }

    /// How vertices are moved into the lattice.
    pub(super) fn placement(&self) -> Placement {
        Placement {
            axis: self.axis,
            origin: self.origin,
            origin_depth: self.origin_depth,
            subcells: (1 << SUBCELL_BITS) as f32 / self.spacing,
            depth_units: DEPTH_UNITS / self.spacing,
            lines: self.lines,
        }
    }

    /// The point at `depth` on line number `line`, in metres.
    pub(super) fn point(&self, line: usize, depth: i64) -> Vec3 {
        let across = [line % self.lines[0], line / self.lines[0]];
        let place = |k: usize| self.origin[k] + across[k] as f32 * self.spacing;
        Axis::position(
            [place(0), place(1)],
            self.origin_depth + self.length(depth),
            self.axis,
        )
    }
}

/// The last line at or before `least`, and the number of lines from there to beyond `most`.
fn side(least: f32, most: f32, shift: f64, spacing: f32) -> Result<(f32, usize), Error> {
    let cells = |x: f32| f64::from(x) / f64::from(spacing) - shift;
    let first = cells(least).floor();
    // One line more than needed, so that rounding the origin to f32 never costs a line.
    let lines = cells(most).floor() - first + 2.0;
    let far = cells(least).abs().max(cells(most).abs());
    if far > MOST_CELLS_FROM_ORIGIN {
        return Err(Error::TooFarAway {
            distance: far * f64::from(spacing),
            limit: MOST_CELLS_FROM_ORIGIN * f64::from(spacing),
            spacing,
        });
    }
    if lines > ScanOptions::MOST_LINES_ASIDE as f64 {
        let extent = f64::from(most) - f64::from(least);
        return Err(Error::TooManyLines {
            extent,
            spacing,
            lines,
            limit: ScanOptions::MOST_LINES_ASIDE,
        });
    }
    Ok((
        ((first + shift) * f64::from(spacing)) as f32,
        lines as usize,
    ))
}
