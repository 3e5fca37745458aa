//! The emptiness loss: spheres must not stand outside the body.

use multiversion::multiversion;

use super::clusters::{Cluster, MOST};
use super::{LossWorkspace, SamplePoints};

/// The distance of points that are not inside, as published.
const OUTSIDE: f32 = 1.0;

impl LossWorkspace {
    /// A sphere's distance to the nearest point inside; mostly one cluster shows that it is small
    /// enough to cost nothing.
    pub(super) fn emptiness(&mut self, weight: f32, tolerance: f32) -> f64 {
        let count = self.spheres.len();
        let slope = weight / count.max(1) as f32;
        let mut sum = 0.0;
        for sphere in 0..count {
            let values = self.spheres.get(sphere);
            bounds(&self.clusters.inside, values, &mut self.gaps);
            let mut nearest = (OUTSIDE, None);
            let numbers = &self.clusters.inside_numbers;
            let clusters = numbers.iter().map(|&number| &self.clusters.list[number]);
            let mut clusters = clusters.zip(&self.gaps);
            if let Some((first, _)) = clusters.clone().min_by(|a, b| a.1.total_cmp(b.1)) {
                search(&self.points, first, values, &mut nearest);
            }
            while nearest.0 > tolerance
                && let Some((cluster, bound)) = clusters.next()
            {
                if *bound < nearest.0 {
                    search(&self.points, cluster, values, &mut nearest);
                }
            }
            let excess = nearest.0 - tolerance;
            if excess > 0.0 {
                sum += f64::from(excess);
                if let Some(point) = nearest.1 {
                    let [x, y, z, r] = values;
                    let along = -slope / (nearest.0 + r).max(1e-12);
                    let sums = &mut self.slopes[sphere];
                    sums[0] += along * (self.points.x[point] - x);
                    sums[1] += along * (self.points.y[point] - y);
                    sums[2] += along * (self.points.z[point] - z);
                    sums[3] -= slope;
                }
            }
        }
        sum / count.max(1) as f64
    }
}

/// For every cluster with points inside the body: none of its points is nearer to the sphere.
#[multiversion(targets = "simd")]
fn bounds(clusters: &[Vec<f32>; 4], [x, y, z, r]: [f32; 4], bounds: &mut Vec<f32>) {
    let [cx, cy, cz, radii] = clusters;
    bounds.clear();
    bounds.resize(radii.len(), 0.0);
    let centres = cx.iter().zip(cy).zip(cz);
    for (bound, (((cx, cy), cz), radius)) in bounds.iter_mut().zip(centres.zip(radii)) {
        let (dx, dy, dz) = (cx - x, cy - y, cz - z);
        *bound = (dx * dx + dy * dy + dz * dz).sqrt() - radius - r - 1e-5;
    }
}

/// Takes the nearest point inside the body, if it is nearer; the first of equals.
#[multiversion(targets = "simd")]
fn search(
    points: &SamplePoints,
    cluster: &Cluster,
    [x, y, z, r]: [f32; 4],
    nearest: &mut (f32, Option<usize>),
) {
    let range = cluster.start..cluster.end;
    let places = points.x[range.clone()]
        .iter()
        .zip(&points.y[range.clone()])
        .zip(&points.z[range.clone()]);
    let mut gaps = [f32::INFINITY; MOST];
    for (gap, (((px, py), pz), distance)) in
        (gaps.iter_mut()).zip(places.zip(&points.distance[range]))
    {
        let (dx, dy, dz) = (px - x, py - y, pz - z);
        let here = (dx * dx + dy * dy + dz * dz).sqrt() - r;
        *gap = if *distance < 0.0 { here } else { f32::INFINITY };
    }
    let mut least = f32::INFINITY;
    for gap in gaps {
        least = if gap < least { gap } else { least };
    }
    if least < nearest.0 {
        let place = gaps.iter().position(|&gap| gap == least);
        *nearest = (least, place.map(|place| cluster.start + place));
    }
}
