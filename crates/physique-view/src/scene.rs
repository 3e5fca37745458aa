//! What stands before the camera.

use glam::Vec3;

use crate::mesh::{check_positions, vertex_normals};
use crate::render::{Ground, GroundShadow};
use crate::{Bounds, Colour, Mesh, ViewError, palette};

/// A line through space, drawn a few pixels wide: the path of the root, a bone, an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// Its points in metres.
    pub points: Vec<Vec3>,
    /// Its colour.
    pub colour: Colour,
    /// Its width in pixels.
    pub width: f32,
    /// Its opacity where a body hides it, 0 to 1; in the open it is opaque.
    pub hidden_opacity: f32,
}

/// A dot in space: a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// Where, in metres.
    pub position: Vec3,
    /// Its colour.
    pub colour: Colour,
    /// Its diameter in pixels.
    pub diameter: f32,
    /// Its opacity where a body hides it, 0 to 1.
    pub hidden_opacity: f32,
}

/// Meshes on a floor, checked and prepared once, to be drawn from any number of cameras.
///
/// ```
/// use glam::vec3;
/// use physique_view::{Bounds, Camera, Colours, Mesh, Scene, Shading, View, palette};
/// let positions = [vec3(-0.5, 0., 0.), vec3(0.5, 0., 0.), vec3(0., 1., 0.)];
/// let mut scene = Scene::new();
/// scene.add_mesh(Mesh {
///     positions: &positions,
///     triangles: &[[0, 1, 2]],
///     colours: Colours::Uniform(palette::LEFT),
///     highlighted: &[],
///     shading: Shading::Smooth,
/// })?;
/// let bounds = Bounds::around(&positions).expect("three points");
/// let image = scene.render(&Camera::framing(&bounds, &View::FRONT, 1.0, 0.1), 64, 64)?;
/// assert_ne!(image.pixel(32, 40), image.pixel(0, 0));
/// # Ok::<(), physique_view::ViewError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene<'a> {
    pub(crate) meshes: Vec<PreparedMesh<'a>>,
    pub(crate) triangle_count: u32,
    pub(crate) polylines: Vec<Polyline>,
    pub(crate) dots: Vec<Dot>,
    pub(crate) ground: Option<Ground>,
    pub(crate) shadow: Option<GroundShadow>,
    pub(crate) background: Colour,
}

/// A mesh with its vertex normals and the number of its first triangle in the scene.
#[derive(Clone, Debug)]
pub(crate) struct PreparedMesh<'a> {
    pub(crate) mesh: Mesh<'a>,
    pub(crate) normals: Vec<Vec3>,
    pub(crate) first_triangle: u32,
}

impl<'a> Scene<'a> {
    /// Nothing, before [`palette::STAGE`].
    #[must_use]
    pub fn new() -> Self {
        Self {
            meshes: Vec::new(),
            triangle_count: 0,
            polylines: Vec::new(),
            dots: Vec::new(),
            ground: None,
            shadow: None,
            background: palette::STAGE,
        }
    }

    /// Add a surface.
    ///
    /// # Errors
    /// Those of [`Mesh::check`], and [`ViewError::TooManyTriangles`].
    pub fn add_mesh(&mut self, mesh: Mesh<'a>) -> Result<&mut Self, ViewError> {
        self.add_meshes([mesh])
    }

    /// Add several surfaces; the shadow is found once, for all.
    ///
    /// # Errors
    /// Those of [`Scene::add_mesh`]; then none after the faulty one has been added.
    pub fn add_meshes(
        &mut self,
        meshes: impl IntoIterator<Item = Mesh<'a>>,
    ) -> Result<&mut Self, ViewError> {
        let result = meshes.into_iter().try_for_each(|mesh| {
            mesh.check()?;
            let found = self.triangle_count as usize + mesh.triangles.len();
            // The greatest number stands for "no triangle".
            let count = u32::try_from(found).ok().filter(|&count| count < u32::MAX);
            let count = count.ok_or(ViewError::TooManyTriangles { found })?;
            let normals = vertex_normals(mesh.positions, mesh.triangles);
            self.meshes.push(PreparedMesh {
                mesh,
                normals,
                first_triangle: self.triangle_count,
            });
            self.triangle_count = count;
            Ok(())
        });
        self.cast_shadow();
        result.map(|()| self)
    }

    /// Add a line.
    ///
    /// # Errors
    /// [`ViewError::BadPosition`].
    pub fn add_polyline(&mut self, polyline: Polyline) -> Result<&mut Self, ViewError> {
        check_positions("point of a line", &polyline.points)?;
        self.polylines.push(polyline);
        Ok(self)
    }

    /// Add a dot.
    ///
    /// # Errors
    /// [`ViewError::BadPosition`].
    pub fn add_dot(&mut self, dot: Dot) -> Result<&mut Self, ViewError> {
        check_positions("dot", &[dot.position])?;
        self.dots.push(dot);
        Ok(self)
    }

    /// Lay a floor.
    ///
    /// # Errors
    /// [`ViewError::BadPosition`] if its height, middle or radius is not finite.
    pub fn set_ground(&mut self, ground: Ground) -> Result<&mut Self, ViewError> {
        let [x, z] = ground.centre;
        check_positions(
            "ground",
            &[Vec3::new(x, ground.height, z), Vec3::splat(ground.radius)],
        )?;
        self.ground = Some(ground);
        self.cast_shadow();
        Ok(self)
    }

    /// Change what is behind everything.
    pub fn set_background(&mut self, colour: Colour) -> &mut Self {
        self.background = colour;
        self
    }

    /// The box around all surfaces, `None` if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        self.meshes
            .iter()
            .filter_map(|prepared| Bounds::around(prepared.mesh.positions))
            .reduce(Bounds::union)
    }

    fn cast_shadow(&mut self) {
        self.shadow = self.ground.and_then(|ground| {
            let triangles = self.meshes.iter().flat_map(|prepared| {
                let mesh = prepared.mesh;
                mesh.triangles
                    .iter()
                    .map(move |corners| corners.map(|i| mesh.positions[i as usize]))
            });
            GroundShadow::new(triangles, ground.height)
        });
    }
}

impl Default for Scene<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl PreparedMesh<'_> {
    pub(crate) fn is_highlighted(&self, triangle: usize) -> bool {
        self.mesh
            .highlighted
            .get(triangle)
            .copied()
            .unwrap_or(false)
    }
}
