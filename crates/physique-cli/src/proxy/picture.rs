//! A picture of bodies and their spheres.

use std::path::Path;
use std::sync::Arc;

use anyhow::Result;
use glam::Vec3;
use physique::body::{Body, BodyModel, Joint};
use physique::geometry::shapes::icosphere;
use physique::proxy::{SphereBody, SphereProxy};
use physique_view::{Bounds, Camera, Colour, Colours, Image, Mesh, Scene, Shading, View, palette};

/// Pixels of one cell.
const CELL: [u32; 2] = [360, 420];

/// Draws three shapes, each as body and as spheres, from the front (above) and the side (below).
pub(super) fn draw(path: &Path, proxy: &SphereProxy, model: &Arc<BodyModel>) -> Result<()> {
    let columns = SHAPES.len() as u32 * 2;
    let mut sheet = Image::new(columns * CELL[0], 2 * CELL[1], palette::STAGE)?;
    for (column, betas) in SHAPES.iter().enumerate() {
        let body = Body::new(
            Arc::clone(model),
            &betas[..betas.len().min(model.beta_count())],
        )?;
        let spheres = SphereMesh::new(&proxy.of_body(&body)?);
        let skin = vec![palette::CENTRE; body.rest_vertices().len()];
        let surfaces = [
            (body.rest_vertices(), model.triangles(), &skin),
            (
                &spheres.positions[..],
                &spheres.triangles[..],
                &spheres.colours,
            ),
        ];
        let Some(bounds) = Bounds::around(body.rest_vertices()) else {
            continue;
        };
        for (half, (positions, triangles, colours)) in surfaces.iter().enumerate() {
            let mut scene = Scene::new();
            scene.add_mesh(Mesh {
                positions,
                triangles,
                colours: Colours::PerVertex(colours),
                highlighted: &[],
                shading: Shading::Smooth,
            })?;
            for (row, view) in [View::FRONT, View::SIDE].iter().enumerate() {
                let aspect = CELL[0] as f32 / CELL[1] as f32;
                let camera = Camera::framing(&bounds, view, aspect, 0.06);
                let cell = scene.render(&camera, CELL[0], CELL[1])?;
                let x = (2 * column + half) as u32 * CELL[0];
                sheet.paste(&cell, x.into(), (row as u32 * CELL[1]).into());
            }
        }
    }
    sheet.write_png(path)?;
    Ok(())
}

/// A middling, a slight and a heavy body.
const SHAPES: [[f32; 10]; 3] = [
    [0.0; 10],
    [-1.5, -1.5, -1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.5, 1.5, 1.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
];

/// All spheres as one mesh, coloured by the joint that they follow.
struct SphereMesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    colours: Vec<Colour>,
}

impl SphereMesh {
    fn new(body: &SphereBody) -> Self {
        let ball = icosphere(1.0, 3);
        let mut mesh = Self {
            positions: Vec::new(),
            triangles: Vec::new(),
            colours: Vec::new(),
        };
        for sphere in 0..body.sphere_count() {
            let first = mesh.positions.len() as u32;
            let (centre, radius) = (body.centres[sphere], body.radii[sphere]);
            mesh.positions
                .extend(ball.positions.iter().map(|&p| centre + radius * p));
            let corners = ball.triangles.corners().iter();
            mesh.triangles
                .extend(corners.map(|corners| corners.map(|corner| first + corner)));
            let colour = colour(body.dominant_joint(sphere));
            mesh.colours.resize(mesh.positions.len(), colour);
        }
        mesh
    }
}

/// Neighbouring joints differ.
fn colour(joint: Joint) -> Colour {
    const TINTS: [Colour; 4] = [
        palette::LEFT,
        palette::CENTRE,
        palette::RIGHT,
        palette::FAINT_INK,
    ];
    TINTS[joint.index() % TINTS.len()]
}
