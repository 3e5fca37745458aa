//! Lines and dots laid over the surface, fainter where it hides them.

use super::projection::ViewTransform;
use crate::paint::segment_coverage;
use crate::{Colour, Image, Scene};

/// Draw the scene's lines and dots; `nearness` is that of the nearest surface at each pixel.
pub(super) fn draw(scene: &Scene<'_>, view: &ViewTransform, nearness: &[f32], image: &mut Image) {
    for line in &scene.polylines {
        let points: Vec<_> = line
            .points
            .iter()
            .map(|&point| view.to_pixel(point))
            .collect();
        let segments: Vec<_> = points
            .windows(2)
            .filter_map(|pair| {
                Some(Segment {
                    from: pair[0]?,
                    to: pair[1]?,
                })
            })
            .collect();
        stroke(
            image,
            nearness,
            &segments,
            line.width,
            line.colour,
            line.hidden_opacity,
        );
    }
    for dot in &scene.dots {
        if let Some(point) = view.to_pixel(dot.position) {
            let segment = Segment {
                from: point,
                to: point,
            };
            stroke(
                image,
                nearness,
                &[segment],
                dot.diameter,
                dot.colour,
                dot.hidden_opacity,
            );
        }
    }
}

/// A straight piece in pixels, with nearness at its ends.
#[derive(Clone, Copy)]
struct Segment {
    from: (f32, f32, f32),
    to: (f32, f32, f32),
}

/// Draw segments as one stroke: where they overlap, the pixel is covered once.
fn stroke(
    image: &mut Image,
    nearness: &[f32],
    segments: &[Segment],
    width: f32,
    colour: Colour,
    hidden_opacity: f32,
) {
    let (columns, rows) = (image.width() as usize, image.height() as usize);
    let mut opacity = std::collections::BTreeMap::new();
    for Segment { from, to } in segments {
        let reach = width * 0.5 + 1.0;
        // Casts saturate, so that points far outside give empty ranges.
        let span = |a: f32, b: f32, limit: usize| {
            ((a.min(b) - reach).floor().max(0.0) as usize)
                ..((a.max(b) + reach).ceil().max(0.0) as usize).min(limit)
        };
        for row in span(from.1, to.1, rows) {
            for column in span(from.0, to.0, columns) {
                let centre = (column as f32 + 0.5, row as f32 + 0.5);
                let (coverage, along) =
                    segment_coverage(centre, (from.0, from.1), (to.0, to.1), width);
                if coverage <= 0.0 {
                    continue;
                }
                let here = from.2 + (to.2 - from.2) * along;
                let index = row * columns + column;
                let visible = if here >= nearness[index] {
                    1.0
                } else {
                    hidden_opacity
                };
                let cell = opacity.entry(index).or_insert(0.0_f32);
                *cell = cell.max(coverage * visible);
            }
        }
    }
    for (index, opacity) in opacity {
        image.blend(
            (index % columns) as i64,
            (index / columns) as i64,
            colour,
            opacity,
        );
    }
}
