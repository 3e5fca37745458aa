//! Which leaving crossing belongs to which entering one.
//!
//! Along a line a closed surface is entered as often as it is left; a *span* is one entering crossing
//! with the leaving crossing that ends the same solid. When two solids overlap partly, the first one
//! entered is also the first one left (enter torso, enter hand, leave torso, leave hand), when one is
//! inside the other it is the last one left. The winding number cannot tell these apart; the labels
//! can. A leaving crossing ends the open span whose entering label is nearest to its own, the most
//! recently entered one among equals.

use super::crossing::Crossing;
use super::labels::TriangleLabels;

/// Of more open spans than this, only the most recently entered are looked at: it bounds the work on
/// hostile input, a body never has as many.
pub(super) const MOST_CONSIDERED: usize = 16;

/// One solid on a line: the numbers of its two crossings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Span {
    pub(super) enter: usize,
    pub(super) leave: usize,
}

/// The spans of one line, in order of entering, and scratch to find them.
#[derive(Debug, Clone, Default)]
pub(super) struct Spans {
    pub(super) spans: Vec<Span>,
    /// Numbers of the spans that are open, in order of entering.
    open: Vec<usize>,
    /// Room for the visitor: the spans that cover a stretch, in order of entering.
    pub(super) covering: Vec<usize>,
}

impl Spans {
    /// Matches the sorted crossings of one line.
    pub(super) fn find(&mut self, column: &[Crossing], labels: &TriangleLabels) {
        self.spans.clear();
        self.open.clear();
        // Leaving crossings that nothing preceded: the surface is inside out there, and as many
        // entering crossings only bring the winding number back to zero.
        let mut debt = 0_usize;
        for (number, &crossing) in column.iter().enumerate() {
            if !crossing.leaving() {
                if debt > 0 {
                    debt -= 1;
                } else {
                    self.open.push(self.spans.len());
                    self.spans.push(Span {
                        enter: number,
                        leave: number,
                    });
                }
            } else if let Some(place) = self.nearest_open(column, crossing, labels) {
                let span = self.open.remove(place);
                self.spans[span].leave = number;
            } else {
                debt += 1;
            }
        }
    }

    /// Place among the open spans of the one that `leaving` ends.
    fn nearest_open(
        &self,
        column: &[Crossing],
        leaving: Crossing,
        labels: &TriangleLabels,
    ) -> Option<usize> {
        let label = labels.of(leaving.triangle());
        let distance = |&place: &usize| {
            let enter = column[self.spans[self.open[place]].enter];
            labels
                .distances()
                .between(labels.of(enter.triangle()), label)
        };
        // Most recent first: `min_by_key` returns the first of equals.
        (0..self.open.len())
            .rev()
            .take(MOST_CONSIDERED)
            .min_by_key(distance)
    }
}
