//! `sia`: the voxel protocol of the published self-intersection metric.
//!
//! The metric of "self-intersection aware" motion generation lays 35 x 35 x 35 points over the unit
//! ball into which the body's rest pose was normalised ([`UnitBall`]), counts at every point how often
//! the posed body covers it, and reports
//!
//! * the volume: the sum of all counts, times 216 cm³,
//! * the self-intersection: the sum of the counts that are 2 or more, times 216 cm³,
//! * and the percentage of the one to the other.
//!
//! [`SiaCounter`] gives the winding number at these points, by a column scan;
//! [`reference::sia_counts`](crate::reference::sia_counts) the published rule itself, by 13 rays from
//! every point. They agree on closed surfaces except where a ray grazes an edge: the published rule
//! tests triangles as open sets in single precision, so that a ray exactly through an edge misses
//! both its triangles, and the integer division by 13 then turns a count of 1 into 0.
//!
//! # Where the metric misleads
//!
//! Report it to compare with published numbers; to judge a motion, use the
//! [`ColumnScanner`](crate::ColumnScanner).
//!
//! * **It counts multiply.** A doubly covered point adds 2, a triply covered one 3: two spheres that
//!   share a lens of 145 litres report 290 litres.
//! * **Its voxels are not its grid.** A voxel counts 0.06³, but the points are 2/34 = 0.0588 apart:
//!   volumes come out 6 % too large.
//! * **It moves in steps of 432 cm³**, one doubly covered point, some fifty times the volume of a
//!   fingertip. At this spacing a body's overlap is off by anything from -100 % to +47 %; a reported
//!   mean of 447 is about one point a frame.
//! * **It forgets what leaves the ball.** The ball is that of the rest pose, and points outside it are
//!   not counted: raised arms are not measured.
//! * **It is not in cubic centimetres of the body**: lengths are relative to the rest pose's radius,
//!   about 0.9 to 1 m.

mod counter;
mod unit_ball;

pub use counter::{SiaCounter, SiaVolumes};
pub use unit_ball::UnitBall;

use glam::Vec3;

/// Points along each edge of the grid.
pub const POINTS_ASIDE: usize = 35;
/// What a point counts for, in cubic centimetres of the unit ball: 6 cm cubed, though the points are
/// 2/34 = 5.88 cm apart.
pub const VOXEL_CM3: f64 = 216.0;

/// Coordinate of grid point `k` of 35 along an axis, rounded as the published code does.
pub(crate) fn coordinate(k: usize) -> f32 {
    2.0 * k as f32 / (POINTS_ASIDE - 1) as f32 - 1.0
}

/// Whether a grid point is counted, rounded as the published code does.
pub(crate) fn in_ball(point: Vec3) -> bool {
    point.x * point.x + point.y * point.y + point.z * point.z <= 1.0
}
