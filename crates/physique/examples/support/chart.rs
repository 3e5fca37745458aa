//! Charts as hand-placed SVG.

use std::fmt::Write as _;

/// One axis: what it shows, and how numbers become places.
pub(crate) struct Axis<'a> {
    pub(crate) title: &'a str,
    /// Ascending numbers that get a line and a label.
    pub(crate) ticks: &'a [(f64, &'a str)],
    /// The numbers at both ends.
    pub(crate) range: [f64; 2],
    /// Monotonic: a logarithm, mostly.
    pub(crate) scale: fn(f64) -> f64,
}

impl Axis<'_> {
    /// 0 at the low end, 1 at the high one.
    fn place(&self, number: f64) -> f64 {
        let [low, high] = self.range.map(self.scale);
        ((self.scale)(number) - low) / (high - low)
    }
}

/// A picture of charts side by side.
pub(crate) struct Picture {
    svg: String,
    charts: u32,
}

const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 360.0;
const LEFT: f64 = 70.0;
const TOP: f64 = 34.0;
/// Of the plotted area.
const SIZE: [f64; 2] = [360.0, 260.0];

impl Picture {
    pub(crate) fn new() -> Self {
        Self {
            svg: String::new(),
            charts: 0,
        }
    }

    /// Begins a chart to the right of the others.
    pub(crate) fn chart<'a>(&'a mut self, title: &str, x: Axis<'a>, y: Axis<'a>) -> Chart<'a> {
        let left = f64::from(self.charts) * WIDTH + LEFT;
        self.charts += 1;
        let mut chart = Chart {
            svg: &mut self.svg,
            left,
            x,
            y,
        };
        chart.frame(title);
        chart
    }

    pub(crate) fn finish(self) -> String {
        let width = f64::from(self.charts) * WIDTH;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {HEIGHT}\" \
             font-family=\"sans-serif\" font-size=\"12\">\n\
             <rect width=\"{width}\" height=\"{HEIGHT}\" fill=\"#fff\"/>\n{}</svg>\n",
            self.svg
        )
    }
}

/// A chart that is being drawn.
pub(crate) struct Chart<'a> {
    svg: &'a mut String,
    left: f64,
    x: Axis<'a>,
    y: Axis<'a>,
}

impl Chart<'_> {
    fn at(&self, x: f64, y: f64) -> (f64, f64) {
        (
            self.left + SIZE[0] * self.x.place(x),
            TOP + SIZE[1] * (1.0 - self.y.place(y)),
        )
    }

    fn text(&mut self, x: f64, y: f64, anchor: &str, text: &str) {
        let _ = writeln!(
            self.svg,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{text}</text>"
        );
    }

    fn frame(&mut self, title: &str) {
        let (left, bottom) = (self.left, TOP + SIZE[1]);
        let middle = left + SIZE[0] / 2.0;
        for &(number, label) in self.x.ticks {
            let x = left + SIZE[0] * self.x.place(number);
            let _ = writeln!(
                self.svg,
                "<path d=\"M{x:.1} {TOP}V{bottom}\" stroke=\"#ddd\"/>"
            );
            self.text(x, bottom + 16.0, "middle", label);
        }
        for &(number, label) in self.y.ticks {
            let y = TOP + SIZE[1] * (1.0 - self.y.place(number));
            let _ = writeln!(
                self.svg,
                "<path d=\"M{left} {y:.1}h{}\" stroke=\"#ddd\"/>",
                SIZE[0]
            );
            self.text(left - 6.0, y + 4.0, "end", label);
        }
        let _ = writeln!(
            self.svg,
            "<rect x=\"{left}\" y=\"{TOP}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888\"/>",
            SIZE[0], SIZE[1]
        );
        self.text(middle, TOP - 12.0, "middle", title);
        self.text(middle, bottom + 40.0, "middle", self.x.title);
        let y = TOP + SIZE[1] / 2.0;
        let _ = writeln!(
            self.svg,
            "<text text-anchor=\"middle\" transform=\"translate({:.1} {y:.1}) rotate(-90)\">{}</text>",
            left - 54.0,
            self.y.title
        );
    }

    /// Points; those that fall together are drawn once.
    #[allow(dead_code)] // Not every chart has points.
    pub(crate) fn dots(&mut self, colour: &str, points: &[(f64, f64)]) {
        let mut places: Vec<(i64, i64)> = points
            .iter()
            .map(|&(x, y)| {
                let (x, y) = self.at(x, y);
                (x.round() as i64, y.round() as i64)
            })
            .collect();
        places.sort_unstable();
        places.dedup();
        let path: String = places.iter().map(|(x, y)| format!("M{x} {y}h0")).collect();
        let _ = writeln!(
            self.svg,
            "<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"2.6\" stroke-linecap=\"round\" \
             stroke-opacity=\"0.5\"/>"
        );
    }

    /// A line with its name at the last point.
    #[allow(dead_code)] // Not every chart has lines.
    pub(crate) fn line(&mut self, colour: &str, name: &str, points: &[(f64, f64)]) {
        let places: Vec<_> = points.iter().map(|&(x, y)| self.at(x, y)).collect();
        let path: Vec<_> = places
            .iter()
            .map(|(x, y)| format!("{x:.1} {y:.1}"))
            .collect();
        let _ = writeln!(
            self.svg,
            "<path d=\"M{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
            path.join("L")
        );
        for (x, y) in &places {
            let _ = writeln!(
                self.svg,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>"
            );
        }
        if let Some(&(x, y)) = places.last() {
            self.text(x - 4.0, y - 8.0, "end", name);
        }
    }
}
