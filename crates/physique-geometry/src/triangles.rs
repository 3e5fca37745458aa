use std::sync::Arc;

use glam::Vec3;
use multiversion::multiversion;

use crate::Error;

/// The faces of a triangle mesh: three vertex indices each, checked once and then trusted.
///
/// Cloning is cheap (the indices are shared), so that every thread's scanner can own one.
///
/// ```
/// use physique_geometry::{Triangles, shapes};
///
/// let cube = shapes::cuboid([1.0, 1.0, 1.0].into());
/// assert_eq!(cube.triangles.len(), 12);
/// assert!(cube.triangles.require_closed().is_ok());
/// # Ok::<(), physique_geometry::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Triangles {
    corners: Arc<[[u32; 3]]>,
    vertex_count: usize,
}

impl Triangles {
    /// Most triangles, and most vertices, that a mesh may have: indices are 31 bits wide.
    pub const MOST: usize = 1 << 31;

    /// Takes the faces of a mesh of `vertex_count` vertices.
    ///
    /// # Errors
    ///
    /// If a triangle names a vertex that does not exist or one vertex twice, or if there are more
    /// than [`Triangles::MOST`] triangles or vertices.
    pub fn new(vertex_count: usize, corners: &[[u32; 3]]) -> Result<Self, Error> {
        for (what, found) in [("triangles", corners.len()), ("vertices", vertex_count)] {
            if found > Self::MOST {
                let limit = Self::MOST;
                return Err(Error::MeshTooLarge { what, found, limit });
            }
        }
        for (triangle, &[a, b, c]) in corners.iter().enumerate() {
            if let Some(&vertex) = [a, b, c].iter().find(|&&v| v as usize >= vertex_count) {
                return Err(Error::VertexOutOfRange {
                    triangle,
                    vertex,
                    vertex_count,
                });
            }
            if a == b || c == a || b == c {
                let vertex = if a == b { a } else { c };
                return Err(Error::RepeatedVertex { triangle, vertex });
            }
        }
        Ok(Self {
            corners: corners.into(),
            vertex_count,
        })
    }

    /// The three vertices of every triangle, counter-clockwise seen from outside.
    #[must_use]
    pub fn corners(&self) -> &[[u32; 3]] {
        &self.corners
    }

    /// Number of triangles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    /// Whether there is no triangle at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// Number of vertices that the triangles may name.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// Checks that the surface is closed and consistently oriented: every directed edge is met by as
    /// many triangles as its opposite. Several shells, and edges that more than two triangles share,
    /// are allowed: their winding number is still well defined.
    ///
    /// Sorts the edges: O(n log n).
    ///
    /// # Errors
    ///
    /// Names the first edge, in order of its lower and then its higher vertex, that is not met.
    pub fn require_closed(&self) -> Result<(), Error> {
        // One entry a directed edge, keyed by the undirected one.
        let mut edges: Vec<(u32, u32, bool)> = Vec::with_capacity(3 * self.len());
        for &[a, b, c] in self.corners() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                edges.push((from.min(to), from.max(to), from < to));
            }
        }
        edges.sort_unstable();
        for edge in edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            let forward = edge.iter().filter(|entry| entry.2).count();
            let backward = edge.len() - forward;
            if forward != backward {
                let (from, to, _) = edge[0];
                return Err(Error::OpenEdge {
                    from,
                    to,
                    forward,
                    backward,
                });
            }
        }
        Ok(())
    }

    /// Checks that there is one finite position a vertex; returns the greatest absolute coordinate.
    pub(crate) fn check_positions(&self, positions: &[Vec3]) -> Result<f32, Error> {
        if positions.len() != self.vertex_count {
            let (expected, found) = (self.vertex_count, positions.len());
            return Err(Error::PositionCount { expected, found });
        }
        let farthest = farthest_coordinate(positions);
        if farthest.is_finite() {
            return Ok(farthest);
        }
        let culprit = positions.iter().enumerate().find(|(_, p)| !p.is_finite());
        match culprit {
            Some((vertex, &position)) => Err(Error::NotFinite { vertex, position }),
            None => Ok(farthest),
        }
    }
}

/// The greatest absolute coordinate; not finite if any is not.
#[multiversion(targets = "simd")]
fn farthest_coordinate(positions: &[Vec3]) -> f32 {
    // Without their sign, the bits of numbers are in the numbers' order, infinity and NaN last; and
    // the order of integers, unlike that of floats, lets the compiler compare many at a time.
    let magnitude = |x: f32| x.abs().to_bits();
    let farthest = positions.iter().fold(0, |farthest: u32, p| {
        farthest
            .max(magnitude(p.x))
            .max(magnitude(p.y))
            .max(magnitude(p.z))
    });
    f32::from_bits(farthest)
}
