//! A value over time: a strip beneath a contact sheet.

use crate::paint::fit;
use crate::{Align, Colour, Image, TextStyle, Weight, palette, text_width};

/// A value sampled at even times.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What it is, with its unit: "Self-intersection (cm³)".
    pub label: String,
    /// The time between two values, in seconds.
    pub seconds_per_value: f32,
    /// The values from time zero; NaN leaves a gap.
    pub values: Vec<f32>,
    /// The line's colour.
    pub colour: Colour,
}

/// Height of a chart with its labels, in pixels.
pub(crate) const HEIGHT: u32 = 150;

/// The size of the scales' numbers, in pixels.
const TICK_SIZE: f32 = 12.0;

/// Where a chart stands, in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChartArea {
    pub(crate) left: f32,
    pub(crate) top: f32,
    pub(crate) width: f32,
}

/// The part of the area that holds the curve, and its scales.
struct Plot {
    left: f32,
    right: f32,
    top: f32,
    bottom: f32,
    duration: f32,
    low: f32,
    high: f32,
}

impl Plot {
    fn x(&self, seconds: f32) -> f32 {
        self.left + (self.right - self.left) * (seconds / self.duration).clamp(0.0, 1.0)
    }

    fn y(&self, value: f32) -> f32 {
        self.bottom
            - (self.bottom - self.top)
                * ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

/// Draw a chart with marks at the times (in seconds) of the moments shown.
pub(crate) fn draw_chart(chart: &Chart, marks: &[f32], area: ChartArea, image: &mut Image) {
    // Beyond this the range itself would overflow.
    let finite = || {
        chart
            .values
            .iter()
            .copied()
            .filter(|value| value.abs() < 1e30)
    };
    let value_step = tick_step(
        finite().fold(0.0, f32::max) - finite().fold(0.0, f32::min),
        3.0,
    );
    let last_value = chart.values.len().saturating_sub(1) as f32 * chart.seconds_per_value;
    let last_mark = marks
        .iter()
        .copied()
        .filter(|mark| mark.is_finite())
        .fold(0.0, f32::max);
    let duration = if last_value.is_finite() {
        last_value.max(last_mark)
    } else {
        last_mark
    };
    let mut plot = Plot {
        left: area.left,
        right: area.left + area.width - 12.0,
        top: area.top + 30.0,
        bottom: area.top + HEIGHT as f32 - 26.0,
        duration: if duration > 0.0 { duration } else { 1.0 },
        low: (finite().fold(0.0, f32::min) / value_step).floor() * value_step,
        high: (finite().fold(0.0, f32::max) / value_step).ceil().max(1.0) * value_step,
    };
    let label_width = |value| text_width(&decimal(value, value_step), TICK_SIZE, Weight::Regular);
    plot.left += label_width(plot.low).max(label_width(plot.high)).max(24.0) + 10.0;
    let heading = TextStyle {
        size: 14.0,
        weight: Weight::SemiBold,
        colour: palette::INK,
        align: Align::Left,
    };
    let label = fit(&chart.label, heading.size, heading.weight, area.width);
    image.write_text(&label, area.left, area.top + 12.0, &heading);
    draw_scales(&plot, value_step, image);
    draw_marks(&plot, marks, image);
    draw_curve(chart, &plot, image);
    for &mark in marks.iter().filter(|mark| mark.is_finite()) {
        let nearest = (mark / chart.seconds_per_value).round();
        if let Some(value) = chart
            .values
            .get(nearest as usize)
            .filter(|value| value.is_finite())
        {
            image.fill_disc(plot.x(mark), plot.y(*value), 8.0, palette::PAPER);
            image.fill_disc(plot.x(mark), plot.y(*value), 6.0, chart.colour);
        }
    }
}

fn draw_scales(plot: &Plot, value_step: f32, image: &mut Image) {
    let faint = TextStyle {
        size: TICK_SIZE,
        weight: Weight::Regular,
        colour: palette::FAINT_INK,
        align: Align::Right,
    };
    for step in 0..=((plot.high - plot.low) / value_step).round() as usize {
        let value = plot.low + step as f32 * value_step;
        let y = plot.y(value).round() + 0.5;
        image.stroke(&[(plot.left, y), (plot.right, y)], 1.0, palette::RULE, 1.0);
        image.write_text(
            &decimal(value, value_step),
            plot.left - 8.0,
            y + 4.0,
            &faint,
        );
    }
    let centred = TextStyle {
        align: Align::Centre,
        ..faint
    };
    let step = tick_step(plot.duration, (plot.right - plot.left) / 90.0);
    for tick in 0..=(plot.duration / step * 1.000_1).floor() as usize {
        let seconds = tick as f32 * step;
        let label = format!("{} s", decimal(seconds, step));
        image.write_text(&label, plot.x(seconds), plot.bottom + 18.0, &centred);
    }
}

fn draw_marks(plot: &Plot, marks: &[f32], image: &mut Image) {
    for &mark in marks.iter().filter(|mark| mark.is_finite()) {
        let x = plot.x(mark).round() + 0.5;
        image.stroke(
            &[(x, plot.top), (x, plot.bottom)],
            1.0,
            palette::FAINT_INK,
            0.35,
        );
    }
}

/// The curve over a light area; values that share a column of pixels become their range.
fn draw_curve(chart: &Chart, plot: &Plot, image: &mut Image) {
    let zero = plot.y(0.0);
    let mut run: Vec<(f32, f32)> = Vec::new();
    let flush = |run: &mut Vec<(f32, f32)>, image: &mut Image| {
        for pair in run.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let first = from.0.round() as i64;
            for x in first..to.0.round() as i64 {
                let along = ((x as f32 + 0.5 - from.0) / (to.0 - from.0)).clamp(0.0, 1.0);
                let y = from.1 + (to.1 - from.1) * along;
                image.fill_rectangle(
                    x as f32,
                    y.min(zero),
                    1.0,
                    (zero - y).abs(),
                    chart.colour,
                    0.14,
                );
            }
        }
        image.stroke(run, 1.8, chart.colour, 1.0);
        run.clear();
    };
    for (index, &value) in chart.values.iter().enumerate() {
        if value.is_finite() {
            run.push((
                plot.x(index as f32 * chart.seconds_per_value),
                plot.y(value),
            ));
        } else {
            flush(&mut run, image);
        }
    }
    flush(&mut run, image);
}

/// The least of 1, 2 and 5 times a power of ten that parts a range into at most `parts`.
fn tick_step(range: f32, parts: f32) -> f32 {
    if !(range > 0.0 && range.is_finite()) {
        return 1.0;
    }
    let rough = range / parts.max(1.0);
    let power = 10.0_f32.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|&step| step >= rough)
        .unwrap_or(rough)
}

/// A tick's number with as many decimals as its step needs.
fn decimal(value: f32, step: f32) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(tick_step(10.0, 5.0), 2.0);
        assert_eq!(tick_step(0.9, 3.0), 0.5);
        assert_eq!(tick_step(312.0, 3.0), 200.0);
        assert_eq!(tick_step(f32::NAN, 3.0), 1.0);
        assert_eq!(tick_step(0.0, 3.0), 1.0);
    }

    #[test]
    fn numbers_have_the_decimals_of_their_step() {
        assert_eq!(decimal(0.4, 0.2), "0.4");
        assert_eq!(decimal(400.0, 200.0), "400");
    }
}
