//! Vertices as the lattice sees them.

use glam::Vec3;
use multiversion::multiversion;

use super::Axis;

/// How a lattice of lines takes vertices over.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placement {
    pub(crate) axis: Axis,
    /// Place of line (0, 0) across the lines.
    pub(crate) origin: [f32; 2],
    /// Where depth 0 lies along the lines.
    pub(crate) origin_depth: f32,
    /// Subcells a unit of length across the lines: 2^`BITS` a spacing.
    pub(crate) subcells: f32,
    /// Depth units a unit of length along the lines.
    pub(crate) depth_units: f32,
    /// Number of lines side by side in both directions.
    pub(crate) lines: [usize; 2],
}

/// A vertex in the lattice.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Snapped {
    /// Across the lines, in subcells from line (0, 0).
    pub(crate) across: [i32; 2],
    /// Along the lines, in depth units from the lattice's origin.
    pub(crate) depth: f32,
}

/// Between which lines a vertex lies, in both directions: 2 k on line k, 2 k + 1 between the lines k
/// and k + 1, the same for all before the first line, and for all behind the last. One word, so that
/// three comparisons tell whether a triangle can meet a line.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Cell(u32);

impl Cell {
    #[inline(always)]
    fn of<const BITS: u32>(across: [i32; 2], lines: [i32; 2]) -> Self {
        let number = |across: i32, lines: i32| {
            let beyond_line = i32::from(across & ((1 << BITS) - 1) != 0);
            (2 * (across >> BITS) + beyond_line).clamp(-1, 2 * lines - 1)
        };
        let (u, v) = (number(across[0], lines[0]), number(across[1], lines[1]));
        Self((u as u32 & 0xffff) | (v as u32) << 16)
    }

    /// Whether the box around three vertices holds a line and is no line itself.
    #[inline(always)]
    pub(crate) fn hold_a_line([Self(a), Self(b), Self(c)]: [Self; 3]) -> bool {
        // Between different numbers, or at one of them, lies an even one. (The same even number three
        // times: the triangle lies upright on a line and meets nothing.)
        let differing = (a ^ b) | (a ^ c);
        (differing & 0xffff != 0) & (differing >> 16 != 0)
    }
}

/// All vertices of a mesh in the lattice.
#[derive(Debug, Clone, Default)]
pub(crate) struct SnappedVertices {
    pub(crate) vertices: Vec<Snapped>,
    pub(crate) cells: Vec<Cell>,
}

impl SnappedVertices {
    /// Takes over a pose.
    pub(crate) fn snap<const BITS: u32>(&mut self, positions: &[Vec3], placement: &Placement) {
        self.vertices.resize(positions.len(), Snapped::default());
        self.cells.resize(positions.len(), Cell::default());
        snap::<BITS>(positions, placement, &mut self.vertices, &mut self.cells);
    }
}

#[multiversion(targets = "simd")]
fn snap<const BITS: u32>(
    positions: &[Vec3],
    placement: &Placement,
    vertices: &mut [Snapped],
    cells: &mut [Cell],
) {
    // A loop for each axis: one that asks for the axis at every vertex is not vectorised.
    match placement.axis {
        Axis::X => snap_along::<BITS>(Axis::X, positions, placement, vertices, cells),
        Axis::Y => snap_along::<BITS>(Axis::Y, positions, placement, vertices, cells),
        Axis::Z => snap_along::<BITS>(Axis::Z, positions, placement, vertices, cells),
    }
}

#[inline(always)]
fn snap_along<const BITS: u32>(
    axis: Axis,
    positions: &[Vec3],
    placement: &Placement,
    vertices: &mut [Snapped],
    cells: &mut [Cell],
) {
    let Placement {
        origin: [origin_u, origin_v],
        origin_depth,
        subcells,
        depth_units,
        lines: [lines_u, lines_v],
        ..
    } = *placement;
    let lines = [lines_u as i32, lines_v as i32];
    let snap = |x: f32, origin: f32| ((x - origin) * subcells).round_ties_even() as i32;
    for ((vertex, cell), &position) in vertices.iter_mut().zip(cells).zip(positions) {
        let ([u, v], along) = axis.across_and_along(position);
        let across = [snap(u, origin_u), snap(v, origin_v)];
        let depth = (along - origin_depth) * depth_units;
        *vertex = Snapped { across, depth };
        *cell = Cell::of::<BITS>(across, lines);
    }
}
