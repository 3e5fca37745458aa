//! Rectangles, lines and discs.

use crate::{Colour, Image};

/// How much of a pixel a thick segment with round ends covers, and how far along (0 to 1) the
/// nearest point of the segment lies. Coverage falls from one to zero over one pixel.
pub(crate) fn segment_coverage(
    pixel: (f32, f32),
    from: (f32, f32),
    to: (f32, f32),
    width: f32,
) -> (f32, f32) {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length_squared = dx * dx + dy * dy;
    let along = if length_squared > 0.0 {
        (((pixel.0 - from.0) * dx + (pixel.1 - from.1) * dy) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let distance = (pixel.0 - from.0 - dx * along).hypot(pixel.1 - from.1 - dy * along);
    // A line thinner than a pixel is drawn a pixel wide and fainter.
    let faint = width.clamp(0.0, 1.0);
    (
        ((width.max(1.0) * 0.5 + 0.5 - distance).clamp(0.0, 1.0)) * faint,
        along,
    )
}

impl Image {
    /// Fill a rectangle; its edges may lie between pixels.
    pub fn fill_rectangle(
        &mut self,
        left: f32,
        top: f32,
        width: f32,
        height: f32,
        colour: Colour,
        opacity: f32,
    ) {
        let (right, bottom) = (left + width, top + height);
        let overlap = |pixel: i64, low: f32, high: f32| {
            ((pixel + 1) as f32).min(high) - (pixel as f32).max(low)
        };
        for y in self.rows(top, bottom) {
            for x in self.columns(left, right) {
                let coverage = overlap(x, left, right).max(0.0) * overlap(y, top, bottom).max(0.0);
                self.blend(x, y, colour, coverage * opacity);
            }
        }
    }

    /// Draw connected lines `width` pixels wide with round ends and joints; each pixel is covered once.
    pub fn stroke(&mut self, points: &[(f32, f32)], width: f32, colour: Colour, opacity: f32) {
        let mut covered = std::collections::BTreeMap::new();
        let reach = width * 0.5 + 1.0;
        for pair in points.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            for y in self.rows(from.1.min(to.1) - reach, from.1.max(to.1) + reach) {
                for x in self.columns(from.0.min(to.0) - reach, from.0.max(to.0) + reach) {
                    let centre = (x as f32 + 0.5, y as f32 + 0.5);
                    let (coverage, _) = segment_coverage(centre, from, to, width);
                    if coverage > 0.0 {
                        let cell = covered.entry((y, x)).or_insert(0.0_f32);
                        *cell = cell.max(coverage);
                    }
                }
            }
        }
        for ((y, x), coverage) in covered {
            self.blend(x, y, colour, coverage * opacity);
        }
    }

    /// Fill a disc.
    pub fn fill_disc(&mut self, x: f32, y: f32, diameter: f32, colour: Colour) {
        self.stroke(&[(x, y), (x, y)], diameter, colour, 1.0);
    }

    fn columns(&self, from: f32, to: f32) -> std::ops::Range<i64> {
        clamped(from, to, self.width())
    }

    fn rows(&self, from: f32, to: f32) -> std::ops::Range<i64> {
        clamped(from, to, self.height())
    }
}

/// The pixels between two edges, inside the picture; casts saturate and NaN gives an empty range.
fn clamped(from: f32, to: f32, limit: u32) -> std::ops::Range<i64> {
    (from.floor().max(0.0) as i64)..(to.ceil() as i64).min(i64::from(limit))
}
