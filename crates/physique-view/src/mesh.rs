//! The surface to be drawn.

use glam::Vec3;

use crate::{Colour, ViewError};

/// Coordinates beyond this many metres are refused: single precision has no millimetres out there.
pub const MAX_COORDINATE: f32 = 1e5;

/// Where a mesh's colours come from.
#[derive(Clone, Copy, Debug)]
pub enum Colours<'a> {
    /// One for all.
    Uniform(Colour),
    /// One for each vertex, mixed over the triangles.
    PerVertex(&'a [Colour]),
    /// One for each triangle.
    PerTriangle(&'a [Colour]),
}

/// How normals vary over a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Normals are averaged at the vertices (by angle) and mixed over the triangle: round bodies look round.
    #[default]
    Smooth,
    /// One normal a triangle: the mesh itself can be seen.
    Flat,
}

/// A triangle mesh, borrowed: positions in metres, Y up.
///
/// ```
/// use glam::vec3;
/// use physique_view::{Colour, Colours, Mesh, Shading};
/// let mesh = Mesh {
///     positions: &[vec3(0., 0., 0.), vec3(1., 0., 0.), vec3(0., 1., 0.)],
///     triangles: &[[0, 1, 2]],
///     colours: Colours::Uniform(Colour::WHITE),
///     highlighted: &[],
///     shading: Shading::Smooth,
/// };
/// assert!(mesh.check().is_ok());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    /// `[V]` vertex positions in metres.
    pub positions: &'a [Vec3],
    /// `[T]` triangles as vertex numbers; counter-clockwise from outside, though both sides are drawn.
    pub triangles: &'a [[u32; 3]],
    /// The surface's own colours.
    pub colours: Colours<'a>,
    /// `[T]` which triangles are drawn in [`palette::INTERSECTION`](crate::palette::INTERSECTION)
    /// and shine through the body; empty for none.
    pub highlighted: &'a [bool],
    /// Smooth or flat.
    pub shading: Shading,
}

impl Mesh<'_> {
    /// Whether the mesh can be drawn: indices in range, positions finite, lists of the right length.
    ///
    /// # Errors
    /// [`ViewError::IndexOutOfRange`], [`ViewError::BadPosition`] or [`ViewError::LengthMismatch`].
    pub fn check(&self) -> Result<(), ViewError> {
        let vertices = self.positions.len();
        check_positions("vertex", self.positions)?;
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= vertices) {
                return Err(ViewError::IndexOutOfRange {
                    triangle,
                    index,
                    vertices,
                });
            }
        }
        match self.colours {
            Colours::Uniform(_) => {}
            Colours::PerVertex(list) => check_length("colours by vertex", vertices, list.len())?,
            Colours::PerTriangle(list) => {
                check_length("colours by triangle", self.triangles.len(), list.len())?;
            }
        }
        if !self.highlighted.is_empty() {
            check_length(
                "highlighted triangles",
                self.triangles.len(),
                self.highlighted.len(),
            )?;
        }
        Ok(())
    }
}

pub(crate) fn check_positions(what: &'static str, positions: &[Vec3]) -> Result<(), ViewError> {
    // `max_element` may pass over NaN.
    let lies_nowhere = |p: &Vec3| p.is_nan() || p.abs().max_element() > MAX_COORDINATE;
    match positions.iter().position(lies_nowhere) {
        Some(index) => {
            let Vec3 { x, y, z } = positions[index];
            Err(ViewError::BadPosition {
                what,
                index,
                x,
                y,
                z,
            })
        }
        None => Ok(()),
    }
}

fn check_length(what: &'static str, expected: usize, found: usize) -> Result<(), ViewError> {
    if expected == found {
        Ok(())
    } else {
        Err(ViewError::LengthMismatch {
            what,
            expected,
            found,
        })
    }
}

/// Unit vertex normals: triangle normals weighted by the angle at the vertex (Thürmer and Wüthrich 1998),
/// which does not depend on how a surface is cut into triangles.
pub(crate) fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for corners in triangles {
        let points = corners.map(|index| positions[index as usize]);
        let Some(normal) = (points[1] - points[0])
            .cross(points[2] - points[0])
            .try_normalize()
        else {
            continue;
        };
        for corner in 0..3 {
            let to_next = (points[(corner + 1) % 3] - points[corner]).normalize_or_zero();
            let to_last = (points[(corner + 2) % 3] - points[corner]).normalize_or_zero();
            let angle = to_next.dot(to_last).clamp(-1.0, 1.0).acos();
            normals[corners[corner] as usize] += normal * angle;
        }
    }
    for normal in &mut normals {
        *normal = normal.normalize_or_zero();
    }
    normals
}
