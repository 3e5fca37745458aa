use super::crossing::Crossing;
use super::lattice::Lattice;
use super::raster::Raster;

/// Volumes that a closed surface covers, in cubic metres.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CoveredVolumes {
    /// Inside the surface: winding number 1 or more.
    pub covered: f64,
    /// Where the surface passes through itself: winding number 2 or more, counted once.
    pub doubly_covered: f64,
    /// The same, every place weighted by its winding number (2, 3, …): what `sia` reports.
    pub multiplicity_weighted: f64,
    /// The winding number integrated over all of space, inside-out parts negative: the volume that
    /// [`signed_volume`](crate::signed_volume) gives.
    pub signed: f64,
}

/// Lengths of the step function, in depth units summed over all lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct CoveredLengths {
    covered: i64,
    doubly_covered: i64,
    multiplicity_weighted: i64,
    signed: i64,
}

/// The crossings sorted by line, and along each line.
#[derive(Debug, Clone, Default)]
pub(super) struct Columns {
    /// Where the crossings of every line end; they begin where those of the line before end.
    ends: Vec<u32>,
    crossings: Vec<Crossing>,
    /// Lines whose winding number reaches 2.
    overlapped: Vec<u32>,
    lengths: CoveredLengths,
}

impl Columns {
    /// Sorts what was drawn and measures it.
    pub(super) fn fill(&mut self, raster: &Raster, lattice: &Lattice) {
        self.bucket(raster, lattice.line_count());
        self.overlapped.clear();
        self.lengths = CoveredLengths::default();
        let mut begin = 0;
        for (line, &end) in self.ends.iter().enumerate() {
            let end = end as usize;
            if begin == end {
                continue;
            }
            let column = &mut self.crossings[begin..end];
            sort(column);
            if self.lengths.add(column) >= 2 {
                self.overlapped.push(line as u32);
            }
            begin = end;
        }
    }

    /// The lines whose winding number reaches 2, with their sorted crossings.
    pub(super) fn overlapped(&self) -> impl Iterator<Item = (usize, &[Crossing])> {
        self.overlapped.iter().map(|&line| {
            let line = line as usize;
            let begin = if line == 0 {
                0
            } else {
                self.ends[line - 1] as usize
            };
            (line, &self.crossings[begin..self.ends[line] as usize])
        })
    }

    pub(super) fn volumes(&self, lattice: &Lattice) -> CoveredVolumes {
        let volume = |length: i64| length as f64 * lattice.unit_volume();
        CoveredVolumes {
            covered: volume(self.lengths.covered),
            doubly_covered: volume(self.lengths.doubly_covered),
            multiplicity_weighted: volume(self.lengths.multiplicity_weighted),
            signed: volume(self.lengths.signed),
        }
    }

    /// Groups the crossings by line: a counting sort.
    fn bucket(&mut self, raster: &Raster, line_count: usize) {
        let (lines, crossings) = raster.crossings();
        self.ends.clear();
        self.ends.resize(line_count, 0);
        for &line in lines {
            self.ends[line as usize] += 1;
        }
        // Counts become begins; placing a crossing advances its line's begin towards its end.
        let mut begin = 0;
        for end in &mut self.ends {
            let count = *end;
            *end = begin;
            begin += count;
        }
        self.crossings.resize(crossings.len(), Crossing::default());
        for (&line, &crossing) in lines.iter().zip(crossings) {
            let place = &mut self.ends[line as usize];
            self.crossings[*place as usize] = crossing;
            *place += 1;
        }
    }
}

impl CoveredLengths {
    /// Adds one line's sorted crossings; returns the greatest winding number.
    fn add(&mut self, column: &[Crossing]) -> i64 {
        let (mut winding, mut greatest) = (0, 0);
        for pair in column.windows(2) {
            winding += pair[0].step();
            let length = pair[1].depth() - pair[0].depth();
            self.signed += winding * length;
            self.covered += i64::from(winding >= 1) * length;
            if winding >= 2 {
                self.doubly_covered += length;
                self.multiplicity_weighted += winding * length;
                greatest = winding.max(greatest);
            }
        }
        greatest
    }
}

/// Sorts a line's crossings, mostly two to six of them.
#[inline]
fn sort(column: &mut [Crossing]) {
    if column.len() > 16 {
        column.sort_unstable();
        return;
    }
    for unsorted in 1..column.len() {
        let crossing = column[unsorted];
        let mut place = unsorted;
        while place > 0 && column[place - 1] > crossing {
            column[place] = column[place - 1];
            place -= 1;
        }
        column[place] = crossing;
    }
}
