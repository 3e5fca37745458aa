use glam::Vec3;

use super::columns::Columns;
use super::crossing::Crossing;
use super::labels::TriangleLabels;
use super::lattice::Lattice;
use super::spans::{MOST_CONSIDERED, Span, Spans};

/// A stretch of a line along which the winding number is 2 or more and does not change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Where it begins, in metres.
    pub start: Vec3,
    /// Where it ends, in metres; farther along the line.
    pub end: Vec3,
    /// Its length times the area of a lattice cell, in cubic metres.
    pub volume: f64,
    /// How many solids cover it, at least 2.
    pub winding: u32,
    /// The two solids that it is attributed to, the first one entered first. Where more than two
    /// overlap these are the two whose labels are farthest apart.
    pub solids: [Solid; 2],
}

impl Overlap {
    /// The labels of both solids, the lower one first.
    #[must_use]
    pub fn labels(&self) -> [u8; 2] {
        let [a, b] = self.solids.map(|solid| solid.label);
        [a.min(b), a.max(b)]
    }

    /// Half way between start and end.
    #[must_use]
    pub fn middle(&self) -> Vec3 {
        self.start.midpoint(self.end)
    }
}

/// A solid that a line runs through: the triangle where it enters and the one where it leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Solid {
    /// Where the line enters.
    pub enter_triangle: u32,
    /// Where the line leaves.
    pub leave_triangle: u32,
    /// Label of whichever of the two is nearer to the overlap (the entered one if equally near): the
    /// surface that is passed through.
    pub label: u8,
}

/// Calls `visit` for every overlap, line by line, along each line in order.
pub(super) fn visit(
    columns: &Columns,
    lattice: &Lattice,
    labels: &TriangleLabels,
    scratch: &mut Spans,
    mut visit: impl FnMut(&Overlap),
) {
    for (line, column) in columns.overlapped() {
        scratch.find(column, labels);
        // The spans that cover the current stretch.
        let Spans {
            spans, covering, ..
        } = &mut *scratch;
        covering.clear();
        for (number, pair) in column.windows(2).enumerate() {
            // Spans are in order of entering: this crossing opens the next one, or closes one.
            match spans.binary_search_by_key(&number, |span| span.enter) {
                Ok(opened) => covering.push(opened),
                Err(_) => covering.retain(|&span| spans[span].leave != number),
            }
            let units = pair[1].depth() - pair[0].depth();
            if covering.len() < 2 || units == 0 {
                continue;
            }
            let stretch = Stretch {
                column,
                start: pair[0].depth(),
                end: pair[1].depth(),
                labels,
            };
            visit(&Overlap {
                start: lattice.point(line, stretch.start),
                end: lattice.point(line, stretch.end),
                volume: units as f64 * lattice.unit_volume(),
                winding: covering.len() as u32,
                solids: stretch.farthest_pair(spans, covering),
            });
        }
    }
}

/// One stretch of constant winding on a line.
struct Stretch<'a> {
    column: &'a [Crossing],
    start: i64,
    end: i64,
    labels: &'a TriangleLabels,
}

impl Stretch<'_> {
    /// The two covering solids whose labels are farthest apart, the first entered among equals.
    fn farthest_pair(&self, spans: &[Span], covering: &[usize]) -> [Solid; 2] {
        let considered = &covering[covering.len().saturating_sub(MOST_CONSIDERED)..];
        let solid = |number: usize| self.solid(spans[considered[number]]);
        let mut best = [solid(0), solid(1)];
        let mut greatest = self.distance(best);
        for second in 2..considered.len() {
            for first in 0..second {
                let pair = [solid(first), solid(second)];
                let distance = self.distance(pair);
                if distance > greatest {
                    (best, greatest) = (pair, distance);
                }
            }
        }
        best
    }

    fn distance(&self, [a, b]: [Solid; 2]) -> u8 {
        self.labels.distances().between(a.label, b.label)
    }

    fn solid(&self, span: Span) -> Solid {
        let (enter, leave) = (self.column[span.enter], self.column[span.leave]);
        let before = self.start - enter.depth();
        let after = leave.depth() - self.end;
        let nearest = if before <= after { enter } else { leave };
        Solid {
            enter_triangle: enter.triangle(),
            leave_triangle: leave.triangle(),
            label: self.labels.of(nearest.triangle()),
        }
    }
}
