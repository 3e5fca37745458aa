//! Limbs told apart: surface just behind an edge of nearer surface is darkened.
//!
//! A limb before a trunk of the same colour would vanish. As draughtsmen do, what lies behind is
//! darkened along the nearer outline (unsharp masking of the depth buffer, Luft, Colditz and
//! Deussen 2006).

use rayon::prelude::*;

use super::projection::ViewTransform;
use super::resolve::Behind;
use crate::{Colour, Image};

/// The depth step between two surfaces, in metres, at which darkening begins and is full.
pub(super) const OUTLINE_STEP: f32 = 0.02;
const FULL_STEP: f32 = 0.12;
/// How dark it gets, and the band's width as a share of the picture's height.
const STRENGTH: f32 = 0.50;
const REACH: f32 = 1.0 / 110.0;

/// Finds how much a place is darkened by nearer surface around it.
struct Outlines<'a> {
    view: &'a ViewTransform,
    nearness: &'a [f32],
    width: usize,
    height: usize,
    taps: Vec<(isize, isize, f32)>,
}

impl Outlines<'_> {
    /// The light that is left at a place of a nearness, 1 for all.
    fn light(&self, column: usize, row: usize, here: f32) -> f32 {
        let depth = self.view.depth(here);
        let mut shade = 0.0;
        for &(dx, dy, weight) in &self.taps {
            let (x, y) = (column.wrapping_add_signed(dx), row.wrapping_add_signed(dy));
            if x < self.width && y < self.height && self.nearness[y * self.width + x] > here {
                let gap = depth - self.view.depth(self.nearness[y * self.width + x]);
                shade +=
                    weight * ((gap - OUTLINE_STEP) / (FULL_STEP - OUTLINE_STEP)).clamp(0.0, 1.0);
            }
        }
        1.0 - STRENGTH * shade.min(1.0)
    }
}

/// Darken the surface of a picture along outlines. `nearness` is that of the nearest surface at
/// each pixel; `behind` tells, for pixels (by index) on an outline, what they show behind it.
pub(super) fn darken(
    view: &ViewTransform,
    nearness: &[f32],
    behind: &[(usize, Behind)],
    image: &mut Image,
) {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let taps = taps((image.height() as f32 * REACH).clamp(1.0, 8.0));
    let outlines = Outlines {
        view,
        nearness,
        width,
        height,
        taps,
    };
    image
        .pixels_mut()
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(row, pixels)| {
            for (column, pixel) in pixels.iter_mut().enumerate() {
                let here = nearness[row * width + column];
                if here > f32::NEG_INFINITY {
                    let light = outlines.light(column, row, here);
                    if light < 1.0 {
                        *pixel = Colour::from_linear(pixel.linear() * light);
                    }
                }
            }
        });
    for &(index, Behind { light, nearness }) in behind {
        let lost = light * (1.0 - outlines.light(index % width, index / width, nearness));
        let pixel = &mut image.pixels_mut()[index];
        *pixel = Colour::from_linear((pixel.linear() - lost).max(glam::Vec3::ZERO));
    }
}

/// Two rings of eight neighbours with weights that fall outwards. At a straight edge half of
/// the neighbours are nearer, so the weights sum to two.
fn taps(reach: f32) -> Vec<(isize, isize, f32)> {
    let ring = |radius: f32, weight: f32| {
        (0..8).map(move |eighth| {
            let (sin, cos) = (eighth as f32 * std::f32::consts::FRAC_PI_4).sin_cos();
            (
                (radius * cos).round() as isize,
                (radius * sin).round() as isize,
                weight / 8.0,
            )
        })
    };
    ring(reach.max(1.0) * 0.5, 1.2)
        .chain(ring(reach.max(1.0), 0.8))
        .collect()
}
