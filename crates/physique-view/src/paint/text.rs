//! Words, in the embedded typeface Inter (see `assets/CARD.md`).

use std::sync::LazyLock;

use ab_glyph::{Font as _, FontRef, GlyphId, ScaleFont as _, point};

use crate::{Colour, Image};

/// How heavy letters are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weight {
    /// For reading.
    #[default]
    Regular,
    /// For titles.
    SemiBold,
}

/// Where a line of text stands relative to its x coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// It begins there.
    #[default]
    Left,
    /// Its middle is there.
    Centre,
    /// It ends there.
    Right,
}

/// How a line of text looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextStyle {
    /// The size of an em in pixels.
    pub size: f32,
    /// Regular or semi-bold.
    pub weight: Weight,
    /// The letters' colour.
    pub colour: Colour,
    /// Left, centre or right.
    pub align: Align,
}

static REGULAR: LazyLock<FontRef<'static>> =
    LazyLock::new(|| embedded(include_bytes!("../../assets/Inter-Regular.ttf")));
static SEMI_BOLD: LazyLock<FontRef<'static>> =
    LazyLock::new(|| embedded(include_bytes!("../../assets/Inter-SemiBold.ttf")));

#[expect(
    clippy::expect_used,
    reason = "the bytes are fixed when this is compiled, and a test reads both"
)]
fn embedded(bytes: &'static [u8]) -> FontRef<'static> {
    FontRef::try_from_slice(bytes).expect("an embedded font is a valid TrueType file")
}

fn font(weight: Weight) -> &'static FontRef<'static> {
    match weight {
        Weight::Regular => &REGULAR,
        Weight::SemiBold => &SEMI_BOLD,
    }
}

/// The glyphs of a line and the x coordinate at which each begins, then the width of all; in pixels.
fn lay_out(text: &str, size: f32, weight: Weight) -> (Vec<(GlyphId, f32)>, f32) {
    let font = font(weight);
    let scaled = font.as_scaled(scale(font, size));
    let mut x = 0.0;
    let glyphs = text
        .chars()
        .map(|character| {
            let glyph = font.glyph_id(if character.is_control() {
                ' '
            } else {
                character
            });
            let start = x;
            x += scaled.h_advance(glyph);
            (glyph, start)
        })
        .collect();
    (glyphs, x)
}

/// The scale at which an em is `size` pixels: the library counts from ascender to descender instead.
fn scale(font: &FontRef<'_>, size: f32) -> f32 {
    font.units_per_em()
        .map_or(size, |em| size * font.height_unscaled() / em)
}

/// The width of a line of text in pixels, at `size` pixels an em.
///
/// ```
/// use physique_view::{Weight, text_width};
/// assert!(text_width("walking", 20.0, Weight::Regular) < text_width("walking", 20.0, Weight::SemiBold));
/// ```
#[must_use]
pub fn text_width(text: &str, size: f32, weight: Weight) -> f32 {
    lay_out(text, size, weight).1
}

/// The text itself if it fits, or as much of it as does with an ellipsis in the middle: of long
/// file names, the beginning and the end tell most.
pub(crate) fn fit(text: &str, size: f32, weight: Weight, width: f32) -> String {
    if text_width(text, size, weight) <= width {
        return text.to_owned();
    }
    let characters: Vec<char> = text.chars().collect();
    let shortened = |kept: usize| {
        let (head, tail) = (kept.div_ceil(2), kept / 2);
        let mut short: String = characters[..head].iter().collect();
        short.push('…');
        short.extend(&characters[characters.len() - tail..]);
        short
    };
    // Longest first would be slow for hostile titles: halve the range instead.
    let (mut fits, mut too_long) = (0, characters.len());
    while too_long - fits > 1 {
        let middle = fits.midpoint(too_long);
        if text_width(&shortened(middle), size, weight) <= width {
            fits = middle
        } else {
            too_long = middle
        }
    }
    shortened(fits)
}

impl Image {
    /// Write one line of text; `y` is the baseline. Characters that the font lacks show as a box.
    ///
    /// ```
    /// use physique_view::{Align, Colour, Image, TextStyle, Weight};
    /// let mut image = Image::new(80, 24, Colour::WHITE)?;
    /// let style = TextStyle { size: 16.0, weight: Weight::Regular, colour: Colour::BLACK, align: Align::Left };
    /// image.write_text("0.25 s", 4.0, 18.0, &style);
    /// # Ok::<(), physique_view::ViewError>(())
    /// ```
    pub fn write_text(&mut self, text: &str, x: f32, y: f32, style: &TextStyle) {
        let font = font(style.weight);
        let (glyphs, width) = lay_out(text, style.size, style.weight);
        let left = match style.align {
            Align::Left => x,
            Align::Centre => x - width * 0.5,
            Align::Right => x - width,
        };
        for (glyph, start) in glyphs {
            let placed =
                glyph.with_scale_and_position(scale(font, style.size), point(left + start, y));
            let Some(outline) = font.outline_glyph(placed) else {
                continue;
            };
            let corner = outline.px_bounds().min;
            outline.draw(|column, row, coverage| {
                let x = corner.x as i64 + i64::from(column);
                let y = corner.y as i64 + i64::from(row);
                // Dark letters mixed in linear light look thin: strengthen their edges.
                self.blend(x, y, style.colour, coverage.clamp(0.0, 1.0).powf(0.75));
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_fonts_can_be_read_and_have_the_figures_of_one_width() {
        for weight in [Weight::Regular, Weight::SemiBold] {
            let widths: Vec<f32> = ('0'..='9')
                .map(|figure| text_width(&figure.to_string(), 32.0, weight))
                .collect();
            assert!(
                widths
                    .iter()
                    .all(|&width| width == widths[0] && width > 10.0),
                "{widths:?}"
            );
        }
    }

    #[test]
    fn labels_have_their_signs() {
        for sign in "³²°·–—→←±×µ…≥≤−".chars() {
            assert_ne!(
                font(Weight::Regular).glyph_id(sign).0,
                0,
                "no glyph for {sign}"
            );
        }
    }

    #[test]
    fn long_text_is_shortened_to_fit() {
        let long = "a rather long name of a file.bvh".repeat(20);
        let short = fit(&long, 14.0, Weight::Regular, 120.0);
        assert!(text_width(&short, 14.0, Weight::Regular) <= 120.0);
        assert!(short.starts_with("a rather") && short.ends_with(".bvh") && short.contains('…'));
        assert_eq!(fit("short", 14.0, Weight::Regular, 120.0), "short");
    }
}
