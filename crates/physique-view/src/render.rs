//! From a scene to a picture: find what is visible, then colour it.

mod clip;
mod contour;
mod ground;
mod light;
mod overlay;
mod projection;
mod raster;
mod resolve;
mod shadow;

use rayon::prelude::*;

pub use self::ground::Ground;
pub(crate) use self::projection::ViewTransform;
pub(crate) use self::shadow::GroundShadow;

use self::raster::{Facet, Samples, push_facets};
use self::resolve::{Resolver, Shown};
use crate::{Camera, Image, Scene, ViewError};

/// Rows that one task draws: their samples (128 bytes a pixel) then fit a processor's cache.
const BAND_ROWS: usize = 8;

impl Scene<'_> {
    /// Draw the scene: 8 samples a pixel, shaded in linear light.
    ///
    /// The picture is the same for any number of threads. A body of 13,800 triangles at
    /// 512 x 512 pixels takes some 20 to 45 ms on one core (`cargo bench -p physique-view`).
    ///
    /// # Errors
    /// [`ViewError::BadSize`] or [`ViewError::BadCamera`].
    pub fn render(&self, camera: &Camera, width: u32, height: u32) -> Result<Image, ViewError> {
        camera.check()?;
        let mut image = Image::new(width, height, self.background)?;
        let view = ViewTransform::new(camera, width, height);
        let facets = self.facets(&view, width, height);
        let bands = bin(&facets, height as usize);
        let any_highlighted = facets.iter().any(Facet::highlighted);
        let resolver = Resolver::new(self, view);
        // What hides lines: the nearest surface at each pixel.
        let mut nearness = vec![f32::NEG_INFINITY; image.pixels().len()];
        let band_pixels = BAND_ROWS * width as usize;
        let behind: Vec<_> = image
            .pixels_mut()
            .par_chunks_mut(band_pixels)
            .zip(nearness.par_chunks_mut(band_pixels))
            .zip(&bands)
            .enumerate()
            .flat_map_iter(|(band, ((pixels, nearness), members))| {
                let first_row = (band * BAND_ROWS) as u32;
                let rows = pixels.len() / width as usize;
                let mut surface = Samples::new(width, first_row, rows);
                let mut highlight = any_highlighted.then(|| Samples::new(width, first_row, rows));
                for &member in members {
                    let facet = &facets[member as usize];
                    surface.draw(facet);
                    if let Some(highlight) = highlight.as_mut().filter(|_| facet.highlighted()) {
                        highlight.draw(facet);
                    }
                }
                let shown = Shown {
                    surface: &surface,
                    highlight: highlight.as_ref(),
                };
                let mut behind = Vec::new();
                for (index, (pixel, near)) in pixels.iter_mut().zip(nearness).enumerate() {
                    let column = index as u32 % width;
                    let row = first_row + index as u32 / width;
                    *near = surface.nearness[index]
                        .iter()
                        .copied()
                        .fold(f32::NEG_INFINITY, f32::max);
                    let shown = resolver.pixel(&shown, index, column, row);
                    *pixel = shown.colour;
                    behind.extend(
                        shown
                            .behind
                            .map(|behind| (band * band_pixels + index, behind)),
                    );
                }
                behind
            })
            .collect();
        contour::darken(&view, &nearness, &behind, &mut image);
        overlay::draw(self, &view, &nearness, &mut image);
        Ok(image)
    }

    /// All triangles, projected and clipped, in the scene's order.
    fn facets(&self, view: &ViewTransform, width: u32, height: u32) -> Vec<Facet> {
        let mut facets = Vec::with_capacity(self.triangle_count as usize);
        for prepared in &self.meshes {
            let points: Vec<_> = prepared
                .mesh
                .positions
                .iter()
                .map(|&p| view.to_clip(p))
                .collect();
            for (triangle, corners) in prepared.mesh.triangles.iter().enumerate() {
                let corners = corners.map(|index| points[index as usize]);
                let id = prepared.first_triangle + triangle as u32;
                let highlighted = prepared.is_highlighted(triangle);
                push_facets(&mut facets, view, corners, id, highlighted, (width, height));
            }
        }
        facets
    }
}

/// Which facets touch each band of rows, in drawing order.
fn bin(facets: &[Facet], height: usize) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); height.div_ceil(BAND_ROWS)];
    for (index, facet) in facets.iter().enumerate() {
        let (first, last) = facet.rows();
        for band in &mut bands[first as usize / BAND_ROWS..=last as usize / BAND_ROWS] {
            band.push(index as u32);
        }
    }
    bands
}
