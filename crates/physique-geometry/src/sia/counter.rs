use glam::Vec3;
use multiversion::multiversion;

use super::{POINTS_ASIDE, VOXEL_CM3, coordinate, in_ball};
use crate::column_scan::crossing::Crossing;
use crate::column_scan::lattice::DEPTH_UNITS;
use crate::column_scan::raster::Raster;
use crate::column_scan::snapped::{Placement, SnappedVertices};
use crate::{Axis, Error, Triangles};

/// Vertices are snapped across the lines to 1/2^18 of the spacing: a quarter of a micrometre.
const SUBCELL_BITS: u32 = 18;
/// Positions farther out than this do not belong into a unit ball, and would overflow subcells.
const FARTHEST: f32 = 64.0;
/// Far more than 35 x 35 lines through a million triangles.
const MOST_CROSSINGS: u64 = 1 << 24;
/// Lines along z, x fastest.
const LINES: usize = POINTS_ASIDE * POINTS_ASIDE;

/// What the `sia` protocol reports for one pose, in cubic centimetres of the unit ball.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SiaVolumes {
    /// Sum of the counts that are 2 or more, times [`VOXEL_CM3`].
    pub self_intersection_cm3: f64,
    /// Sum of all counts, negative ones included, times [`VOXEL_CM3`].
    pub volume_cm3: f64,
}

impl SiaVolumes {
    /// From the sum of the counts of 2 or more, and of all counts.
    #[must_use]
    pub fn from_sums(sum_of_multiple: i64, sum_of_all: i64) -> Self {
        Self {
            self_intersection_cm3: sum_of_multiple as f64 * VOXEL_CM3,
            volume_cm3: sum_of_all as f64 * VOXEL_CM3,
        }
    }

    /// Self-intersection over volume in percent; `None` if the volume is zero.
    #[must_use]
    pub fn percent(&self) -> Option<f64> {
        (self.volume_cm3 != 0.0).then(|| 100.0 * self.self_intersection_cm3 / self.volume_cm3)
    }
}

/// Counts how often a closed surface covers the points of the `sia` grid, pose after pose.
///
/// Lines along z run through the grid's points; the winding number at every point follows from the
/// crossings before it. Made once a mesh (and a thread); after the first poses it allocates nothing.
///
/// ```
/// use physique_geometry::{shapes, sia::SiaCounter};
///
/// let ball = shapes::icosphere(0.5, 4);
/// let mut counter = SiaCounter::new(&ball.triangles)?;
/// let volumes = counter.count(&ball.positions)?;
/// assert_eq!(volumes.self_intersection_cm3, 0.0);
/// // 0.524 m³, and the protocol's 6 % on top.
/// assert!((volumes.volume_cm3 / 1e6 - 0.524 * 1.06).abs() < 0.005);
/// # Ok::<(), physique_geometry::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SiaCounter {
    triangles: Triangles,
    snapped: SnappedVertices,
    raster: Raster,
    /// Change of the winding number from the point before, by z, then line; one layer beyond the grid.
    steps: Vec<i16>,
    /// All bits set where a point lies in the ball, else none.
    in_ball: Vec<i16>,
    /// Winding numbers of the current layer.
    winding: Vec<i16>,
}

impl SiaCounter {
    /// Prepares to count a closed surface.
    ///
    /// # Errors
    ///
    /// If the surface is not closed.
    pub fn new(triangles: &Triangles) -> Result<Self, Error> {
        triangles.require_closed()?;
        Ok(Self {
            triangles: triangles.clone(),
            snapped: SnappedVertices::default(),
            raster: Raster::default(),
            steps: vec![0; LINES * (POINTS_ASIDE + 1)],
            in_ball: points().map(|point| -i16::from(in_ball(point))).collect(),
            winding: vec![0; LINES],
        })
    }

    /// Counts one pose, whose positions were moved into the [unit ball](super::UnitBall).
    ///
    /// # Errors
    ///
    /// If there is not one finite position a vertex, one is farther than 64 from the origin, or the
    /// surface winds more than 32,767 times around a point.
    pub fn count(&mut self, ball_positions: &[Vec3]) -> Result<SiaVolumes, Error> {
        self.step(ball_positions)?;
        let (sum_of_multiple, sum_of_all) =
            sum_counts(&self.steps, &self.in_ball, &mut self.winding);
        Ok(SiaVolumes::from_sums(sum_of_multiple, sum_of_all))
    }

