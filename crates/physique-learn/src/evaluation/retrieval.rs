//! R-precision and multimodal distance.

use super::Points;
use super::points::distance;
use crate::Error;

/// Captions that a motion's own is looked for among. Another number gives other results.
pub const RETRIEVAL_BATCH: usize = 32;

/// How well motions are told apart by their captions; batches are added one after the other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Retrieval {
    pairs: usize,
    /// Pairs whose motion is the closest to the caption, among the two closest, the three closest.
    among: [usize; 3],
    distances: f64,
}

impl Retrieval {
    /// Adds a batch of pairs: caption i belongs to motion i.
    ///
    /// # Errors
    /// [`Error::Input`] unless there are as many captions as motions, of one width.
    pub fn add(&mut self, captions: &Points, motions: &Points) -> Result<(), Error> {
        let size = |points: &Points| [points.len(), points.width()];
        if size(captions) != size(motions) {
            let expected = format!("{:?}, as the captions'", size(captions));
            let found = format!("{:?}", size(motions));
            return Err(Error::input("Embeddings of motions", expected, found));
        }
        for (index, caption) in captions.iter().enumerate() {
            let own = distance(caption, motions.point(index));
            let others = motions.iter().enumerate();
            // Of equal distances the first counts as closer, as sorting by distance has it.
            let closer = others
                .filter(|&(other, motion)| {
                    let found = distance(caption, motion);
                    found < own || found == own && other < index
                })
                .count();
            for (most, hits) in self.among.iter_mut().enumerate() {
                *hits += usize::from(closer <= most);
            }
            self.distances += own;
            self.pairs += 1;
        }
        Ok(())
    }

    /// Pairs so far.
    pub const fn pairs(&self) -> usize {
        self.pairs
    }

    /// Share of captions whose motion is the closest, among the two closest, the three closest:
    /// top-1, top-2 and top-3. NaN before the first pair.
    pub fn precision(&self) -> [f64; 3] {
        self.among.map(|hits| hits as f64 / self.pairs as f64)
    }

    /// Mean distance of a motion from its caption. NaN before the first pair.
    pub fn multimodal_distance(&self) -> f64 {
        self.distances / self.pairs as f64
    }
}
