//! Sixteen triangles side by side.

use super::separation::RELATIVE_ERROR;
use super::tree::Aabb;
use crate::Triangles;
use glam::Vec3;

/// Triangles a leaf: the `f32` lanes of the widest vectors.
pub(super) const LANES: usize = 16;

pub(super) const ALL_LANES: u32 = (1 << LANES) - 1;

/// One number a triangle.
pub(super) type Lanes = [f32; LANES];
/// Names no vertex: unused lanes share vertices with nothing.
const NO_VERTEX: u32 = u32::MAX;

/// Triangles as structure of arrays.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Leaf {
    pub(super) count: usize,
    pub(super) triangles: [u32; LANES],
    /// The vertices at every corner.
    pub(super) vertices: [[u32; LANES]; 3],
    /// By corner, then by axis.
    pub(super) corners: [[Lanes; 3]; 3],
    /// Boxes; empty in unused lanes.
    pub(super) least: [Lanes; 3],
    pub(super) most: [Lanes; 3],
    /// Normals, twice the area long.
    pub(super) normal: [Lanes; 3],
    /// How wrong the distance of a point to the plane (times the normal's length) may be, over the
    /// point's distance to the first corner.
    pub(super) slack: Lanes,
}

impl Leaf {
    /// Leaves for triangles in this order, not yet fitted to any pose.
    pub(super) fn fill(triangles: &Triangles, order: &[u32]) -> Vec<Self> {
        let fill = |chunk: &[u32]| {
            let mut leaf = Self::empty();
            leaf.count = chunk.len();
            for (lane, &triangle) in chunk.iter().enumerate() {
                leaf.triangles[lane] = triangle;
                for (corner, &vertex) in triangles.corners()[triangle as usize].iter().enumerate() {
                    leaf.vertices[corner][lane] = vertex;
                }
            }
            leaf
        };
        order.chunks(LANES).map(fill).collect()
    }

    fn empty() -> Self {
        Self {
            count: 0,
            triangles: [0; LANES],
            vertices: [[NO_VERTEX; LANES]; 3],
            corners: [[[0.0; LANES]; 3]; 3],
            least: [[f32::INFINITY; LANES]; 3],
            most: [[f32::NEG_INFINITY; LANES]; 3],
            normal: [[0.0; LANES]; 3],
            slack: [0.0; LANES],
        }
    }

    /// Takes over a pose.
    pub(super) fn refit(&mut self, positions: &[Vec3]) {
        for corner in 0..3 {
            for lane in 0..self.count {
                let position = positions[self.vertices[corner][lane] as usize];
                for axis in 0..3 {
                    self.corners[corner][axis][lane] = position[axis];
                }
            }
        }
        let [a, b, c] = &self.corners;
        for axis in 0..3 {
            for lane in 0..self.count {
                let (a, b, c) = (a[axis][lane], b[axis][lane], c[axis][lane]);
                self.least[axis][lane] = a.min(b).min(c);
                self.most[axis][lane] = a.max(b).max(c);
            }
        }
        for lane in 0..LANES {
            let u = [0, 1, 2].map(|axis| b[axis][lane] - a[axis][lane]);
            let v = [0, 1, 2].map(|axis| c[axis][lane] - a[axis][lane]);
            self.normal[0][lane] = u[1] * v[2] - u[2] * v[1];
            self.normal[1][lane] = u[2] * v[0] - u[0] * v[2];
            self.normal[2][lane] = u[0] * v[1] - u[1] * v[0];
            self.slack[lane] = RELATIVE_ERROR * length(u) * length(v);
        }
    }

    /// The box around all its triangles.
    pub(super) fn bounds(&self) -> Aabb {
        let least = |axis: usize| {
            self.least[axis]
                .iter()
                .copied()
                .fold(f32::INFINITY, f32::min)
        };
        let most = |axis: usize| {
            self.most[axis]
                .iter()
                .copied()
                .fold(f32::NEG_INFINITY, f32::max)
        };
        Aabb {
            least: Vec3::new(least(0), least(1), least(2)),
            most: Vec3::new(most(0), most(1), most(2)),
        }
    }

    pub(super) fn triangle(&self, lane: usize) -> [Vec3; 3] {
        self.corners
            .map(|[x, y, z]| Vec3::new(x[lane], y[lane], z[lane]))
    }

    pub(super) fn vertices(&self, lane: usize) -> [u32; 3] {
        self.vertices.map(|corner| corner[lane])
    }

    #[inline(always)]
    pub(super) fn bounds_of(&self, lane: usize) -> Aabb {
        let vector = |lanes: &[Lanes; 3]| Vec3::new(lanes[0][lane], lanes[1][lane], lanes[2][lane]);
        Aabb {
            least: vector(&self.least),
            most: vector(&self.most),
        }
    }
}

/// Sum of the absolute coordinates.
fn length([x, y, z]: [f32; 3]) -> f32 {
    x.abs() + y.abs() + z.abs()
}
