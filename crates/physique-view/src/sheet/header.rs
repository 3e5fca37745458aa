//! Title, subtitle, legend and captions.

use super::ContactSheet;
use super::layout::{Layout, MARGIN, TEXT_LINE, TEXT_SIZE, TITLE_SIZE};
use crate::paint::fit;
use crate::{Align, Image, TextStyle, Weight, palette, text_width};

/// The second line's baseline under the first one's, and the space a legend's swatch takes.
const SWATCH: f32 = 12.0;

pub(super) fn draw_header(sheet: &ContactSheet<'_>, layout: &Layout, image: &mut Image) {
    let (left, right) = (MARGIN as f32, (layout.width - MARGIN) as f32);
    let mut baseline = MARGIN as f32;
    if !sheet.title.is_empty() {
        let style = TextStyle {
            size: TITLE_SIZE,
            weight: Weight::SemiBold,
            colour: palette::INK,
            align: Align::Left,
        };
        baseline += TITLE_SIZE * 0.78;
        image.write_text(
            &fit(&sheet.title, style.size, style.weight, right - left),
            left,
            baseline,
            &style,
        );
        baseline += 16.0;
    }
    let style = TextStyle {
        size: TEXT_SIZE,
        weight: Weight::Regular,
        colour: palette::FAINT_INK,
        align: Align::Left,
    };
    baseline += TEXT_SIZE * 0.8;
    let legend_left = draw_legend(sheet, right, baseline, &style, image);
    let room = (legend_left - 24.0 - left).max(0.0);
    image.write_text(
        &fit(&sheet.subtitle, style.size, style.weight, room),
        left,
        baseline,
        &style,
    );
    for (line, caption) in sheet.captions.iter().enumerate() {
        let baseline = (layout.captions_top + line as u32 * TEXT_LINE) as f32 + TEXT_SIZE;
        image.write_text(
            &fit(caption, style.size, style.weight, right - left),
            left,
            baseline,
            &style,
        );
    }
}

/// Draw the legend to end at `right`; returns where it begins.
fn draw_legend(
    sheet: &ContactSheet<'_>,
    right: f32,
    baseline: f32,
    style: &TextStyle,
    image: &mut Image,
) -> f32 {
    let mut x = right;
    for (name, colour) in sheet.legend.iter().rev() {
        x -= text_width(name, style.size, style.weight);
        image.write_text(name, x, baseline, style);
        x -= SWATCH + 6.0;
        image.fill_rectangle(
            x.round(),
            baseline.round() - SWATCH + 1.0,
            SWATCH,
            SWATCH,
            *colour,
            1.0,
        );
        x -= 18.0;
    }
    x + 18.0
}
