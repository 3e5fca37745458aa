//! Closed shapes with known volumes, for tests, examples and benchmarks.

mod cuboid;
mod icosphere;
mod torus;

use glam::{Affine3A, Vec3};

use crate::{Error, Triangles};

pub use cuboid::cuboid;
pub use icosphere::icosphere;
pub use torus::{Torus, torus};

/// A mesh that owns its triangles and positions (in metres).
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// The faces.
    pub triangles: Triangles,
    /// One position a vertex, in metres.
    pub positions: Vec<Vec3>,
}

impl Mesh {
    /// The mesh moved by `offset`.
    #[must_use]
    pub fn translated(mut self, offset: Vec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p += offset);
        self
    }

    /// The mesh under any affine map. A map that mirrors turns the surface inside out.
    #[must_use]
    pub fn transformed(mut self, target_from_source: Affine3A) -> Self {
        self.positions
            .iter_mut()
            .for_each(|p| *p = target_from_source.transform_point3(*p));
        self
    }

    /// Several meshes as one: shells side by side, in the order given, not welded.
    ///
    /// # Errors
    ///
    /// If the result is too large for [`Triangles::new`].
    pub fn joined<'a>(meshes: impl IntoIterator<Item = &'a Mesh>) -> Result<Self, Error> {
        let mut positions: Vec<Vec3> = Vec::new();
        let mut corners = Vec::new();
        for mesh in meshes {
            let first = positions.len();
            if first + mesh.positions.len() > Triangles::MOST {
                let (found, limit) = (first + mesh.positions.len(), Triangles::MOST);
                return Err(Error::MeshTooLarge {
                    what: "vertices",
                    found,
                    limit,
                });
            }
            // Fits: below 2^31, checked above.
            let shift = first as u32;
            corners.extend(
                mesh.triangles
                    .corners()
                    .iter()
                    .map(|t| t.map(|v| v + shift)),
            );
            positions.extend_from_slice(&mesh.positions);
        }
        let triangles = Triangles::new(positions.len(), &corners)?;
        Ok(Self {
            triangles,
            positions,
        })
    }

    /// Wraps what a maker of this module built.
    fn made(positions: Vec<Vec3>, corners: &[[u32; 3]]) -> Self {
        let triangles = Triangles::new(positions.len(), corners);
        // The makers only emit vertices that they pushed, at three different corners.
        #[expect(
            clippy::expect_used,
            reason = "true by construction, and tested for every maker"
        )]
        let triangles = triangles.expect("makers emit valid triangles");
        Self {
            triangles,
            positions,
        }
    }
}
