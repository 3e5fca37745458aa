use glam::{DVec3, Vec3};

use super::overlap::Overlap;

/// Overlap of two labels with each other (or of a label with itself).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairOverlap {
    /// The two labels, the lower one first.
    pub labels: [u8; 2],
    /// Doubly covered volume in cubic metres. The volumes of all pairs add up to
    /// [`CoveredVolumes::doubly_covered`](super::CoveredVolumes::doubly_covered).
    pub volume: f64,
    /// Centroid of that volume, in metres.
    pub centroid: Vec3,
    /// Lower corner of the box around the overlap, in metres (on the lines: half a spacing smaller on
    /// average than the overlap itself).
    pub least: Vec3,
    /// Upper corner of the box around the overlap, in metres.
    pub most: Vec3,
    /// Length of the longest stretch along a line, in metres.
    pub longest: f32,
}

/// Adds up overlaps by unordered pair of labels.
///
/// Reuse one for many frames: it allocates only when made.
#[derive(Debug, Clone)]
pub struct PairOverlaps {
    label_count: usize,
    /// Row by row: the higher label is the row, the lower one the column.
    sums: Vec<Sum>,
    /// Which sums are not empty, in the order in which they were first met.
    met: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Sum {
    volume: f64,
    moment: DVec3,
    least: Vec3,
    most: Vec3,
    longest: f32,
}

impl Sum {
    const EMPTY: Self = Self {
        volume: 0.0,
        moment: DVec3::ZERO,
        least: Vec3::INFINITY,
        most: Vec3::NEG_INFINITY,
        longest: 0.0,
    };
}

impl PairOverlaps {
    /// For labels below `label_count` (256 at most).
    #[must_use]
    pub fn new(label_count: usize) -> Self {
        let label_count = label_count.min(256);
        let sums = vec![Sum::EMPTY; label_count * (label_count + 1) / 2];
        Self {
            label_count,
            sums,
            met: Vec::new(),
        }
    }

    /// Forgets everything added, keeps the memory.
    pub fn clear(&mut self) {
        for &place in &self.met {
            self.sums[place as usize] = Sum::EMPTY;
        }
        self.met.clear();
    }

    /// Adds one overlap to its pair.
    ///
    /// # Panics
    ///
    /// If a label is not below the label count.
    pub fn add(&mut self, overlap: &Overlap) {
        let [low, high] = overlap.labels().map(usize::from);
        assert!(
            high < self.label_count,
            "label {high} of {}",
            self.label_count
        );
        let place = high * (high + 1) / 2 + low;
        let sum = &mut self.sums[place];
        if sum.volume == 0.0 {
            self.met.push(place as u32);
        }
        sum.volume += overlap.volume;
        sum.moment += overlap.middle().as_dvec3() * overlap.volume;
        sum.least = sum.least.min(overlap.start).min(overlap.end);
        sum.most = sum.most.max(overlap.start).max(overlap.end);
        sum.longest = sum.longest.max(overlap.start.distance(overlap.end));
    }

    /// What one pair of labels overlaps, in either order; `None` if it does not.
    #[must_use]
    pub fn between(&self, a: u8, b: u8) -> Option<PairOverlap> {
        let (low, high) = (usize::from(a.min(b)), usize::from(a.max(b)));
        let sum = self.sums.get(high * (high + 1) / 2 + low)?;
        (sum.volume > 0.0).then(|| sum.overlap([low as u8, high as u8]))
    }

    /// All pairs that overlap, in order of their higher and then their lower label.
    pub fn iter(&self) -> impl Iterator<Item = PairOverlap> {
        let pairs = (0..self.label_count).flat_map(|high| (0..=high).map(move |low| [low, high]));
        let overlapping = pairs.zip(&self.sums).filter(|(_, sum)| sum.volume > 0.0);
        overlapping.map(|(labels, sum)| sum.overlap(labels.map(|label| label as u8)))
    }
}

impl Sum {
    fn overlap(&self, labels: [u8; 2]) -> PairOverlap {
        PairOverlap {
            labels,
            volume: self.volume,
            centroid: (self.moment / self.volume).as_vec3(),
            least: self.least,
            most: self.most,
            longest: self.longest,
        }
    }
}
