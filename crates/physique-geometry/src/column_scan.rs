//! Volume that a closed surface covers, measured along a lattice of parallel lines.
//!
//! Every triangle is drawn onto a two-dimensional lattice of lines parallel to one axis. Where a line
//! enters the surface the winding number rises by one, where it leaves it falls by one; sorted along
//! the line, these crossings give the winding number as a step function. Its lengths, times the area
//! of a lattice cell, are volumes: exact along the line, the midpoint rule across.
//!
//! # Watertight
//!
//! Vertices are snapped across the lines to 1/1024 of the spacing, and whether a line meets a
//! triangle is then decided in integers, without rounding. A line that runs exactly through an edge or
//! a vertex is treated as if it were shifted by an infinitesimal step (the top-left rule of
//! rasterisers), the same for all triangles. So a line enters a closed surface as often as it leaves
//! it, always.
//!
//! # The same result every time
//!
//! Lengths are summed as integers (1/65536 of the spacing), so that no order of triangles or threads
//! shows in a result. The hot loops are compiled for several instruction sets and chosen when the
//! program runs; none fuses or reorders floating-point operations, so that all give the same bits. The
//! lattice is anchored to absolute multiples of the spacing, shifted by an
//! irrational fraction so that lines do not run within the faces of axis-parallel boxes: moving the
//! mesh by a multiple of the spacing changes nothing beyond the rounding of its positions, moving it
//! by anything else changes results within their error.

mod columns;
pub(crate) mod crossing;
mod labels;
pub(crate) mod lattice;
mod options;
mod overlap;
mod pairs;
pub(crate) mod raster;
mod scanner;
pub(crate) mod snapped;
mod spans;

pub use columns::CoveredVolumes;
pub use labels::{LabelDistances, TriangleLabels};
pub use options::{Axis, ScanOptions};
pub use overlap::{Overlap, Solid};
pub use pairs::{PairOverlap, PairOverlaps};
pub use scanner::{ColumnScanner, Scan};