    /// The count at every point: x slowest, z fastest; 0 outside the ball. For tests and pictures;
    /// [`count`](Self::count) is faster.
    ///
    /// # Errors
    ///
    /// As [`count`](Self::count).
    pub fn counts(&mut self, ball_positions: &[Vec3]) -> Result<Vec<i32>, Error> {
        self.step(ball_positions)?;
        let mut by_point = vec![0; LINES * POINTS_ASIDE];
        self.winding.fill(0);
        let steps = self.steps.iter().zip(&self.in_ball).enumerate();
        for (number, (step, in_ball)) in steps {
            let (x, y, z) = (
                number % POINTS_ASIDE,
                number / POINTS_ASIDE % POINTS_ASIDE,
                number / LINES,
            );
            let winding = &mut self.winding[number % LINES];
            *winding = winding.wrapping_add(*step);
            by_point[(x * POINTS_ASIDE + y) * POINTS_ASIDE + z] = i32::from(*winding & in_ball);
        }
        Ok(by_point)
    }

    /// Finds the steps of the winding number along all lines.
    fn step(&mut self, positions: &[Vec3]) -> Result<(), Error> {
        let farthest = self.triangles.check_positions(positions)?;
        if farthest > FARTHEST {
            return Err(Error::OutsideUnitBall {
                distance: farthest,
                limit: FARTHEST,
            });
        }
        let cells = (POINTS_ASIDE - 1) as f32 / 2.0;
        let lines = [POINTS_ASIDE; 2];
        let placement = Placement {
            axis: Axis::Z,
            origin: [-1.0; 2],
            origin_depth: -1.0,
            subcells: cells * (1 << SUBCELL_BITS) as f32,
            depth_units: cells * DEPTH_UNITS,
            lines,
        };
        self.snapped.snap::<SUBCELL_BITS>(positions, &placement);
        self.raster
            .draw::<SUBCELL_BITS>(&self.triangles, &self.snapped, lines, MOST_CROSSINGS)?;
        self.steps.fill(0);
        let (lines, crossings) = self.raster.crossings();
        for (&line, &crossing) in lines.iter().zip(crossings) {
            let step = &mut self.steps[first_layer_behind(crossing) * LINES + line as usize];
            *step = step
                .checked_add(crossing.step() as i16)
                .ok_or(Error::TooManyCoverings)?;
        }
        Ok(())
    }
}

/// Adds up the steps along the lines; returns the sum of the counts of 2 or more, and of all counts.
#[multiversion(targets = "simd")]
fn sum_counts(steps: &[i16], in_ball: &[i16], winding: &mut [i16]) -> (i64, i64) {
    winding.fill(0);
    let (mut sum_of_multiple, mut sum_of_all) = (0_i64, 0_i64);
    for (steps, in_ball) in steps.chunks_exact(LINES).zip(in_ball.chunks_exact(LINES)) {
        // Narrow sums for a layer: they hold 1,225 counts of 16 bits.
        let (mut multiple, mut all) = (0_i32, 0_i32);
        for ((winding, step), in_ball) in winding.iter_mut().zip(steps).zip(in_ball) {
            *winding = winding.wrapping_add(*step);
            let count = *winding & in_ball;
            all += i32::from(count);
            multiple += if count >= 2 { i32::from(count) } else { 0 };
        }
        sum_of_multiple += i64::from(multiple);
        sum_of_all += i64::from(all);
    }
    (sum_of_multiple, sum_of_all)
}

/// The grid's points in the order of the layers: x fastest, z slowest.
fn points() -> impl Iterator<Item = Vec3> {
    (0..LINES * POINTS_ASIDE).map(|number| {
        let (x, y, z) = (
            number % POINTS_ASIDE,
            number / POINTS_ASIDE % POINTS_ASIDE,
            number / LINES,
        );
        Vec3::new(coordinate(x), coordinate(y), coordinate(z))
    })
}

/// The first layer at or behind a crossing; 35 if there is none.
fn first_layer_behind(crossing: Crossing) -> usize {
    let units = DEPTH_UNITS as i64;
    let layer = (crossing.depth() + units - 1).div_euclid(units);
    layer.clamp(0, POINTS_ASIDE as i64) as usize
}
