use glam::Vec3;

use crate::Error;

/// A coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Axis {
    /// Lines run from side to side.
    X,
    /// Lines run upwards.
    Y,
    /// Lines run from back to front: of a standing person they meet the most surface.
    #[default]
    Z,
}

impl Axis {
    /// The coordinates of `p` across the axis (two, so that they and the axis are right-handed) and
    /// along it.
    #[inline(always)]
    pub(crate) fn across_and_along(self, p: Vec3) -> ([f32; 2], f32) {
        match self {
            Self::X => ([p.y, p.z], p.x),
            Self::Y => ([p.z, p.x], p.y),
            Self::Z => ([p.x, p.y], p.z),
        }
    }

    /// The inverse of [`Axis::across_and_along`].
    #[inline]
    pub(crate) fn position([u, v]: [f32; 2], along: f32, axis: Self) -> Vec3 {
        match axis {
            Self::X => Vec3::new(along, u, v),
            Self::Y => Vec3::new(v, along, u),
            Self::Z => Vec3::new(u, v, along),
        }
    }
}

/// How a [`ColumnScanner`](crate::ColumnScanner) lays its lines.
///
/// ```
/// use physique_geometry::{Axis, ScanOptions};
///
/// let fine = ScanOptions { spacing: 0.005, ..ScanOptions::default() };
/// assert_eq!(fine.axis, Axis::Z);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanOptions {
    /// Distance between neighbouring lines, in metres; default 0.01. The cost grows with the inverse
    /// of its square, the error falls about linearly with it (see the example `spacing`).
    pub spacing: f32,
    /// Direction of the lines; default [`Axis::Z`].
    pub axis: Axis,
    /// Most line positions that the triangles' boxes may hold, summed over all triangles; default 2^24
    /// (a body at 1 cm needs some 30,000). A scan allocates up to 12 bytes for each.
    pub most_crossings: u64,
}

impl ScanOptions {
    /// Least spacing allowed, in metres.
    pub const LEAST_SPACING: f32 = 1e-5;
    /// Greatest spacing allowed, in metres.
    pub const MOST_SPACING: f32 = 1e3;
    /// Most lines side by side, and most spacings along a line, that a mesh may extend over.
    pub const MOST_LINES_ASIDE: usize = 4000;

    pub(crate) fn check(&self) -> Result<(), Error> {
        let (least, most) = (Self::LEAST_SPACING, Self::MOST_SPACING);
        if (least..=most).contains(&self.spacing) {
            return Ok(());
        }
        Err(Error::Spacing {
            found: self.spacing,
            least,
            most,
        })
    }
}

impl Default for ScanOptions {
    fn default() -> Self {
        Self {
            spacing: 0.01,
            axis: Axis::default(),
            most_crossings: 1 << 24,
        }
    }
}
