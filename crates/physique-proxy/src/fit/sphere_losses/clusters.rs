//! Points that are near to each other, with a ball around them.

use multiversion::multiversion;

use super::SamplePoints;

/// Most points of a cluster: a few vectors.
pub(super) const MOST: usize = 64;

/// Clusters of a list of points.
#[derive(Debug, Default)]
pub(super) struct Clusters {
    pub(super) list: Vec<Cluster>,
    /// Balls around the clusters that have points inside the body: x, y, z, radius.
    pub(super) inside: [Vec<f32>; 4],
    /// Which clusters those are.
    pub(super) inside_numbers: Vec<usize>,
}

/// A stretch of the points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cluster {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) centre: [f32; 3],
    /// No point is farther from the centre, rounding included.
    pub(super) radius: f32,
}

impl Clusters {
    pub(super) fn set(&mut self, points: &SamplePoints) {
        self.list.clear();
        self.inside.iter_mut().for_each(Vec::clear);
        self.inside_numbers.clear();
        let mut start = 0;
        for &end in &points.stretches {
            while start < end {
                let last = end.min(start + MOST);
                let (cluster, inside) = cluster(points, start, last);
                if inside {
                    let [x, y, z] = cluster.centre;
                    let values = [x, y, z, cluster.radius];
                    for (list, value) in self.inside.iter_mut().zip(values) {
                        list.push(value);
                    }
                    self.inside_numbers.push(self.list.len());
                }
                self.list.push(cluster);
                start = last;
            }
        }
    }
}

/// One cluster, and whether a point of it lies inside the body.
#[multiversion(targets = "simd")]
fn cluster(points: &SamplePoints, start: usize, end: usize) -> (Cluster, bool) {
    let arrays = [&points.x, &points.y, &points.z].map(|values| &values[start..end]);
    let centre = arrays.map(|values| {
        let (least, most) = extremes(values);
        0.5 * (least + most)
    });
    let [x, y, z] = arrays;
    let mut square = 0.0_f32;
    for ((x, y), z) in x.iter().zip(y).zip(z) {
        let (dx, dy, dz) = (x - centre[0], y - centre[1], z - centre[2]);
        let here = dx * dx + dy * dy + dz * dz;
        square = if here > square { here } else { square };
    }
    let cluster = Cluster {
        start,
        end,
        centre,
        radius: square.sqrt() + 1e-5,
    };
    (cluster, extremes(&points.distance[start..end]).0 < 0.0)
}

#[inline(always)]
fn extremes(values: &[f32]) -> (f32, f32) {
    let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
    for &value in values {
        least = if value < least { value } else { least };
        most = if value > most { value } else { most };
    }
    (least, most)
}
